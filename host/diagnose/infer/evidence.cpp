#include "diagnose/infer/evidence.h"

#include <fmt/format.h>

#include <cmath>
#include <functional>
#include <numeric>
#include <stdexcept>

#include "core/errors.h"

namespace mcdem::inline diagnose {
namespace {

const Signature& find(const std::vector<Signature>& list, const std::string& name) {
    const auto found = std::ranges::find(list, name, &Signature::name);
    if (found == list.end()) throw std::logic_error("no signature of " + name);
    return *found;
}

/// Largest allowed shift of a parameter, in sigmas of its prior.
constexpr double farthest = 12;

/// Mean over the finite rows.
Eigen::VectorXd column_means(const Eigen::MatrixXd& rows) {
    Eigen::VectorXd mean(rows.cols());
    for (Eigen::Index cell = 0; cell < rows.cols(); ++cell) {
        const auto column = rows.col(cell).array();
        mean[cell] =
            column.isFinite().select(column, 0).sum() / static_cast<double>(column.isFinite().count());
    }
    return mean;
}

constexpr int max_folds = 8;

/// `packing`: index of the packing of each replicate, from 0.
int count_packings(const std::vector<int>& packing) { return 1 + *std::ranges::max_element(packing); }

/// Replicates of one packing are correlated through their mean. They are left out together if there are
/// enough packings.
std::vector<int> folds_of(const std::vector<int>& packing) {
    const int packings = count_packings(packing);
    std::vector<int> fold;
    for (std::size_t r = 0; r < packing.size(); ++r)
        fold.push_back((packings >= max_folds ? packing[r] : static_cast<int>(r)) % max_folds);
    return fold;
}

/// Fraction of the known cells that a signature must have. Otherwise it can explain no more than a part of
/// the gap, and a parameter would exclude most cells.
constexpr double enough_cells = 0.5;
constexpr std::size_t min_replicates = 8, min_own_replicates = 4;

std::string cause_of(const FailureCauses& causes, const std::string& name, const std::string& otherwise) {
    const auto cause = causes.find(name);
    return cause == causes.end() ? otherwise : cause->second;
}

void keep_rows(Library& library, const std::vector<Eigen::Index>& kept) {
    library.baseline = Eigen::MatrixXd(library.baseline(kept, Eigen::all));
    std::vector<int> packing;
    for (const auto r : kept) packing.push_back(library.packing[r]);
    library.packing = packing;
}

/// Whether these rows contain two replicates of each packing that has two.
bool keeps_packings(const std::vector<int>& packing, const std::vector<Eigen::Index>& rows) {
    std::map<int, int> left;
    for (const auto row : rows) ++left[packing[row]];
    return std::ranges::all_of(packing, [&](int p) {
        return left[p] >= std::min<std::ptrdiff_t>(2, std::ranges::count(packing, p));
    });
}

void leave_out_replicates(Evidence& evidence, const FailureCauses& causes, std::vector<std::string>& notes) {
    Library& library = evidence.library;
    const auto kept = rows_with_numbers(library.baseline), own = rows_with_numbers(evidence.baseline);
    const auto failed = std::max(static_cast<std::size_t>(library.baseline.rows()) - kept.size(),
                                 static_cast<std::size_t>(evidence.baseline.rows()) - own.size());
    if (failed == 0) return;
    const std::string what = fmt::format("{} of {} runs of the scene as it stands failed", failed,
                                         std::max(library.baseline.rows(), evidence.baseline.rows()));
    if (kept.size() < min_replicates || own.empty())
        throw InputError(fmt::format(
            "{}: {}; try `mcdem run` of the scene with plate.start and plate.end of the "
            "experiment",
            what,
            cause_of(causes, "",
                     "the packing runs away, or the scene cannot follow the experiment's plate")));
    notes.push_back("replicates: " + what + " and are left out" +
                    (causes.contains("") ? ": " + causes.at("") : ""));
    keep_rows(library, kept);
    evidence.baseline = Eigen::MatrixXd(evidence.baseline(own, Eigen::all));
}

/// Leaves out of the noise those replicates that lack the most cells, if more values remain without them:
/// a cell is compared only if every replicate has it. Packings keep two replicates.
void leave_out_incomplete(Evidence& evidence, std::vector<std::string>& notes) {
    Library& library = evidence.library;
    const Eigen::Index all = library.baseline.rows();
    const auto values = [](const Eigen::MatrixXd& rows) {
        return rows.rows() * rows.array().isFinite().colwise().all().count();
    };
    std::vector<Eigen::Index> order(static_cast<std::size_t>(all)), kept;
    std::iota(order.begin(), order.end(), Eigen::Index{0});
    const Eigen::ArrayXi has = library.baseline.array().isFinite().rowwise().count().cast<int>();
    std::ranges::stable_sort(order, std::greater(), [&](Eigen::Index row) { return has[row]; });
    Eigen::Index most = values(library.baseline);
    for (std::size_t n = order.size() - 1; n >= min_replicates; --n) {
        std::vector<Eigen::Index> fullest(order.begin(), order.begin() + static_cast<std::ptrdiff_t>(n));
        const Eigen::Index left = values(library.baseline(fullest, Eigen::all));
        if (left <= most || !keeps_packings(library.packing, fullest)) continue;
        most = left;
        kept = std::move(fullest);
    }
    if (kept.empty()) return;
    std::ranges::sort(kept);
    notes.push_back(
        fmt::format("replicates: {} of {} runs of the scene as it stands lack values that the "
                    "others have, and are left out of the noise",
                    all - static_cast<Eigen::Index>(kept.size()), all));
    keep_rows(library, kept);
}

/// Removes entries of `wanted` whose signature lacks most of the cells that all others have.
template <class Wanted>
void leave_out_signatures(const Evidence& evidence, const std::vector<Signature>& signatures,
                          const FailureCauses& causes, std::vector<Wanted>& wanted,
                          std::vector<std::string>& notes) {
    const Eigen::Array<bool, Eigen::Dynamic, 1> known =
        evidence.library.baseline.array().isFinite().colwise().all().transpose() &&
        evidence.observed.array().isFinite();
    std::erase_if(wanted, [&](const Wanted& w) {
        const Signature& s = find(signatures, w.name);
        const auto has = (known && s.linear.array().isFinite() && s.curvature.array().isFinite()).count();
        if (static_cast<double>(has) >= enough_cells * static_cast<double>(known.count())) return false;
        notes.push_back(
            has > 0 && !causes.contains(w.name)
                ? fmt::format("{}: with it only {} of {} bins have a value, so it cannot be tested", w.name,
                              has, known.count())
                : fmt::format("{}: its runs failed ({}), so it cannot be tested", w.name,
                              cause_of(causes, w.name, "the packing runs away with it")));
        return true;
    });
}

/// Whether the library contains many other packings. A library of few packings may contain the experiment's
/// own, whose replicates would be counted twice.
bool has_other_packings(const Evidence& evidence) {
    return !evidence.library_is_own && count_packings(evidence.library.packing) >= max_folds;
}

/// Adds the replicates of the experiment's own packing to the noise, as a further packing: packings differ in
/// their scatter. Uses those that have all selected cells. Each is left out separately, because the
/// experiment is compared when the others are known.
void add_own_scatter(GapData& data, const Eigen::MatrixXd& baseline) {
    std::vector<Eigen::Index> whole;
    for (Eigen::Index r = 0; r < baseline.rows(); ++r)
        if (baseline.row(r)(data.cells).array().isFinite().all()) whole.push_back(r);
    if (whole.size() < min_own_replicates) return;
    const std::vector<int> group(whole.size(), own_packing);
    Eigen::MatrixXd rows(data.noise.rows() + static_cast<Eigen::Index>(whole.size()), data.noise.cols());
    rows << data.noise, apart_from_mean(baseline(whole, Eigen::all), group);
    data.noise = rows;
    data.group.insert(data.group.end(), group.begin(), group.end());
    const int first = 1 + *std::ranges::max_element(data.fold);
    for (std::size_t k = 0; k < whole.size(); ++k)
        data.fold.push_back(first + static_cast<int>(k) % max_folds);
}

}  // namespace

Eigen::VectorXd PackingEvidence::gap() const { return observed - column_means(baseline); }

Eigen::MatrixXd mean_over_packings(const Eigen::MatrixXd& rows, int packings) {
    const Eigen::Index each = rows.rows() / packings;
    Eigen::MatrixXd sum = rows.topRows(each);
    for (int p = 1; p < packings; ++p) sum += rows.middleRows(p * each, each);
    return sum / packings;
}

void take_means(Evidence& evidence) {
    const double count = evidence.packing_count();
    evidence.observed = Eigen::VectorXd::Zero(evidence.packings.front().observed.size());
    evidence.baseline =
        Eigen::MatrixXd::Zero(evidence.packings.front().baseline.rows(), evidence.observed.size());
    for (const PackingEvidence& packing : evidence.packings) {
        evidence.observed += packing.observed / count;
        evidence.baseline += packing.baseline / count;
    }
}

std::vector<std::string> leave_out_failures(Evidence& evidence, const FailureCauses& causes) {
    std::vector<std::string> notes;
    leave_out_replicates(evidence, causes, notes);
    leave_out_incomplete(evidence, notes);
    leave_out_signatures(evidence, evidence.library.effects, causes, evidence.candidates, notes);
    leave_out_signatures(evidence, evidence.library.nuisances, causes, evidence.nuisances, notes);
    return notes;
}

Eigen::VectorXd GapData::in_range(Eigen::VectorXd nuisances) const {
    for (std::size_t k = 0; k < free.size(); ++k) {
        double& nuisance = nuisances[k];
        nuisance = std::clamp(nuisance, -farthest * free[k].sigma, farthest * free[k].sigma);
    }
    return nuisances;
}

CellChoice GapData::lacking(const std::vector<std::size_t>& chosen) const {
    std::vector<Candidate> some;
    for (const auto c : chosen) some.push_back(candidates[c]);
    return lacking_cells(some);
}

namespace {

/// Zero in cells without a value.
Signature completed(Signature s, const CellChoice& lacking) {
    for (const auto cell : lacking) {
        s.linear[cell] = s.curvature[cell] = 0;
        if (s.pairs() > 0) s.slopes.col(cell).setZero();
    }
    return s;
}

void add_effects(GapData& s, const Evidence& evidence) {
    for (const CandidateRange& range : evidence.candidates) {
        const Signature* signature = &find(evidence.library.effects, range.name);
        CellChoice lacking = lacking_cells(*signature);
        if (!lacking.empty())
            signature =
                s.completed.emplace_back(std::make_shared<Signature>(completed(*signature, lacking))).get();
        s.candidates.push_back({signature, range.low, range.high, std::move(lacking)});
    }
    s.effects = static_cast<int>(s.candidates.size());
}

CellChoice cells_where(const Eigen::Array<bool, Eigen::Dynamic, 1>& is) {
    CellChoice cells;
    for (Eigen::Index cell = 0; cell < is.size(); ++cell)
        if (is[cell]) cells.push_back(cell);
    return cells;
}

/// What lacks cells that the experiment and most of the replicates have.
std::vector<MissingBins> missing_bins(const Evidence& evidence, const GapData& data) {
    const Eigen::MatrixXd& baseline = evidence.library.baseline;
    Eigen::Array<bool, Eigen::Dynamic, 1> measured = evidence.observed.array().isFinite();
    for (const PackingEvidence& packing : evidence.packings)
        measured = measured || packing.observed.array().isFinite();
    const CellChoice possible = cells_where(
        measured &&
        2 * baseline.array().isFinite().cast<Eigen::Index>().colwise().sum().transpose() > baseline.rows());
    std::vector<MissingBins> missing;
    const auto add = [&](const std::string& name, const CellChoice& all, const CellChoice& rest) {
        const auto lost = all.size() - rest.size();
        if (lost > 0)
            missing.push_back(
                {name, static_cast<int>(lost), static_cast<int>(all.size()), &all == &possible});
    };
    add("", possible,
        without(possible, cells_where(!baseline.array().isFinite().colwise().all().transpose())));
    for (const PackingEvidence& packing : evidence.packings)
        add(packing.name, possible, without(possible, cells_where(!packing.observed.array().isFinite())));
    for (const NuisancePrior& prior : evidence.nuisances)
        add(prior.name, possible,
            without(possible, lacking_cells(find(evidence.library.nuisances, prior.name))));
    for (std::size_t c = 0; c < static_cast<std::size_t>(data.effects); ++c)
        add(data.name(c), data.cells, without(data.cells, data.candidates[c].lacking));
    return missing;
}

}  // namespace

bool GapData::at_end_of_range(double nuisance, double sigma) {
    return std::abs(nuisance) >= (1 - 1e-9) * farthest * sigma;
}

std::vector<const Signature*> parameters_of(const Evidence& evidence) {
    std::vector<const Signature*> signatures;
    for (const NuisancePrior& prior : evidence.nuisances)
        signatures.push_back(&find(evidence.library.nuisances, prior.name));
    return signatures;
}

GapData gap_data(const Evidence& evidence) {
    GapData s;
    s.mean = column_means(evidence.baseline);
    s.gap = evidence.observed - s.mean;
    s.packings = evidence.packing_count();
    s.noise = scatter(evidence.library) / std::sqrt(s.packings);
    s.group = mean_groups(evidence.library);
    s.fold = folds_of(evidence.library.packing);
    for (const NuisancePrior& prior : evidence.nuisances)
        s.free.push_back({find(evidence.library.nuisances, prior.name).linear, prior.sigma});
    add_effects(s, evidence);
    s.cells = usable_cells(evidence.library.baseline, parameters_of(evidence), s.gap);
    s.missing = missing_bins(evidence, s);
    if (has_other_packings(evidence)) add_own_scatter(s, evidence.baseline);
    for (const NuisancePrior& prior : evidence.nuisances)
        if (prior.name == "modulus" || prior.name == "strain_offset" || prior.name == "gamma")
            s.candidates.push_back({&find(evidence.library.nuisances, prior.name), -farthest * prior.sigma,
                                    farthest * prior.sigma});
    return s;
}

}  // namespace mcdem::diagnose
