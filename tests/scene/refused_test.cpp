// The scenes of refused_scenes.txt and the files of refused_packings.txt are refused with the messages that
// stand there.
#include <fmt/format.h>
#include <fmt/ranges.h>

#include <fstream>
#include <map>

#include "scene/packing/read_packing.h"
#include "scene_test_tools.h"

namespace mcdem {
namespace {

std::vector<std::string> split(const std::string& text, const std::string& between) {
    std::vector<std::string> parts;
    std::size_t begin = 0;
    for (std::size_t end; (end = text.find(between, begin)) != text.npos; begin = end + between.size())
        parts.push_back(text.substr(begin, end - begin));
    parts.push_back(text.substr(begin));
    return parts;
}

/// Parts of the messages ("a & b ;; c"); nothing else may be told, unless there are others.
void expect_told(const std::vector<std::string>& problems, const std::string& told, bool among_others) {
    const auto messages = split(told, " ;; ");
    if (!among_others) {
        EXPECT_EQ(problems.size(), messages.size()) << testing::PrintToString(problems);
    }
    for (const std::string& message : messages) {
        std::vector<testing::Matcher<std::string>> parts;
        for (const std::string& part : split(message, " & ")) parts.push_back(testing::HasSubstr(part));
        EXPECT_THAT(problems, testing::Contains(testing::AllOfArray(parts)));
    }
}

/// Reads a table of cases. `read` gets the left side, with its line ends and named texts.
template <class Read>
void expect_refused(const std::string& name, int least, const Read& read) {
    std::ifstream table(std::string(MCDEM_SOURCE_DIR) + "/tests/scene/" + name);
    std::map<std::string, std::string> texts;
    int number = 0, cases = 0;
    for (std::string line; std::getline(table, line);) {
        const testing::ScopedTrace trace(name.c_str(), ++number, line);
        if (line.empty() || line.front() == '#') continue;
        if (const auto named = split(line, " := "); named.size() == 2) {
            texts[named[0]] = named[1];
            continue;
        }
        const auto row = split(line, " => ");
        ASSERT_EQ(row.size(), 2u);
        const bool among_others = row[0].starts_with("* ");
        std::string given = row[0].substr(among_others ? 2 : 0);
        for (const auto& [word, text] : texts)
            if (const std::size_t at = given.find("{" + word + "}"); at != given.npos)
                given.replace(at, word.size() + 2, text);
        given = fmt::format("{}", fmt::join(split(given, "\\n"), "\n"));
        if (row[1] == "accepted")
            EXPECT_NO_THROW(read(given));
        else
            expect_told(problems_of([&] { read(given); }), row[1], among_others);
        ++cases;
    }
    EXPECT_GE(cases, least);
}

TEST(Refused, ScenesAreToldWhatIsWrong) {
    expect_refused("refused_scenes.txt", 150, [](const std::string& given) {
        std::vector<std::string> overrides = split(" " + given, " --set ");
        const std::string text = overrides.front().empty() ? "" : overrides.front().substr(1);
        overrides.erase(overrides.begin());
        parse_scene(text, "bad.toml", overrides);
    });
}

TEST(Refused, PackingFilesAreToldWhatIsWrong) {
    expect_refused("refused_packings.txt", 20, [](const std::string& given) {
        const std::size_t end = given.find(": ");
        const std::string kind = given.substr(0, end), text = given.substr(end + 2);
        if (kind == "data") read_lammps_packing(text, "p");
        if (kind == "csv") read_csv_packing(text, "p");
        if (kind == "dump") read_dump_packing(text, "p");
        if (kind == "yade") read_yade_packing(text, "p");
    });
}

}  // namespace
}  // namespace mcdem
