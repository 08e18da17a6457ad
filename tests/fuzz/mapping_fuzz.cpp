// Any bytes as a mapping: read or an InputError; what was read is the same once written and read again, and
// tables that are there are imported by it or refused.
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <string_view>

#include "core/errors.h"
#include "experiment/import_experiment.h"

namespace {

using namespace mcdem;

std::shared_ptr<const ForeignTable> table(std::string text) {
    return std::make_shared<const ForeignTable>(parse_foreign_table(std::move(text), "table"));
}

/// Of each role two frames of two grains that touch, with names as in the corpus.
const std::shared_ptr<const ForeignTable>& table_of(Role role) {
    static const auto plate = table("t,z,F\n0,0.03,0\n1,0.029,0.5\n"),
                      grains = table(
                          "t,id,x,y,z,d\n0,1,0.01,0.01,0.01,0.02\n0,2,0.029,0.01,0.01,0.02\n"
                          "1,1,0.01,0.01,0.01,0.02\n1,2,0.029,0.01,0.01,0.02\n"),
                      contacts = table(
                          "t,i,j,x,y,z,fx,fy,fz,w\n0,1,2,0.02,0.01,0.01,-0.1,0,0,1\n"
                          "1,2,1,0.02,0.01,0.01,0.1,0,0,1\n1,1,floor,0.01,0.01,0,0,0,0.2,1\n1,2,-3,0.03,0.01,"
                          "0,0,0,0.2,0\n");
    return role == Role::plate ? plate : role == Role::grains ? grains : contacts;
}

void expect_same(const Mapping& first, const Mapping& again) {
    bool same = first.tables.size() == again.tables.size();
    const auto words = [](const auto& guesses) {
        std::vector<std::vector<std::string>> all;
        for (const auto& [key, guess] : guesses) all.push_back({key}), all.push_back(guess.words);
        return all;
    };
    for (std::size_t t = 0; same && t < first.tables.size(); ++t) {
        const MappedTable &a = first.tables[t], &b = again.tables[t];
        same = a.role == b.role && a.files == b.files && a.form == b.form &&
               words(a.entries) == words(b.entries) && words(a.walls) == words(b.walls);
    }
    if (same) return;
    std::fprintf(stderr, "%s\n", mapping_text(first).c_str());
    std::abort();
}

}  // namespace

extern "C" int LLVMFuzzerTestOneInput(const std::uint8_t* bytes, std::size_t size) {
    Mapping mapping;
    try {
        mapping = parse_mapping({reinterpret_cast<const char*>(bytes), size}, "m");
    } catch (const InputError&) {
        return 0;
    }
    expect_same(mapping, parse_mapping(mapping_text(mapping), "again"));
    Experiment known;
    known.recording.box = {0.04, 0.03};
    known.recording.plate_start = 0.03;
    std::vector<ImportTable> tables;
    for (const MappedTable& map : mapping.tables)
        if (map.role != Role::aside) tables.push_back({map, {table_of(map.role)}});
    try {
        import_tables(tables, known);
    } catch (const InputError&) {
    }
    return 0;
}
