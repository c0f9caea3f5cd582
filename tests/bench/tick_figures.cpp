#include "tests/bench/tick_figures.h"

#include <Eigen/Core>
#include <algorithm>

#include "tests/bench/bench_output.h"

namespace bonemill::bench {
namespace {

double forceStep(const TickRecord& a, const TickRecord& b) {
    return (Eigen::Map<const Eigen::Vector3d>(a.f_hand_W) - Eigen::Map<const Eigen::Vector3d>(b.f_hand_W))
        .norm();
}

}  // namespace

TickFigures figuresOf(const std::vector<TickRecord>& records, size_t approach_ticks) {
    TickFigures figures;
    double contacts = 0, candidates = 0, iterations = 0, removed = 0;
    int in_contact = 0;
    for (size_t n = 0; n < records.size(); ++n) {
        const TickRecord& r = records[n];
        figures.faults |= r.faults;
        removed += r.removed_voxels;
        if (n < approach_ticks) continue;
        figures.whole.record(r.compute_ns);
        figures.force.record(r.force_ns);
        figures.milling.record(r.compute_ns - r.force_ns);
        in_contact += r.contacts > 0;
        contacts += r.contacts;
        candidates += r.candidates;
        iterations += r.iterations;
        if (n > 0) figures.force_step_max = std::max(figures.force_step_max, forceStep(r, records[n - 1]));
    }
    const auto mean = [](double sum, double count) { return count > 0 ? sum / count : 0; };
    figures.contacts_mean = mean(contacts, in_contact);
    figures.candidates_mean = mean(candidates, double(figures.whole.count()));
    figures.iterations_mean = mean(iterations, double(figures.whole.count()));
    figures.removed_voxels_per_tick = mean(removed, double(records.size()));
    return figures;
}

nlohmann::json toJson(const TickFigures& f) {
    return {{"tick_us", microseconds(f.whole)},
            {"force_us", microseconds(f.force)},
            {"milling_us", microseconds(f.milling)},
            {"contacts_mean", f.contacts_mean},
            {"candidates_mean", f.candidates_mean},
            {"iterations_mean", f.iterations_mean},
            {"removed_voxels_per_tick", f.removed_voxels_per_tick},
            {"force_step_max_n", f.force_step_max},
            {"faults", f.faults}};
}

}  // namespace bonemill::bench
