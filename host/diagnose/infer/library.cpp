#include "diagnose/infer/library.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "core/errors.h"
#include "core/input_file.h"
#include "core/look.h"
#include "core/sha256.h"
#include "diagnose/infer/json_numbers.h"

namespace mcdem::inline diagnose {

NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(HoldScans, begin, first, end, keep, phase, displacement)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Grid, displacement, width, stroke, force, force_width, holds)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Signature, name, reach, linear, curvature, slopes)
NLOHMANN_DEFINE_TYPE_NON_INTRUSIVE(Library, baseline, packing, effects, nuisances, provenance, origin)

namespace {

using nlohmann::json;
constexpr int library_format = 4;
const char* const other_observables = "it has other observables than this program";

std::string digest_of(const std::map<std::string, std::string>& origin) {
    Sha256 digest;
    for (const auto& [name, value] : origin) digest.add(name).add("=").add(value).add("\n");
    return digest.hex();
}

/// Digest of everything except the digest itself.
std::string digest_of_content(json j) {
    j.erase("sha256");
    return Sha256().add(j.dump()).hex();
}

void expect_cells(const std::vector<Signature>& signatures, Eigen::Index cells, const json& j) {
    for (const Signature& s : signatures) {
        expect_json(s.linear.size() == cells && s.curvature.size() == cells,
                    "signature " + s.name + " is of another length than the cells", j);
        expect_json(s.pairs() == 0 || s.slopes.cols() == cells, other_observables, j);
    }
}

void expect_grid(const Grid& grid, const json& j) {
    for (const HoldScans& hold : grid.holds)
        expect_json(0 <= hold.begin && hold.begin <= hold.first && hold.first <= hold.end,
                    "it has a hold that cannot be", j);
    expect_json(grid.force.empty() || grid.force.size() == grid.displacement.size(),
                "it has another number of forces than displacements", j);
}

Library library_of(const json& j) {
    expect_json(j.at("format") == library_format, "it is of another version", j);
    Library library = j;
    j.get_to(library.grid);
    expect_grid(library.grid, j);
    expect_json(!library.packing.empty(), "it has no replicates", j);
    const auto cells = static_cast<Eigen::Index>(cells_of(library.grid).size());
    expect_json(library.baseline.cols() == cells, other_observables, j);
    expect_json(library.baseline.rows() == static_cast<Eigen::Index>(library.packing.size()),
                "it has another number of replicates than packings", j);
    expect_cells(library.effects, cells, j);
    expect_cells(library.nuisances, cells, j);
    expect_json(j.at("origin_sha256") == digest_of(library.origin), "what it says of its origin was changed",
                j);
    expect_json(!j.contains("sha256") || j.at("sha256") == digest_of_content(j),
                "it was changed since it was written", j);
    return library;
}

}  // namespace

std::vector<int> mean_groups(const Library& library) {
    std::map<int, int> rows;
    for (const int packing : library.packing) ++rows[packing];
    const bool repeated = std::ranges::all_of(rows, [](const auto& of) { return of.second > 1; });
    return repeated ? library.packing : std::vector<int>(library.packing.size(), 0);
}

Eigen::MatrixXd apart_from_mean(Eigen::MatrixXd rows, const std::vector<int>& group) {
    std::map<int, std::vector<Eigen::Index>> of;
    for (std::size_t r = 0; r < group.size(); ++r) of[group[r]].push_back(static_cast<Eigen::Index>(r));
    for (const auto& [_, members] : of) {
        const double n = static_cast<double>(members.size());
        const Eigen::RowVectorXd mean = rows(members, Eigen::all).colwise().sum() / n;
        for (const auto row : members)
            rows.row(row) = (rows.row(row) - mean) * std::sqrt(n / std::max(1.0, n - 1));
    }
    return rows;
}

Eigen::MatrixXd scatter(const Library& library) {
    return apart_from_mean(library.baseline, mean_groups(library));
}

std::string library_text(const Library& library) {
    json text = library;
    text.update(library.grid);
    text["format"] = library_format;
    text["origin_sha256"] = digest_of(library.origin);
    text["sha256"] = digest_of_content(text);
    return text.dump();
}

bool write_library(const std::filesystem::path& file, const Library& library) {
    return create_file(file, library_text(library));
}

Library read_library(const std::filesystem::path& file) {
    if (!is_there(file)) throw InputError(fmt::format("{}: there is no signature library", file.string()));
    if (!is_file(file))
        throw InputError(fmt::format("{}: must be a file, the signature library", file.string()));
    const std::string text = read_file(file);
    try {
        return library_of(json::parse(text));
    } catch (const json::exception& error) {
        throw InputError(
            fmt::format("{}: not a signature library ({}): give another file name; it is created if missing",
                        file.string(), error.what()));
    }
}

}  // namespace mcdem::diagnose
