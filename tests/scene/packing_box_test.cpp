// Boxes, densities, sizes and numbers of neighbours in packing files against the scene that reads them.
#include <fmt/format.h>

#include "scene/packing/neighbour_slots.h"
#include "scene/packing/read_packing.h"
#include "scene/read/scene_warnings.h"
#include "scene_test_tools.h"

namespace mcdem {
namespace {

using testing::Contains;
using testing::ElementsAre;
using testing::HasSubstr;
using testing::IsEmpty;

constexpr double lattice = 0.02;
const std::string atoms = [] {
    std::string rows;
    for (int i = 0; i < 27; ++i)
        rows += fmt::format("{} {:.6g} {:.6g} {:.6g} 0.02\n", i + 1, lattice * (i % 3 + 0.5),
                            lattice * (i / 3 % 3 + 0.5), lattice * (i / 9 + 0.5));
    return rows;
}();

/// 27 touching grains that fill a cube of edge 0.06 m.
std::string dump(const std::string& bounds) {
    return "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n27\nITEM: BOX BOUNDS " + bounds +
           "\nITEM: ATOMS id x y z diameter\n" + atoms;
}

std::string data_file(const std::string& header, const std::string& density = "11.5") {
    std::string rows;
    for (int i = 0; i < 27; ++i)
        rows += fmt::format("{} 1 0.02 {} {:.6g} {:.6g} {:.6g}\n", i + 1, density, lattice * (i % 3 + 0.5),
                            lattice * (i / 3 % 3 + 0.5), lattice * (i / 9 + 0.5));
    return "packing\n\n27 atoms\n1 atom types\n\n" + header + "\n\nAtoms # sphere\n\n" + rows;
}

const std::string in_cell =
    "[container]\nshape = \"cell\"\nsize_x = 0.06\nsize_y = 0.06\nheight = 0.06\n[[programme]]\nstrain = "
    "0.01\n";
const std::string in_periodic =
    "[container]\nshape = \"periodic\"\nsize_x = 0.06\nsize_y = 0.06\n[plate]\nstart = 0.06\nend = 0.055\n";
const std::string in_box = "[box]\nsize_x = 0.06\nsize_y = 0.06\n[plate]\nstart = 0.06\nend = 0.03\n";

class PackingBox : public testing::Test {
protected:
    Scene scene(const std::string& container, const std::string& content,
                const std::string& name = "p.dump") {
        folder_.write(name, content);
        return parse_scene(container + "[packing]\nfile = \"" + name + "\"\n",
                           (folder_.path / "s.toml").string());
    }
    std::vector<std::string> problems(const std::string& container, const std::string& content,
                                      const std::string& name = "p.dump") {
        return problems_of([&] { scene(container, content, name); });
    }
    std::vector<std::string> warnings(const std::string& container, const std::string& content,
                                      const std::string& name = "p.dump") {
        return scene_warnings(scene(container, content, name));
    }
    TestFolder folder_;
};

TEST_F(PackingBox, OfTheSceneIsAccepted) {
    const std::string own = "pp pp pp\n0 0.06\n0 0.06\n0 0.06";
    EXPECT_THAT(warnings(in_cell, dump(own)), IsEmpty());
    EXPECT_THAT(warnings(in_cell, dump("pp pp pp\n-1.00002e+00 -0.94002\n0 0.06\n0 0.06")), IsEmpty())
        << "images; six digits";
    EXPECT_THAT(warnings(in_cell, dump("xy xz yz pp pp pp\n0 0.12 0.06\n0 0.06 0\n0 0.06 0")), IsEmpty())
        << "tilted by a whole period";
    EXPECT_THAT(warnings(in_cell, dump("abc origin pp pp pp\n0.06 0 0 0\n0 0.06 0 0\n0 0 0.06 0")),
                IsEmpty());
    EXPECT_THAT(warnings(in_cell, dump("\n0 0.06\n0 0.06\n0 0.06")), IsEmpty()) << "without boundaries";
    EXPECT_THAT(warnings(in_periodic, dump("pp pp ff\n0 0.06\n0 0.06\n-1 2")), IsEmpty());
    EXPECT_THAT(warnings(in_box, dump("ff ff ff\n-0.0101 0.1701\n-0.0101 0.1701\n-0.01 0.41")), IsEmpty())
        << "a box around the walls";
    EXPECT_THAT(warnings(in_box, dump("ss ms sm\n0.01 0.05\n0.01 0.05\n0.01 0.05")), IsEmpty())
        << "shrunk to the centres";
    EXPECT_THAT(warnings(in_box, dump("pp pp pp\n-0.1 0.2\n-0.1 0.2\n-0.1 0.2")), IsEmpty())
        << "no grain reaches through its faces";
    EXPECT_THAT(warnings(in_cell, data_file("0 0.06 xlo xhi\n0 0.06 ylo yhi\n0 0.06 zlo zhi"), "p.data"),
                IsEmpty());
    EXPECT_THAT(warnings(in_cell, data_file("0.06 0 0 avec\n0 0.06 0 bvec\n0 0 0.06 cvec\n0 0 0 abc origin"),
                         "p.data"),
                IsEmpty());
    EXPECT_THAT(warnings(in_cell, data_file(""), "p.data"), IsEmpty()) << "without box lines";
}

TEST_F(PackingBox, TiltedIsRefused) {
    EXPECT_THAT(
        problems(in_cell, dump("xy xz yz pp pp pp\n0 0.09 0\n0 0.06 0.03\n0 0.06 0")),
        ElementsAre(HasSubstr("p.dump:6: the box must be upright, as the scene's container is, got one "
                              "with xy = 0, xz = 0.03, yz = 0 m: take the packing of an upright box, "
                              "and shear it by a [[programme]]")));
    EXPECT_THAT(problems(in_cell, dump("abc origin pp pp pp\n0.06 0 0 0\n0 0.06 0 0\n0 0.02 0.06 0")),
                ElementsAre(HasSubstr("yz = 0.02 m")));
    EXPECT_THAT(problems(in_cell, dump("abc origin pp pp pp\n0.06 0.01 0 0\n0 0.06 0 0\n0 0 0.06 0")),
                ElementsAre(HasSubstr("p.dump:6: the box must have its first edge along x")));
    const std::string upright = "0 0.06 xlo xhi\n0 0.06 ylo yhi\n0 0.06 zlo zhi\n";
    for (const std::string& container : {in_cell, in_periodic, in_box})
        EXPECT_THAT(problems(container, data_file(upright + "0.018 0 0 xy xz yz"), "p.data"),
                    ElementsAre(HasSubstr("p.data:6: the box must be upright")));
    EXPECT_THAT(
        problems(in_cell, data_file("0.06 0 0 avec\n0 0.06 0 bvec\n0.02 0 0.06 cvec\n0 0 0 abc origin"),
                 "p.data"),
        ElementsAre(HasSubstr("xz = 0.02")));
}

TEST_F(PackingBox, OtherPeriodsAreRefused) {
    EXPECT_THAT(
        problems(in_cell, dump("pp pp pp\n0 0.06\n0 0.06\n0 0.09")),
        ElementsAre(HasSubstr("p.dump:6: the box must be 0.06 m long along z, the period of the scene, "
                              "got 0.09: set container.height = 0.09")));
    EXPECT_THAT(problems(in_cell, data_file("0 0.0601 xlo xhi\n0 0.06 ylo yhi\n0 0.06 zlo zhi"), "p.data"),
                ElementsAre(HasSubstr("set container.size_x = 0.0601")));
    EXPECT_THAT(problems(in_periodic, dump("pp pp ff\n0 0.06\n0 0.07\n0 1")),
                ElementsAre(HasSubstr("set container.size_y = 0.07")));
    EXPECT_THAT(problems(in_cell, dump("pp pp ff\n0 0.06\n0 0.06\n0 0.06")),
                ElementsAre(HasSubstr("must repeat along z as the scene's container.shape = \"cell\", got "
                                      "boundaries that do not: set container.shape = \"periodic\"")));
    EXPECT_THAT(problems(in_periodic, dump("ff pp ff\n0 0.06\n0 0.06\n0 0.06")),
                ElementsAre(HasSubstr("must repeat along x")));
}

TEST_F(PackingBox, PeriodicFacesWithGrainsInThemAreNoWalls) {
    std::string across = dump("pp ff ff\n0 0.06\n0 0.06\n0 0.06");
    across.replace(across.find("1 0.01 0.01"), 11, "1 0.009 0.01");
    EXPECT_THAT(problems(in_box, across),
                ElementsAre(HasSubstr("must not repeat along x, where the scene has walls and grains reach "
                                      "through its face: contacts there would be lost; set container.shape = "
                                      "\"periodic\"")));
    std::string above = dump("pp pp pp\n0 0.06\n0 0.06\n0 0.055");
    EXPECT_THAT(problems(in_periodic, above), ElementsAre(HasSubstr("must not repeat along z")));
}

TEST_F(PackingBox, MustHoldTheContainer) {
    const std::string wide = "[box]\nsize_x = 0.08\nsize_y = 0.06\n[plate]\nstart = 0.06\nend = 0.055\n";
    EXPECT_THAT(
        problems(wide, dump("ff ff ff\n0 0.06\n0 0.06\n0 1")),
        ElementsAre(HasSubstr("p.dump:6: the box must hold the scene's container, 0 to 0.08 m along x, "
                              "got 0 to 0.06 m: set container.size_x = 0.06")));
    EXPECT_THAT(problems(in_box, dump("ff ff ff\n0.005 0.06\n0 0.06\n0 1")),
                ElementsAre(HasSubstr("move the grains by -0.005 m along x")));
    EXPECT_THAT(problems(in_box, dump("ff ff ff\n0 0.06\n0 0.06\n0.005 1")),
                ElementsAre(HasSubstr("must hold the floor at z = 0, got 0.005 to 1 m")));
    EXPECT_THAT(warnings(wide, data_file("0 0.06 xlo xhi\n0 0.06 ylo yhi\n0 1 zlo zhi"), "p.data"),
                ElementsAre(HasSubstr("p.data:6: the box of the file should hold the scene's container, 0 to "
                                      "0.08 m along x, got 0 to 0.06 m: set container.size_x = 0.06")));
}

TEST_F(PackingBox, LinesWithoutNumbersAreRefused) {
    EXPECT_THAT(problems(in_box, dump("ff ff ff\n0 x\n0 1\n0 1")),
                Contains(HasSubstr("p.dump:6: the bounds along x must be 2 numbers, the lower one first, got "
                                   "\"0 x\"")));
    EXPECT_THAT(problems(in_box, dump("ff ff ff\n0 1\n1 0\n0 1")),
                Contains(HasSubstr("p.dump:7: the bounds along y must be")));
    EXPECT_THAT(problems(in_box, data_file("0 nan xlo xhi"), "p.data"),
                Contains(HasSubstr("p.data:6: a line of the box must hold finite numbers")));
}

TEST_F(PackingBox, OfTheWantedFrameCounts) {
    folder_.write("p.dump", dump("pp pp pp\n0 0.06\n0 0.06\n0 0.06") + "ITEM: TIMESTEP\n9\n" +
                                dump("pp pp pp\n0 0.06\n0 0.06\n0 0.09").substr(17));
    const std::string file = (folder_.path / "s.toml").string(), packing = "[packing]\nfile = \"p.dump\"\n";
    EXPECT_NO_THROW(parse_scene(in_cell + packing + "frame = 0\n", file));
    EXPECT_THAT(problems_of([&] { parse_scene(in_cell + packing, file); }),
                ElementsAre(HasSubstr("container.height = 0.09")));
}

TEST_F(PackingBox, DensitiesMustBeThoseOfTheScene) {
    const std::string own = "0 0.06 xlo xhi\n0 0.06 ylo yhi\n0 0.06 zlo zhi\n";
    const std::string water = in_cell + "[grains]\ndensity = 1000\n";
    EXPECT_NO_THROW(scene(water, data_file(own, "1000.0"), "p.data"));
    EXPECT_NO_THROW(
        scene(in_box + "[grains]\ndensity = 1000\nexcess_density = 11.5\n", data_file(own), "p.data"))
        << "a code with one density for weight and inertia";
    EXPECT_THAT(
        problems(water, data_file(own, "1100"), "p.data"),
        ElementsAre(HasSubstr("p.data: the density of grain 0, counted from 0, must be grains.density "
                              "= 1000 kg/m3 of the scene, or its excess density 11.5, got 1100: set "
                              "grains.density = 1100")));
    EXPECT_THAT(problems(in_cell + "[[species]]\nname = \"a\"\n[[species]]\nname = \"b\"\ndensity = 900\n",
                         "species,x_m,y_m,z_m,diameter_m,density_kg_m3\na,.01,.01,.01,.02,11.5\n"
                         "b,.03,.03,.03,.02,800\n",
                         "p.csv"),
                ElementsAre(HasSubstr("set species.2.density = 800")));
    std::string masses = dump("pp pp pp\n0 0.06\n0 0.06\n0 0.06");
    masses.replace(masses.find("diameter\n"), 9, "diameter mass\n");
    for (std::size_t at = masses.find(" 0.02\n"); at != masses.npos; at = masses.find(" 0.02\n", at + 6))
        masses.replace(at, 6, " 0.02 4.18879e-05\n");  // 10 kg/m3
    EXPECT_THAT(problems(in_cell, masses), ElementsAre(HasSubstr("got 9.99999")));
}

TEST_F(PackingBox, ADiameterIsTwiceTheRadius) {
    std::string both =
        "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n1\nITEM: ATOMS x y z radius diameter\n0.03 "
        "0.03 0.03 0.0123457 0.0246913\n";
    EXPECT_NO_THROW(scene(in_box, both)) << "six digits";
    both.replace(both.find("0.0123457"), 9, "0.0123467");
    EXPECT_THAT(problems(in_box, both),
                Contains(HasSubstr("p.dump:6: the diameter must be twice the radius, got \"0.0246913\" and "
                                   "\"0.0123467\": correct them, or leave one of the two columns out")));
    EXPECT_THAT(problems(in_box, "x_m,y_m,z_m,diameter_m,radius_m\n.03,.03,.03,.02,.02\n", "p.csv"),
                Contains(HasSubstr("p.csv:2: the diameter must be twice the radius")));
}

TEST_F(PackingBox, ALoadedPackingWarnsThatItsHistoryIsLost) {
    const std::string loaded = "x_m,y_m,z_m,diameter_m\n.03,.03,.01,.02\n.03,.03,.029,.02\n";
    const std::string said =
        "p.csv: grains overlap by up to 5 % of a diameter, but the history of their contacts is "
        "not in the file (";
    EXPECT_THAT(warnings(in_box, loaded, "p.csv"), ElementsAre(HasSubstr(said + "friction springs)")));
    const std::string saturated = "[contact]\nfriction_law = \"saturated\"\n";
    EXPECT_THAT(warnings(in_box + saturated, loaded, "p.csv"), IsEmpty()) << "nothing has a history";
    EXPECT_THAT(warnings(in_box + saturated +
                             "[effects]\nplasticity = 0.1\nviscoelasticity = 0.1\n"
                             "rolling_resistance = 0.1\n",
                         loaded, "p.csv"),
                ElementsAre(HasSubstr("(plasticity, viscoelasticity, rolling resistance)")));
    std::string at_rest = loaded;
    at_rest.replace(at_rest.find(".029"), 4, ".0299");
    EXPECT_THAT(warnings(in_box, at_rest, "p.csv"), IsEmpty()) << "0.5 % of a diameter";
}

TEST_F(PackingBox, WhatIsNotReadIsTold) {
    const std::string rows = ",.03,.03,.01,.02,9\nb,.03,.03,.031,.02,9\n";
    EXPECT_THAT(warnings(in_box, "grain,x_m,y_m,z_m,diameter_m,frame\n0" + rows, "p.csv"), IsEmpty());
    EXPECT_THAT(warnings(in_box, "grain,x_m,y_m,z_m,diameter_m,density\n0" + rows, "p.csv"),
                ElementsAre(HasSubstr(
                    "p.csv: density is not read: other columns than those listed in scenes/README.md")));
    EXPECT_THAT(warnings(in_box, "vx,x_m,y_m,z_m,diameter_m,vy\n0" + rows, "p.csv"),
                ElementsAre(HasSubstr("p.csv: vx, vy are not read")));
    const std::string unlike = "type,x_m,y_m,z_m,diameter_m,frame\na" + rows;
    EXPECT_THAT(warnings(in_box, unlike, "p.csv"),
                ElementsAre(HasSubstr(
                    "p.csv: its grains are of 2 species (a, b), but the scene does not distinguish them")));
    EXPECT_THAT(warnings(in_box + "[[species]]\nname = \"a\"\n[[species]]\nname = \"b\"\n", unlike, "p.csv"),
                IsEmpty());
}

/// A grain of 36 mm with `count` grains of 6 mm around it, above the floor.
std::string crowd(int count) {
    std::string rows = "x_m,y_m,z_m,diameter_m\n.04,.04,.04,.036\n";
    for (int k = 0; k < count; ++k) {
        const double z = 1 - (2 * k + 1.0) / count, angle = 2.399963 * k, side = std::sqrt(1 - z * z);
        rows += fmt::format("{:.9g},{:.9g},{:.9g},.006\n", 0.04 + 0.0211 * side * std::cos(angle),
                            0.04 + 0.0211 * side * std::sin(angle), 0.04 + 0.0211 * z);
    }
    return rows;
}

TEST_F(PackingBox, SlotsFollowTheNeighbours) {
    const std::string room = "[box]\nsize_x = 0.08\nsize_y = 0.08\n[plate]\nstart = 0.08\nend = 0.07\n";
    EXPECT_EQ(scene(room, crowd(10), "p.csv").slots, 16);
    EXPECT_EQ(scene(room, crowd(24), "p.csv").slots, 32) << "a quarter more than 24: grains move";
    EXPECT_EQ(scene(room, crowd(64), "p.csv").slots, 64);
    EXPECT_EQ(scene(room + "[numerics]\nslots = 48\n", crowd(24), "p.csv").slots, 48) << "as it says";
    EXPECT_THAT(
        problems(room + "[numerics]\nslots = 16\n", crowd(24), "p.csv"),
        ElementsAre(HasSubstr("p.csv: a grain must have at most 16 near neighbours (numerics.slots), got "
                              "24 for grain 0, counted from 0: set numerics.slots = 32, or leave it "
                              "out")));
    EXPECT_THAT(
        problems(room, crowd(70), "p.csv"),
        ElementsAre(HasSubstr("p.csv: a grain must have at most 64 near neighbours, got 70 for grain 0, "
                              "counted from 0: it suffices for grains up to about six times")));
}

TEST_F(PackingBox, SlotsOfGeneratedGrainsFollowTheirSizes) {
    const auto generated = [](const std::string& sizes) {
        return parse_scene(
            "[box]\nsize_x = 0.1\nsize_y = 0.1\n[plate]\nstart = 1\nend = 0.05\n[packing]\n" + sizes,
            "s.toml");
    };
    EXPECT_EQ(generated("count = 300\n").slots, 16);
    EXPECT_EQ(
        generated("count = 300\ndiameter_mean = 0.02\ndiameter_min = 0.01\ndiameter_max = 0.05\n").slots, 48);
    const Scene unlike = generated(
        "count = 1000\ndiameter_mean = 0.01\ndiameter_sd = 0.01\ndiameter_min = 0.005\ndiameter_max = "
        "0.05\n");
    EXPECT_EQ(unlike.slots, 64);
    EXPECT_THAT(
        scene_warnings(unlike),
        ElementsAre(HasSubstr("a grain of 0.05 m among grains of 0.01 m may have 97 near neighbours, but at "
                              "most 64 are possible (numerics.slots)")));
    const Numerics usual;
    EXPECT_EQ(slots_for(expected_neighbours(1, 1.4, usual)), 16);
    EXPECT_EQ(slots_for(expected_neighbours(1, 9, usual)), 64);
    EXPECT_EQ(slots_for(16), 16);
    EXPECT_EQ(slots_for(17), 32);
}

}  // namespace
}  // namespace mcdem
