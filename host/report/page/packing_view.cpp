#include "report/page/packing_view.h"

#include <fmt/format.h>

#include <algorithm>
#include <cmath>
#include <numeric>

#include "core/container.h"
#include "metrics/stress_strain.h"
#include "report/page/labels.h"

namespace mcdem::inline report {
namespace {

/// Five digits: less than a pixel, and half the size of the page.
double rounded(double value) {
    if (value == 0 || !std::isfinite(value)) return value;
    const double unit = std::pow(10, std::floor(std::log10(std::fabs(value))) - 4);
    const double scaled = std::round(value / unit);
    return unit < 1 ? scaled / std::round(1 / unit) : scaled * unit;
}

/// The displayed grains, and the index of each grain among them (-1: not displayed).
struct Shown {
    std::vector<int> grains, place;
};

Shown shown_grains(const Recording& recording, int most) {
    const auto count = recording.diameter.size();
    Shown shown{std::vector<int>(count), std::vector<int>(count, -1)};
    std::iota(shown.grains.begin(), shown.grains.end(), 0);
    if (count > static_cast<std::size_t>(most)) {
        const auto& position = recording.scans.front().position;
        const double middle = recording.box.size_y / 2;
        const auto away = [&](int grain) { return std::fabs(position[grain].y() - middle); };
        std::nth_element(shown.grains.begin(), shown.grains.begin() + most, shown.grains.end(),
                         [&](int a, int b) { return away(a) < away(b); });
        shown.grains.resize(static_cast<std::size_t>(most));
        std::ranges::sort(shown.grains);
    }
    for (std::size_t g = 0; g < shown.grains.size(); ++g) shown.place[shown.grains[g]] = static_cast<int>(g);
    return shown;
}

/// Description of a cell's scan, without its number.
std::string words_of_cell(const Scan& scan) {
    const double p = mean_stress(scan.stress);
    const StressUnit unit = stress_unit(p);
    return fmt::format("volume strain {:.2f} %, deviatoric strain {:.2f} %, φ {:.3f}, p {:.4g} {}",
                       100 * volume_strain(scan.strain), 100 * deviatoric_strain(scan.strain),
                       scan.packing_fraction, p / unit.size, unit.name);
}

std::string title_of(const Recording& recording, const Scan& scan) {
    if (is_cell(recording.box)) return fmt::format("scan {}: {}", scan.frame, words_of_cell(scan));
    return fmt::format("scan {}: {:.2f} mm, {}ing, cycle {}, top force {:.4g} N", scan.frame,
                       recording.displacement(scan) / mm, name(scan.phase), scan.cycle + 1, scan.top_force());
}

Json scan_json(const Recording& recording, const Scan& scan, const Shown& shown) {
    Json json{{"frame", scan.frame},
              {"title", title_of(recording, scan)},
              {"displacement_mm", rounded(recording.displacement(scan) / mm)},
              {"plate_mm", rounded(scan.plate_z / mm)}};
    const Box now = deformed(recording.box, scan.strain);
    if (is_cell(now))
        for (const double length :
             {now.size_x, now.size_y, now.height, now.tilt_xy, now.tilt_xz, now.tilt_yz})
            json["cell_mm"].push_back(rounded(length / mm));
    const char* axes[]{"x_mm", "y_mm", "z_mm"};
    for (int a = 0; a < 3; ++a) {
        auto& list = json[axes[a]] = Json::array();
        for (const int grain : shown.grains)
            list.push_back(rounded(into_cell(now, scan.position[grain])[a] / mm));
    }
    Json grain = Json::array(), partner = Json::array(), force = Json::array();
    for (const auto& contact : scan.contacts) {
        const int from = shown.place[contact.grain];
        const int to = is_wall(contact.partner) ? contact.partner : shown.place[contact.partner];
        if (from < 0 || (to < 0 && !is_wall(contact.partner))) continue;
        grain.push_back(from), partner.push_back(to), force.push_back(rounded(contact.force.norm() / mN));
    }
    json["grain"] = grain, json["partner"] = partner, json["force_mN"] = force;
    return json;
}

Json setting_json(const ShownPacking& packing, const PackingLimits& limits) {
    const auto& recording = packing.recording;
    const auto shown = shown_grains(recording, limits.max_grains);
    Json diameters = Json::array(), scans = Json::array();
    for (const int grain : shown.grains) diameters.push_back(rounded(recording.diameter[grain] / mm));
    for (const auto& scan : recording.scans) scans.push_back(scan_json(recording, scan, shown));
    double top = 0;
    for (const auto& scan : recording.scans) top = std::fmax(top, scan.plate_z);
    return {{"label", one_line(packing.label)},
            {"container", name(recording.box.shape)},
            {"box_mm", {rounded(recording.box.size_x / mm), rounded(recording.box.size_y / mm)}},
            {"top_mm", rounded(top / mm)},
            {"number", shown.grains},
            {"diameter_mm", diameters},
            {"strongest", strongest_scan(recording).value_or(0)},
            {"scans", scans}};
}

/// Quantile of 0.995; 1 if there are no values.
double colour_end(std::vector<double> values) {
    if (values.empty()) return 1;
    const auto place = values.end() - 1 - static_cast<std::ptrdiff_t>(values.size() / 200);
    std::nth_element(values.begin(), place, values.end());
    return *place > 0 ? rounded(*place) : 1;
}

/// Forces of contacts and on grains, for all scans [mN].
struct Forces {
    std::vector<double> contact, grain;
};

void add_forces(const Scan& scan, Forces& forces) {
    std::vector<double> load(scan.position.size(), 0);
    for (const auto& contact : scan.contacts) {
        const double force = contact.force.norm() / mN;
        forces.contact.push_back(force);
        load[contact.grain] += force;
        if (!is_wall(contact.partner)) load[contact.partner] += force;
    }
    forces.grain.insert(forces.grain.end(), load.begin(), load.end());
}

}  // namespace

long numbers_of_scan(long grains, long contacts) { return 3 * (grains + contacts); }

std::vector<std::size_t> scans_shown(const Recording& recording, long numbers, const PackingLimits& limits) {
    const auto count = recording.scans.size();
    const auto room = limits.scans ? static_cast<long>(*limits.scans)
                                   : std::max(3L, limits.max_numbers / std::max(1L, numbers));
    const auto most = std::min(count, static_cast<std::size_t>(room));
    const auto strongest = strongest_scan(recording).value_or(count - 1);
    if (most == 1) return {strongest};
    std::vector<std::size_t> shown;
    for (std::size_t s = 0; s < most; ++s) shown.push_back((s * (count - 1) + (most - 1) / 2) / (most - 1));
    if (most < 3) return shown;
    const auto away = [&](std::size_t scan) {
        return scan > strongest ? scan - strongest : strongest - scan;
    };
    if (strongest > 0 && strongest + 1 < count)
        *std::min_element(shown.begin() + 1, shown.end() - 1,
                          [&](std::size_t a, std::size_t b) { return away(a) < away(b); }) = strongest;
    return shown;
}

std::optional<Json> packing_view(const std::vector<ShownPacking>& packings, const PackingLimits& limits) {
    Json settings = Json::array();
    Forces forces;
    for (auto packing : packings) {
        auto& recording = packing.recording;
        std::erase_if(recording.scans, [](const Scan& scan) { return scan.position.empty(); });
        if (recording.scans.empty()) continue;
        for (const auto& scan : recording.scans) add_forces(scan, forces);
        settings.push_back(setting_json(packing, limits));
    }
    if (settings.empty()) return std::nullopt;
    return Json{{"settings", settings},
                {"force_mN", colour_end(std::move(forces.contact))},
                {"load_mN", colour_end(std::move(forces.grain))}};
}

}  // namespace mcdem::report
