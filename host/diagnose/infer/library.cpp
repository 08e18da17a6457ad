#include "diagnose/infer/library.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <nlohmann/json.hpp>

#include "core/atomic_file.h"
#include "core/errors.h"
#include "core/input_file.h"
#include "core/sha256.h"
#include "diagnose/infer/json_numbers.h"

namespace mcdem::inline diagnose {
namespace {

using nlohmann::json;
constexpr int library_format = 4;

json rows_json(const Eigen::MatrixXd& rows) {
    json list = json::array();
    for (const auto& row : rows.rowwise()) list.push_back(numbers_json(row));
    return list;
}

Eigen::MatrixXd rows_of(const json& list, Eigen::Index cells) {
    Eigen::MatrixXd rows(static_cast<Eigen::Index>(list.size()), cells);
    for (std::size_t r = 0; r < list.size(); ++r) {
        const Eigen::VectorXd row = numbers_of(list[r]);
        if (row.size() != cells)
            throw json::other_error::create(501, "it has other observables than this program", &list);
        rows.row(static_cast<Eigen::Index>(r)) = row;
    }
    return rows;
}

json signature_json(const Signature& s) {
    return {{"name", s.name},
            {"reach", s.reach},
            {"linear", numbers_json(s.linear)},
            {"curvature", numbers_json(s.curvature)},
            {"variance", numbers_json(s.variance)},
            {"slopes", rows_json(s.slopes)}};
}

Signature signature_of(const json& j, Eigen::Index cells) {
    Signature s{j.at("name"),
                j.at("reach"),
                numbers_of(j.at("linear")),
                numbers_of(j.at("curvature")),
                numbers_of(j.at("variance")),
                rows_of(j.at("slopes"), cells)};
    if (s.linear.size() != cells || s.curvature.size() != cells || s.variance.size() != cells)
        throw json::other_error::create(501, "signature " + s.name + " is of another length than the cells",
                                        &j);
    return s;
}

json holds_json(const std::vector<HoldScans>& holds) {
    json list = json::array();
    for (const HoldScans& hold : holds)
        list.push_back({{"begin", hold.begin},
                        {"first", hold.first},
                        {"end", hold.end},
                        {"keep", name(hold.keep)},
                        {"phase", name(hold.phase)},
                        {"displacement", hold.displacement}});
    return list;
}

std::vector<HoldScans> holds_of(const json& list) {
    std::vector<HoldScans> holds;
    for (const json& j : list) {
        const auto keep = parse<Controlled>(j.at("keep").get<std::string>());
        const auto phase = parse<Phase>(j.at("phase").get<std::string>());
        const HoldScans hold{j.at("begin"),
                             j.at("first"),
                             j.at("end"),
                             keep.value_or(Controlled::position),
                             phase.value_or(Phase::load),
                             j.at("displacement")};
        if (!keep || !phase || hold.begin < 0 || hold.begin > hold.first || hold.first > hold.end)
            throw json::other_error::create(501, "it has a hold that cannot be", &j);
        holds.push_back(hold);
    }
    return holds;
}

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

Library library_of(const json& j) {
    if (j.at("format") != library_format)
        throw json::other_error::create(501, "it is of another version", &j);
    Library library;
    library.grid = {j.at("displacement"), j.at("width"),       j.at("stroke"),
                    j.at("force"),        j.at("force_width"), holds_of(j.at("holds"))};
    if (!library.grid.force.empty() && library.grid.force.size() != library.grid.displacement.size())
        throw json::other_error::create(501, "it has another number of forces than displacements", &j);
    library.packing = j.at("packing").get<std::vector<int>>();
    if (library.packing.empty()) throw json::other_error::create(501, "it has no replicates", &j);
    const auto cells = static_cast<Eigen::Index>(cells_of(library.grid).size());
    library.baseline = rows_of(j.at("baseline"), cells);
    if (library.baseline.rows() != static_cast<Eigen::Index>(library.packing.size()))
        throw json::other_error::create(501, "it has another number of replicates than packings", &j);
    for (const json& s : j.at("effects")) library.effects.push_back(signature_of(s, cells));
    for (const json& s : j.at("nuisances")) library.nuisances.push_back(signature_of(s, cells));
    library.provenance = j.at("provenance").get<std::map<std::string, std::string>>();
    library.origin = j.at("origin").get<std::map<std::string, std::string>>();
    if (j.at("origin_sha256") != digest_of(library.origin))
        throw json::other_error::create(501, "what it says of its origin was changed", &j);
    if (j.contains("sha256") && j.at("sha256") != digest_of_content(j))
        throw json::other_error::create(501, "it was changed since it was written", &j);
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
    json effects = json::array(), nuisances = json::array();
    for (const Signature& s : library.effects) effects.push_back(signature_json(s));
    for (const Signature& s : library.nuisances) nuisances.push_back(signature_json(s));
    json text{{"format", library_format},
              {"provenance", library.provenance},
              {"origin", library.origin},
              {"origin_sha256", digest_of(library.origin)},
              {"displacement", library.grid.displacement},
              {"width", library.grid.width},
              {"stroke", library.grid.stroke},
              {"force", library.grid.force},
              {"force_width", library.grid.force_width},
              {"holds", holds_json(library.grid.holds)},
              {"packing", library.packing},
              {"effects", effects},
              {"nuisances", nuisances},
              {"baseline", rows_json(library.baseline)}};
    text["sha256"] = digest_of_content(text);
    return text.dump();
}

bool write_library(const std::filesystem::path& file, const Library& library) {
    return create_file(file, library_text(library));
}

Library read_library(const std::filesystem::path& file) {
    if (!std::filesystem::exists(file))
        throw InputError(fmt::format("{}: there is no signature library", file.string()));
    if (!std::filesystem::is_regular_file(file))
        throw InputError(fmt::format("{}: must be a file, the signature library", file.string()));
    const std::string text = read_file(file);
    try {
        return library_of(json::parse(text));
    } catch (const json::exception& error) {
        throw InputError(fmt::format(
            "{}: not a signature library ({}): give another file, which is made where it is missing",
            file.string(), error.what()));
    }
}

}  // namespace mcdem::diagnose
