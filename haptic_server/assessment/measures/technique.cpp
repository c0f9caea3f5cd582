#include "haptic_server/assessment/measures/technique.h"

#include "common/base/units.h"

namespace bonemill {
namespace {

std::vector<Series> columnsOf(const std::vector<StepSums>& rows, const TechniqueScene& scene) {
    std::vector<Series> columns;
    const auto add = [&](const char* id, const char* label, const char* unit, auto value_of) {
        Series column{id, label, unit, {}};
        for (const StepSums& row : rows) column.values.push_back(value_of(row));
        columns.push_back(std::move(column));
    };
    constexpr double kNone = std::numeric_limits<double>::quiet_NaN();
    const auto ifFinite = [](double value) { return std::isfinite(value) ? value : kNone; };
    add("time", "Time", "s", [](const StepSums& row) { return row.time; });
    add("contact", "In contact", "s", [](const StepSums& row) { return row.contact_time; });
    add("force", "Force in contact, mean", "N",
        [&](const StepSums& row) { return row.contact_time > 0 ? row.impulse / row.contact_time : kNone; });
    add("force_max", "Force in contact, largest", "N",
        [&](const StepSums& row) { return row.contact_time > 0 ? row.max_force : kNone; });
    add("path", "Way of the burr", "mm", [](const StepSums& row) { return row.way * kPerMillimetre; });
    add("removed", "Removed", "mm3", [](const StepSums& row) { return row.removed * kPerCubicMillimetre; });
    add("unseen", "Removed out of sight", "percent",
        [&](const StepSums& row) { return ifFinite(100 * row.unseen / (row.seen + row.unseen)); });
    if (scene.recorded.protection)
        add("distance", "Least distance to a structure", "mm",
            [&](const StepSums& row) { return ifFinite(row.distance * kPerMillimetre); });
    if (scene.recorded.heat)
        add("temperature", "Hottest bone", "degC",
            [&](const StepSums& row) { return ifFinite(row.temperature); });
    return columns;
}

}  // namespace

// Half a voxel per step misses no wall of a voxel's thickness.
bool isHidden(const VoxelVolume& volume, const Eigen::Vector3d& p_eye_W, const Eigen::Vector3d& p_target_W,
              double margin) {
    const Pose X_VW = volume.geometry().X_WV.inverse();
    const Eigen::Vector3d eye_I = (X_VW * p_eye_W).cwiseQuotient(volume.spacing());
    const Eigen::Vector3d target_I = (X_VW * p_target_W).cwiseQuotient(volume.spacing());
    const double distance = (p_target_W - p_eye_W).norm();
    if (!(distance > margin)) return false;
    const Eigen::Vector3d way = (target_I - eye_I) * (1 - margin / distance);
    // Only the part in the volume is walked.
    double first = 0, last = 1;
    for (int axis = 0; axis < 3; ++axis) {
        const double high = volume.dims()[axis] - 1;
        if (std::abs(way[axis]) < 1e-12) {
            if (eye_I[axis] < 0 || eye_I[axis] > high) return false;
            continue;
        }
        const double a = -eye_I[axis] / way[axis], b = (high - eye_I[axis]) / way[axis];
        first = std::max(first, std::min(a, b));
        last = std::min(last, std::max(a, b));
    }
    if (first > last) return false;
    const auto steps = std::max(1, int(std::ceil(2 * way.norm() * (last - first))));
    for (int step = 0; step <= steps; ++step) {
        const double share = first + (last - first) * step / steps;
        const Eigen::Vector3i voxel = (eye_I + share * way).array().round().cast<int>();
        const Eigen::Vector3i inside = voxel.cwiseMax(0).cwiseMin(volume.dims() - Eigen::Vector3i::Ones());
        if (volume.at(inside.x(), inside.y(), inside.z()) >= volume.iso()) return true;
    }
    return false;
}

Technique::Technique(const TechniqueScene& scene, Sight::IsHidden is_hidden)
    : scene_(scene),
      motion_([this](const MotionSample& sample) { addMotion(sample); }),
      force_(scene),
      removal_(scene),
      structures_(scene),
      heat_(scene),
      sight_(std::move(is_hidden)),
      moments_(scene) {}

void Technique::add(const TickRecord& record) {
    if (!last_s_) begin_s_ = record.t_s;
    const double since = last_s_ ? record.t_s - *last_s_ : 0;
    last_s_ = record.t_s;
    const bool is_lost = !(since >= 0 && since <= kLongestTick);
    if (is_lost && since > 0) time_.addLost(since);
    const TickStep step{record, is_lost ? 0 : since};
    motion_.add(step);
    time_.add(step);
    force_.add(step);
    removal_.add(step);
    structures_.add(step);
    heat_.add(step);
    moments_.add(step);
    bouts_.add(step, scene_.recorded.burr ? double(record.effects.burr_force) : step.force());
    const Sight::Found found = sight_.add(step);

    StepSums sums;
    sums.time = step.dt;
    if (step.isInContact()) {
        sums.contact_time = step.dt;
        sums.max_force = step.force();
        sums.impulse = sums.max_force * step.dt;
    }
    sums.removed = record.removed;
    sums.seen = found.seen, sums.unseen = found.unseen;
    sums.distance = step.distance();
    if (scene_.recorded.heat) sums.temperature = record.effects.temperature;
    seconds_.add(record.t_s - begin_s_, sums);
    volumes_.add(removal_.removed(), sums);
}

void Technique::addMotion(const MotionSample& sample) {
    StepSums sums;
    sums.way = time_.add(sample);
    seconds_.add(std::max(0.0, sample.t - begin_s_), sums);
    volumes_.add(removal_.removed(), sums);
    force_.add(sample);
    removal_.add(sample);
    steadiness_.add(sample);
    turns_.add(sample);
    minima_.add(sample);
}

void Technique::finish() {
    motion_.finish();
    turns_.finish();
    bouts_.finish();
    minima_.finish();
    moments_.finish();
}

Figures Technique::figures() const {
    Figures figures;
    time_.append(figures, removal_.cutting(), removal_.removed());
    force_.append(figures);
    removal_.append(figures);
    const StrokeList& strokes = turns_.strokes();
    put(figures, "strokes.turns", double(strokes.count()));
    put(figures, "strokes.turns.length", strokes.median(&StrokeMeasures::length) * kPerMillimetre);
    put(figures, "strokes.turns.time", strokes.median(&StrokeMeasures::duration));
    put(figures, "strokes.turns.speed", strokes.median(&StrokeMeasures::mean_speed) * kPerMillimetre);
    put(figures, "strokes.turns.force", strokes.median(&StrokeMeasures::mean_force));
    put(figures, "strokes.turns.volume", strokes.median(&StrokeMeasures::removed) * kPerCubicMillimetre);
    put(figures, "strokes.bouts", double(bouts_.count()));
    put(figures, "strokes.bouts.time", bouts_.durations().median());
    put(figures, "strokes.minima", double(minima_.count()));
    put(figures, "strokes.minima.length", minima_.lengths().median() * kPerMillimetre);
    put(figures, "smooth.sparc", strokes.median(&StrokeMeasures::sparc));
    put(figures, "smooth.ldlj", strokes.median(&StrokeMeasures::ldlj));
    put(figures, "smooth.f95", strokes.median(&StrokeMeasures::f95));
    steadiness_.append(figures);
    sight_.append(figures);
    heat_.append(figures);
    structures_.append(figures);
    return figures;
}

std::vector<StepSums> Technique::buckets() const {
    std::vector<StepSums> buckets(kBuckets);
    const double each = removal_.removed() / kBuckets;
    if (!(each > 0)) return {};
    double removed = 0;
    for (const StepSums& row : volumes_.rows()) {
        const double middle = removed + 0.5 * row.removed;
        removed += row.removed;
        buckets[std::min(size_t(middle / each), buckets.size() - 1)].add(row);
    }
    return buckets;
}

std::vector<SeriesTable> Technique::series() const {
    SeriesTable by_time{"second", {"t", "Time of the attempt", "s", {}}, columnsOf(seconds_.rows(), scene_)};
    for (size_t row = 0; row < seconds_.rows().size(); ++row)
        by_time.index.values.push_back(double(row + 1) * seconds_.step());
    const std::vector<StepSums> rows = buckets();
    SeriesTable by_volume{
        "bucket", {"share", "Share of what was removed", "percent", {}}, columnsOf(rows, scene_)};
    for (size_t row = 0; row < rows.size(); ++row)
        by_volume.index.values.push_back(100 * double(row + 1) / kBuckets);
    return {by_time, by_volume};
}

}  // namespace bonemill
