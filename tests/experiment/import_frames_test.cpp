// Which frames of a laboratory's tables belong together: by numbers, times or order, and when none is safe.
#include "experiment/import_fixture.h"

namespace mcdem::test {
namespace {

using ::testing::Contains;
using ::testing::ElementsAre;
using ::testing::HasSubstr;
using ::testing::IsEmpty;

class FramesTest : public ImportTest {
protected:
    /// Frames by a column of that name, `first` and on, `step` apart.
    std::string plate(const std::string& frame, double first = 0, double step = 1) {
        std::string text = frame + ",plate_z [m],force [N]\n";
        for (const Scan& scan : truth_.scans)
            text +=
                fmt::format("{},{:.9g},{:.9g}\n", first + step * scan.frame, scan.plate_z, scan.top_force());
        return write("plate.csv", text);
    }
    std::string rows(const Scan& scan, const std::string& first) {
        std::string text;
        for (std::size_t i = 0; i < scan.position.size(); ++i) {
            const Vec3& at = scan.position[i];
            text += fmt::format("{}{},{:.9g},{:.9g},{:.9g},{:.9g}\n", first, i, at.x(), at.y(), at.z(),
                                truth_.diameter[i]);
        }
        return text;
    }
    std::string grains(const std::string& frame, double step, std::vector<std::size_t> which) {
        std::string text = frame + ",id,x_m,y_m,z_m,d_m\n";
        for (const std::size_t f : which)
            text += rows(truth_.scans[f], fmt::format("{},", step * static_cast<double>(f)));
        return write("grains.csv", text);
    }
    /// One file a frame, its name ending in `number(frame)`.
    void grain_files(std::vector<std::string>& files,
                     std::vector<std::pair<std::size_t, std::string>> names) {
        for (const auto& [f, name] : names)
            files.push_back(write(name, "id,x_m,y_m,z_m,d_m\n" + rows(truth_.scans[f], "")));
    }
    std::string contacts(const std::string& frame, double first, std::size_t from) {
        std::string text = frame + ",id1,id2,f_N\n";
        for (std::size_t f = from; f < truth_.scans.size(); ++f)
            for (const Contact& c : truth_.scans[f].contacts)
                text += fmt::format(
                    "{},{},{},{:.9g}\n", first + static_cast<double>(f), c.grain,
                    is_wall(c.partner) ? std::string(name(wall_of(c.partner))) : std::to_string(c.partner),
                    c.force.norm());
        return write("contacts.csv", text);
    }
    Recording imported(const std::vector<ImportTable>& tables) {
        return import_tables(tables, known_).experiment.recording;
    }
};

TEST_F(FramesTest, ATableWithoutRowsHasNoFramesThatCouldBeOnesOfThePlate) {
    const auto dump =
        write("grains.dump",
              "ITEM: TIMESTEP\n0\nITEM: NUMBER OF ATOMS\n0\nITEM: BOX BOUNDS ff ff ff\n0 1\n0 1\n0 1\n"
              "ITEM: ATOMS id x y z radius\n");
    const auto tables = guess_tables({plate("frame [s]"), dump}, known_);
    const Guess* frames = of(tables, Role::grains).find("frames_by");
    ASSERT_TRUE(frames);
    EXPECT_EQ(frames->sure, Sure::unclear);
    EXPECT_THAT(frames->why, HasSubstr("there are 0 frames here"));
    EXPECT_THAT(problems_of([&] { import_tables(tables, known_); }),
                Contains(HasSubstr("grains.dump: must have rows")));
}

TEST_F(FramesTest, NumbersInFileNamesAreThoseOfThePlate) {
    std::vector<std::string> files{plate("frame")};
    grain_files(files, {{2, "grains_002.txt"}, {3, "grains_003.txt"}, {5, "grains_005.txt"}});
    const auto tables = guess_tables(files, known_);
    EXPECT_EQ(of(tables, Role::grains).find("frames_by")->sure, Sure::likely);
    EXPECT_THAT(unclear(tables), IsEmpty());
    const Recording read = imported(tables);
    ASSERT_EQ(read.scans.size(), 5u) << "two rows before the first grains are left out";
    for (const std::size_t f : {2u, 3u, 5u})
        EXPECT_LT((read.scans[f - 2].position.at(30) - truth_.scans[f].position.at(30)).norm(), 1e-9);
    EXPECT_TRUE(read.scans[2].position.empty());
}

TEST_F(FramesTest, FilesThatOnlyCountThemselvesOrHaveNoNumberMustBeConfirmed) {
    std::vector<std::string> files{plate("frame")};
    grain_files(files, {{2, "grains_1.txt"}, {3, "grains_2.txt"}, {5, "grains_3.txt"}});
    EXPECT_THAT(unclear(guess_tables(files, known_)), ElementsAre(HasSubstr("frames_by must be confirmed")));
    files.resize(1);
    grain_files(files, {{2, "a.txt"}, {3, "b.txt"}, {5, "c.txt"}});
    EXPECT_THAT(unclear(guess_tables(files, known_)),
                ElementsAre(HasSubstr("there are 3 frames here and 7 rows of the plate")));
    files.resize(1);
    files[0] = plate("time [s]");
    grain_files(files, {{2, "d_2.txt"}, {3, "d_3.txt"}, {5, "d_5.txt"}});
    EXPECT_THAT(unclear(guess_tables(files, known_)),
                ElementsAre(HasSubstr("numbers in file names here, time numbers [s] there")));
}

TEST_F(FramesTest, ContactsGoByThePlateBesideFilesInOrder) {
    for (const int first : {0, 1}) {
        std::vector<std::string> files{plate("frame", 1), contacts("frame", 1, 1)};
        for (std::size_t f = 0; f < 7; ++f)
            grain_files(files, {{f, fmt::format("grains_{:03}.txt", f + static_cast<std::size_t>(first))}});
        const auto tables = guess_tables(files, known_);
        EXPECT_THAT(unclear(tables), IsEmpty());
        EXPECT_EQ(of(tables, Role::contacts).word("frames_by", ""), "plate");
        const Recording read = imported(tables);
        for (std::size_t f = 1; f < 7; ++f) expect_contacts(read.scans[f], truth_.scans[f]);
    }
}

TEST_F(FramesTest, FrameNumbersAmongTimesMustBeConfirmed) {
    std::vector<std::string> files{plate("time [s]"), grains("frame", 1, {0, 1, 3})};
    EXPECT_THAT(unclear(guess_tables(files, known_)),
                ElementsAre(HasSubstr("frames_by must be confirmed, got \"?plate\": scan numbers here, time "
                                      "numbers [s] there: are they the same?")));
    grains("time [d]", 1, {0, 1, 3});
    EXPECT_THAT(unclear(guess_tables(files, known_)),
                ElementsAre(HasSubstr("time numbers [d] here, time numbers [s] there")));
    plate("time");
    grains("time [min]", 1.0 / 60, {0, 1, 3});
    EXPECT_THAT(unclear(guess_tables(files, known_)), ElementsAre(HasSubstr("frames_by must be confirmed")));
}

TEST_F(FramesTest, TimesInOtherUnitsAreConverted) {
    const std::vector<std::string> files{plate("time [s]", 0, 60), grains("time [min]", 1, {0, 1, 3})};
    const auto tables = guess_tables(files, known_);
    EXPECT_THAT(unclear(tables), IsEmpty());
    EXPECT_LT((imported(tables).scans[3].position.at(30) - truth_.scans[3].position.at(30)).norm(), 1e-9);
}

TEST_F(FramesTest, NumbersBesideAPlateWithoutAnyCountFromNoughtOrMustBeConfirmed) {
    std::string text = "plate_z [m],force [N]\n";
    for (const Scan& scan : truth_.scans)
        text += fmt::format("{:.9g},{:.9g}\n", scan.plate_z, scan.top_force());
    const std::vector<std::string> files{write("plate.csv", text), grains("frame", 1, {0, 2, 3})};
    EXPECT_THAT(unclear(guess_tables(files, known_)), IsEmpty());
    grains("frame", 1, {1, 2, 3});
    EXPECT_THAT(unclear(guess_tables(files, known_)), Contains(HasSubstr("frames_by must be confirmed")));
}

}  // namespace
}  // namespace mcdem::test
