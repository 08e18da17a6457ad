// Folders that are not valid experiments: an error in one line, without a crash, a hang or exhausted memory.
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <sys/stat.h>
#include <zlib.h>

#include <algorithm>
#include <fstream>

#include "experiment/experiment_folder.h"
#include "scene/random.h"

namespace mcdem::test {
namespace {

namespace fs = std::filesystem;
using ::testing::HasSubstr;
using ::testing::StartsWith;

const char* const tables[] = {"plate.csv", "grains.csv", "contacts.csv"};

void pack(const fs::path& file, const std::string& bytes) {
    const gzFile out = gzopen(file.c_str(), "wb9");
    gzwrite(out, bytes.data(), static_cast<unsigned>(bytes.size()));
    gzclose(out);
}

std::string bytes_of(const fs::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

TEST(bad_folder, an_empty_table_is_reported) {
    for (const std::string table : tables) {
        ExperimentFolder folder;
        const std::string header = folder[table].substr(0, folder[table].find('\n'));
        for (const std::string nothing : {"", "\n\n", "# later\n", "\xEF\xBB\xBF"}) {
            folder[table] = nothing;
            EXPECT_EQ(folder.error(), table + ": is empty: it must begin with the header " + header);
        }
        for (const std::string end : {"", "\n", "\r\n# end\r\n"}) {
            folder[table] = header + end;
            EXPECT_THAT(folder.error(),
                        StartsWith(table + ": must have at least one row, got none: add rows, or leave"));
        }
    }
}

TEST(bad_folder, bytes_that_are_no_table_are_reported) {
    Random random(1, Stream::positions);
    std::string junk;
    for (int i = 0; i < 100000; ++i) junk += static_cast<char>(random.uniform(1, 256));
    for (const std::string table : tables) {
        ExperimentFolder folder;
        const std::string text = folder[table];
        folder[table] = junk;
        EXPECT_THAT(folder.error(), StartsWith(table + ":"));
        folder[table] = text + std::string(1, '\0');
        EXPECT_EQ(folder.error(), table + ": holds zero bytes and is no table: save it as text in UTF-8");
        std::string wide = "\xFF\xFE";  // UTF-16, as saved by spreadsheets
        for (const char c : text) wide += {c, '\0'};
        folder[table] = wide;
        EXPECT_THAT(folder.error(), HasSubstr("save it as text in UTF-8"));
        folder[table] = text + std::string(20'000'000, 'x');
        EXPECT_THAT(folder.error(), HasSubstr("has more than 16 million characters: is this a table?"));
    }
}

TEST(bad_folder, other_separators_are_reported_once) {
    for (const char separator : {';', '\t'}) {
        ExperimentFolder folder;
        std::string& text = folder["plate.csv"];
        std::replace(text.begin(), text.end(), ',', separator);
        EXPECT_THAT(folder.error(), StartsWith("plate.csv:1: columns must be separated by commas"));
    }
}

TEST(bad_folder, a_byte_order_mark_is_skipped) {
    ExperimentFolder folder;
    for (const char* file : {"experiment.toml", "plate.csv", "grains.csv", "contacts.csv"})
        folder[file].insert(0, "\xEF\xBB\xBF");
    EXPECT_EQ(folder.error(), "no error");
}

TEST(bad_folder, damaged_compressed_tables_are_reported) {
    for (const std::string table : tables) {
        ExperimentFolder folder;
        folder.write();
        fs::remove(folder.path() / table);
        const fs::path packed = folder.path() / (table + ".gz");
        pack(packed, folder[table]);
        ASSERT_EQ(folder.error_as_it_lies(), "no error");
        const std::string whole = bytes_of(packed);
        for (const std::size_t part : {whole.size() - 1, whole.size() - 9, whole.size() / 2}) {
            std::ofstream(packed, std::ios::binary) << whole.substr(0, part);
            EXPECT_THAT(folder.error_as_it_lies(), StartsWith(table + ".gz: cannot be unpacked (")) << part;
        }
        std::string flipped = whole;
        flipped[whole.size() / 2] ^= 0x10;
        std::ofstream(packed, std::ios::binary) << flipped;
        EXPECT_THAT(folder.error_as_it_lies(), StartsWith(table + ".gz: "));
        EXPECT_THAT(folder.error_as_it_lies(), HasSubstr("pack it again with gzip"));
    }
}

TEST(bad_folder, too_large_tables_are_refused_without_reading_them) {
    for (const std::string table : tables) {
        ExperimentFolder folder;
        folder.write();
        fs::resize_file(folder.path() / table,
                        10ull << 30);  // a sparse file that would take minutes to read
        EXPECT_EQ(folder.error_as_it_lies(),
                  table +
                      ": is larger than an experiment's table may be: leave out frames, or split it into "
                      "several experiments (10737418240 bytes, at most 1073741824)");
    }
}

TEST(bad_folder, too_large_compressed_tables_are_read_only_to_the_limit) {
    ExperimentFolder folder;
    folder.write();
    fs::remove(folder.path() / "plate.csv");
    pack(folder.path() / "plate.csv.gz", folder["plate.csv"] + std::string(40'000'000, '\n'));
    EXPECT_LT(fs::file_size(folder.path() / "plate.csv.gz"), 100'000u);
    EXPECT_EQ(folder.error_as_it_lies(), "no error");
    EXPECT_THAT(folder.error_as_it_lies(39'000'000),
                StartsWith("plate.csv.gz: is larger than an experiment's"));
    EXPECT_THAT(folder.error_as_it_lies(1000), StartsWith("plate.csv.gz: is larger than an experiment's"));
}

TEST(bad_folder, tables_that_are_not_files_are_reported) {
    const auto error_with = [](const std::string& name, const auto& put) {
        ExperimentFolder folder;
        folder.write();
        fs::remove(folder.path() / name);
        put(folder.path() / name);
        return folder.error_as_it_lies();
    };
    for (const std::string name : {"plate.csv", "grains.csv", "contacts.csv", "experiment.toml"}) {
        const std::string must = name + ": must be a ";
        // A loop of links says nothing of what is there.
        EXPECT_THROW(error_with(name, [](const fs::path& file) { fs::create_symlink(file, file); }),
                     RunError);
        EXPECT_THAT(error_with(name, [](const fs::path& file) { fs::create_symlink("nowhere", file); }),
                    StartsWith(must));
        EXPECT_THAT(error_with(name, [](const fs::path& file) { fs::create_symlink("/dev/zero", file); }),
                    StartsWith(must));
        EXPECT_THAT(error_with(name, [](const fs::path& file) { fs::create_directory(file); }),
                    StartsWith(must));
        EXPECT_THAT(error_with(name, [](const fs::path& file) { ASSERT_EQ(mkfifo(file.c_str(), 0600), 0); }),
                    StartsWith(must));
    }
}

TEST(bad_folder, what_is_not_a_folder_is_reported) {
    const auto error = [](const fs::path& folder) -> std::string {
        try {
            read_experiment(folder);
            return "no error";
        } catch (const InputError& e) {
            return e.what();
        } catch (const RunError& e) {  // nothing is known about the folder
            return std::string("failed: ") + e.what();
        }
    };
    ExperimentFolder folder;
    folder.write();
    const std::string path = folder.path().string();
    EXPECT_EQ(error(path + "/nowhere"), path + "/nowhere: must be an experiment's folder, got nothing there");
    EXPECT_EQ(error(path + "/plate.csv"), path + "/plate.csv: must be an experiment's folder, got a file");
    fs::create_symlink("loop", folder.path() / "loop");
    EXPECT_THAT(error(path + "/loop"), StartsWith("failed: " + path + "/loop: cannot be looked at: "));
    EXPECT_THAT(error(std::string(5000, 'x')), HasSubstr(": cannot be looked at: "));
    fs::remove(folder.path() / "experiment.toml");
    EXPECT_EQ(error(path), path + ": is not an experiment: it contains no experiment.toml");
    fs::remove(folder.path() / "plate.csv");
    std::ofstream(folder.path() / "experiment.toml") << "[box]\nsize = [0.1, 0.1]\n";
    EXPECT_THAT(error(path), StartsWith(path + ": must hold plate.csv or plate.csv.gz"));
}

TEST(bad_folder, invalid_settings_are_reported) {
    ExperimentFolder folder;
    for (const std::string& text :
         {std::string(1'000'001, '\n'), std::string(1000, '\0'), std::string("\xFF\xFE\x00\x01", 4),
          std::string(100'000, '['), std::string("name = \"\xC3\x28\""),
          std::string("[box]\nsize = [nan, inf]\n")}) {
        folder["experiment.toml"] = text;
        EXPECT_THAT(folder.error(), StartsWith("experiment.toml:")) << text.substr(0, 20);
    }
    for (const int depth : {200, 40'000, 300'000}) {
        std::string nested = "a";
        for (int part = 1; part < depth; ++part) nested += ".a";
        for (const std::string& text :
             {nested + " = 1", "[" + nested + "]\nb = 1", "[[" + nested + "]]\nb = 1"}) {
            folder["experiment.toml"] = text;
            EXPECT_THAT(folder.error(), StartsWith("experiment.toml:1: names must have at most 100 parts"))
                << depth;
        }
    }
    folder["experiment.toml"] = std::string(1'000'001, '\n');
    EXPECT_THAT(folder.error(), StartsWith("experiment.toml: must be a text of at most 1 MB"));
}

/// Changes, removes and duplicates random bytes of a valid folder: it is read, or there is an error.
TEST(bad_folder, random_damage_gives_an_input_error_or_data) {
    Random random(2, Stream::positions);
    const char bytes[] =
        "0179.,-+eEnN\n\r\"#=[]; \t\x80\xFF"
        "floorplate";
    for (int trial = 0; trial < 400; ++trial) {
        ExperimentFolder folder;
        for (const std::string file : {"experiment.toml", "plate.csv", "grains.csv", "contacts.csv"})
            for (int change = 0; change < 2; ++change) {
                std::string& text = folder[file];
                const auto at = static_cast<std::size_t>(random.uniform(0, static_cast<double>(text.size())));
                const char byte = bytes[static_cast<std::size_t>(random.uniform(0, sizeof bytes - 1))];
                const double what = random.uniform();
                if (what < 0.3)
                    text[at] = static_cast<char>(random.uniform(0, 256));
                else if (what < 0.6)
                    text[at] = byte;
                else if (what < 0.8)
                    text.erase(at, static_cast<std::size_t>(random.uniform(1, 30)));
                else
                    text.insert(at, text.substr(at / 2, 20));
            }
        folder.error();  // any other exception fails the test
    }
}

}  // namespace
}  // namespace mcdem::test
