// Reports of portions of replicas, as results of intervals.
#pragma once
#include <algorithm>
#include <vector>

#include "sim/engine.h"

namespace mcdem::inline sim {

template <class Report>
IntervalResult to_result(const Report& report) {
    IntervalResult result;
    result.kinetic_energy = report.kinetic_energy;
    result.elastic_energy = double(report.elastic_energy) + report.spring_energy;
    result.spring_energy = report.spring_energy;
    result.weight_work = report.weight_work;
    result.work = report.work;
    result.damped = report.damped;
    result.rubbed = report.rubbed;
    result.dragged = report.dragged;
    result.deepest_overlap = report.deepest_overlap;
    result.step_rate = report.step_rate;
    for (int w = 0; w < wall_count; ++w)
        result.wall_force[w] = {report.wall_force[3 * w], report.wall_force[3 * w + 1],
                                report.wall_force[3 * w + 2]};
    result.status = report.status;
    result.failed_grain = report.failed_grain;
    return result;
}

template <class Report>
void add(Report& sum, const Report& portion) {
    sum.kinetic_energy += portion.kinetic_energy;
    sum.elastic_energy += portion.elastic_energy;
    sum.spring_energy += portion.spring_energy;
    sum.weight_work += portion.weight_work;
    sum.work += portion.work;
    sum.damped += portion.damped;
    sum.rubbed += portion.rubbed;
    sum.dragged += portion.dragged;
    sum.moved_squared = std::max(sum.moved_squared, portion.moved_squared);
    sum.deepest_overlap = std::max(sum.deepest_overlap, portion.deepest_overlap);
    sum.step_rate = std::max(sum.step_rate, portion.step_rate);
    for (int q = 0; q < 3 * wall_count; ++q) sum.wall_force[q] += portion.wall_force[q];
    sum.status |= portion.status;
    if (sum.failed_grain < 0) sum.failed_grain = portion.failed_grain;
}

/// A replica's report is the sum of the reports of its portions, in the order of its grains.
template <class Report>
std::vector<Report> by_replica(const std::vector<Portion>& portions, const std::vector<Report>& found,
                               int replicas) {
    std::vector<Report> reports(replicas);
    for (std::size_t p = 0; p < portions.size(); ++p) {
        Report& report = reports[portions[p].replica];
        if (portions[p].first == 0)
            report = found[p];
        else
            add(report, found[p]);
    }
    return reports;
}

}  // namespace mcdem::sim
