// The table of keys: complete, consistent, and identical to scenes/README.md.
#include <fmt/format.h>

#include <algorithm>
#include <cstdlib>
#include <set>
#include <sstream>

#include "scene/read/list_tables.h"
#include "scene/read/toml_text.h"
#include "scene_test_tools.h"

namespace mcdem {
namespace {

const std::string begin_mark =
    "<!-- keys: written by the program, see tests/scene/key_reference_test.cpp -->\n";
const std::string end_mark = "<!-- end of keys -->\n";

std::vector<std::string> lines(const std::string& text) {
    std::vector<std::string> all;
    std::istringstream input(text);
    for (std::string line; std::getline(input, line);) all.push_back(line);
    return all;
}

/// Every key with its values, default and meaning, as Markdown: one table per TOML table.
std::string key_reference() {
    Settings defaults;
    defaults.run.name.clear();  // the default is the file's name
    std::string text;
    std::string_view open = "none yet";
    std::vector<Key> all(keys().begin(), keys().end());
    const auto put_before = [&](std::string_view next, std::span<const Key> keys) {
        all.insert(std::ranges::find(all, next, &Key::name), keys.begin(), keys.end());
    };
    put_before("walls.youngs_modulus", species_keys(0));
    put_before("walls.youngs_modulus", pair_keys(0));
    put_before("numerics.time_step", stage_keys(0));
    for (const Key& key : all) {
        const auto dot = key.name.rfind('.');
        const std::string_view table = dot == key.name.npos ? "" : key.name.substr(0, key.name.find('.'));
        if (table != open) {
            text += table.empty()
                        ? "### Before any table\n"
                        : fmt::format("\n### {1}{0}{2}\n", table, find_list_table(table) ? "[[" : "[",
                                      find_list_table(table) ? "]]" : "]");
            text += "\n| key | must be | default | meaning |\n|---|---|---|---|\n";
            open = table;
        }
        const std::string value = value_text(key, defaults);
        text += fmt::format("| `{}` | {} | {} | {} |\n", key.name.substr(dot == key.name.npos ? 0 : dot + 1),
                            description(key), value.empty() ? "none" : "`" + value + "`", key.meaning);
    }
    return text;
}

/// MCDEM_UPDATE_REFERENCE=1 writes the reference instead of comparing it.
TEST(KeyReference, AgreesWithTheReadme) {
    const std::string file = std::string(MCDEM_SOURCE_DIR) + "/scenes/README.md";
    std::ostringstream read;
    read << std::ifstream(file).rdbuf();
    const std::string text = read.str();
    const auto begin = text.find(begin_mark), end = text.find(end_mark);
    ASSERT_NE(begin, text.npos);
    ASSERT_NE(end, text.npos);
    const auto inside = begin + begin_mark.size();
    if (std::getenv("MCDEM_UPDATE_REFERENCE")) {
        std::ofstream(file) << text.substr(0, inside) << key_reference() << text.substr(end);
        return;
    }
    const std::vector<std::string> stands = lines(text.substr(inside, end - inside)),
                                   wanted = lines(key_reference());
    EXPECT_EQ(stands.size(), wanted.size()) << "run this test once with MCDEM_UPDATE_REFERENCE=1";
    for (std::size_t i = 0; i < std::min(stands.size(), wanted.size()); ++i)
        ASSERT_EQ(stands[i], wanted[i]) << "run this test once with MCDEM_UPDATE_REFERENCE=1";
}

TEST(KeyReference, NamesEveryKey) {
    const std::string reference = key_reference();
    for (const Key& key : keys()) {
        const std::string last(key.name.substr(key.name.rfind('.') + 1));
        EXPECT_NE(reference.find("| `" + last + "` |"), std::string::npos) << key.name;
    }
    EXPECT_NE(reference.find("### [protocol]\n"), std::string::npos);
    EXPECT_NE(reference.find("| `poisson_ratio` | a number between 0 and 0.5 | `0.5` | nu |"),
              std::string::npos);
}

TEST(Keys, HaveUniqueNames) {
    std::set<std::string_view> names;
    for (const Key& key : keys()) EXPECT_TRUE(names.insert(key.name).second) << key.name;
}

TEST(Keys, BelongToDifferentMembers) {
    Settings settings;
    std::set<const void*> members;
    for (const Key& key : keys()) {
        const bool is_second = key.name.starts_with("box.");  // another name for the same
        EXPECT_EQ(is_second, same_key(key.name) && same_key(key.name)->name.starts_with("container."));
        std::visit(
            [&](auto get) { EXPECT_EQ(members.insert(&get(settings)).second, !is_second) << key.name; },
            key.member);
    }
}

std::size_t count_keys(std::string_view table) {
    return static_cast<std::size_t>(
        std::ranges::count_if(keys(), [&](const Key& key) { return key.name.starts_with(table); }));
}

/// Does not compile if a member is added to a struct: add a row to host/scene/read/keys.cpp, then a name
/// here.
TEST(Keys, CoverEveryMember) {
    [[maybe_unused]] const auto [b1, b2, b3, b4, t1, t2, t3] = Box{};  // tilts: of a deformed cell
    [[maybe_unused]] const auto [g1, g2, g3, g4, g5, g6, g7] = GrainMaterial{};
    [[maybe_unused]] const auto [w1, w2, w3, w4] = WallMaterial{};
    [[maybe_unused]] const auto [c1, c2, c3, c4] = ContactLaw{};
    [[maybe_unused]] const auto [d1, d2, d3, d4, d5, d6] = GeneratedPacking{};
    [[maybe_unused]] const auto [p1, p2, p3] = Plate{};
    [[maybe_unused]] const auto [r1, r2, r3, r4, r5, r6, r7, r8, r9, r10, r11, r12, r13] = Protocol{};
    [[maybe_unused]] const auto [n1, n2, n3, n4, n5] = Numerics{};
    [[maybe_unused]] const auto [o1, o2, o3] = Output{};
    EXPECT_EQ(count_keys("container."), 4u + 1) << "the radius of a cylinder too";
    EXPECT_EQ(count_keys("box."), 2u) << "short forms";
    EXPECT_EQ(count_keys("grains."), 7u);
    [[maybe_unused]] const auto [s1, material, s2, sizes] = Species{};
    [[maybe_unused]] const auto [z1, z2, z3, z4, z5, z6, no_key_of_its_own] = Sizes{};
    [[maybe_unused]] const auto [i1, i2, i3, i4] = SpeciesPair{};
    EXPECT_EQ(species_keys(0).size(), 2u + 6 + 6) << "drag is of [grains]";
    EXPECT_EQ(pair_keys(0).size(), 4u);
    EXPECT_EQ(count_keys("walls."), 4u);
    EXPECT_EQ(count_keys("contact."), 4u);
    EXPECT_EQ(count_keys("packing."), 6u + 5) << "file, frame, jitter, seed and what fractions are of too";
    EXPECT_EQ(count_keys("plate."), 3u);
    EXPECT_EQ(count_keys("protocol."), 13u);
    EXPECT_EQ(count_keys("numerics."), 5u + 2) << "precision and slots too";
    EXPECT_EQ(count_keys("output."), 3u);
}

TEST(Keys, AcceptTheirOwnDefaults) {
    const Settings defaults;
    for (const Key& key : keys()) {
        std::string text = value_text(key, defaults);
        if (text.empty()) continue;  // no default
        if (!std::holds_alternative<MemberOf<double>>(key.member) && text != "true" && text != "false" &&
            text.find_first_not_of("-0123456789") != text.npos)
            text = '"' + text + '"';
        const toml::table parsed = toml::parse("value = " + text);
        Settings settings;
        EXPECT_EQ(assign(key, *parsed.get("value"), settings), std::nullopt) << key.name;
        EXPECT_EQ(value_text(key, settings), value_text(key, defaults)) << key.name;
    }
}

TEST(Keys, SimilarNamesAreSuggested) {
    EXPECT_EQ(suggestion("grains.fricton"), " (did you mean grains.friction?)");
    EXPECT_EQ(suggestion("contact.poisson_ratio"), " (did you mean grains.poisson_ratio?)");
    EXPECT_EQ(suggestion("grain"), " (did you mean grains?)");
    EXPECT_EQ(suggestion("scans_per_stroke"), " (did you mean protocol.scans_per_stroke?)");
    EXPECT_EQ(suggestion("colour"), "");
    EXPECT_EQ(suggestion(std::string(100000, 'x')), "");
}

}  // namespace
}  // namespace mcdem
