// A recording told by a laboratory, in a folder, and what an import of it must give.
#pragma once
#include <gmock/gmock.h>
#include <gtest/gtest.h>
#include <stdlib.h>

#include <algorithm>
#include <fstream>
#include <functional>

#include "core/errors.h"
#include "experiment/import_experiment.h"
#include "experiment/lab_tables.h"
#include "experiment/pressed_packing.h"

namespace mcdem::test {

class ImportTest : public testing::Test {
protected:
    ImportTest() {
        std::string pattern = (std::filesystem::temp_directory_path() / "mcdem-test-XXXXXX").string();
        folder_ = mkdtemp(pattern.data());
    }
    ~ImportTest() override { std::filesystem::remove_all(folder_); }

    std::string write(const std::string& name, const std::string& text) {
        std::ofstream(folder_ / name, std::ios::binary) << text;
        return (folder_ / name).string();
    }
    std::vector<std::string> write_lab(const LabStyle& style) {
        return {write("kraft.csv", lab_plate(truth_, style)), write("koerner.csv", lab_grains(truth_, style)),
                write("kontakte.csv", lab_contacts(truth_, style))};
    }
    /// What is unclear in the guess, without the folder's path.
    std::vector<std::string> unclear(const std::vector<ImportTable>& tables) const {
        auto all = unclear_entries(mapping_text(mapping_of(tables)), "m");
        for (std::string& text : all) text = without_folder(text);
        return all;
    }
    std::string without_folder(std::string text) const {
        const std::string path = folder_.string() + "/";
        for (auto at = text.find(path); at != std::string::npos; at = text.find(path))
            text.erase(at, path.size());
        return text;
    }
    std::vector<std::string> problems_of(const std::function<void()>& action) const {
        try {
            action();
        } catch (const InputError& error) {
            auto problems = error.problems();
            for (std::string& problem : problems) problem = without_folder(problem);
            return problems;
        }
        return {};
    }
    static const MappedTable& of(const std::vector<ImportTable>& tables, Role role) {
        return std::ranges::find(tables, role, [](const ImportTable& table) { return table.map.role; })->map;
    }

    /// Numbers were printed with nine digits.
    void expect_truth(const Recording& read) const {
        ASSERT_EQ(read.scans.size(), truth_.scans.size());
        ASSERT_EQ(read.diameter.size(), truth_.diameter.size());
        for (std::size_t i = 0; i < truth_.diameter.size(); ++i)
            EXPECT_NEAR(read.diameter[i], truth_.diameter[i], 1e-10);
        for (std::size_t s = 0; s < truth_.scans.size(); ++s) {
            const Scan &a = read.scans[s], &b = truth_.scans[s];
            EXPECT_EQ(a.frame, b.frame);
            EXPECT_EQ(a.phase, b.phase) << s;
            EXPECT_EQ(a.cycle, 0);
            EXPECT_NEAR(a.plate_z, b.plate_z, 1e-10);
            EXPECT_NEAR(a.top_force(), b.top_force(), 1e-8);
            ASSERT_EQ(a.position.size(), b.position.size());
            for (std::size_t i = 0; i < b.position.size(); ++i)
                EXPECT_LT((a.position[i] - b.position[i]).norm(), 1e-9);
            expect_contacts(a, b);
        }
    }
    static void expect_contacts(Scan a, Scan b) {
        ASSERT_EQ(a.contacts.size(), b.contacts.size());
        for (Scan* scan : {&a, &b})
            std::ranges::sort(scan->contacts, {},
                              [](const Contact& c) { return std::pair(c.grain, c.partner); });
        for (std::size_t c = 0; c < b.contacts.size(); ++c) {
            EXPECT_EQ(a.contacts[c].grain, b.contacts[c].grain);
            EXPECT_EQ(a.contacts[c].partner, b.contacts[c].partner);
            EXPECT_LT((a.contacts[c].force - b.contacts[c].force).norm(), 1e-8);
            EXPECT_LT((a.contacts[c].point - b.contacts[c].point).norm(), 1e-9);
        }
    }

    std::filesystem::path folder_;
    Recording truth_ = pressed_packing();
    Experiment known_ = known_of_pressed_packing();
};

}  // namespace mcdem::test
