#include "haptic_server/server/session/task_monitor.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <utility>

#include "common/base/is_ready.h"
#include "common/base/units.h"
#include "common/rt/clock.h"
#include "haptic_server/assessment/product/judge.h"

namespace bonemill {
namespace {

constexpr int64_t kUpdatePeriodNs = 100 * kNsPerMillisecond;

void logResult(const Assessment& assessment) {
    if (!assessment.gates.empty())
        spdlog::info("the attempt has {}", assessment.hasPassed() ? "passed" : "failed");
    for (const GateResult& gate : assessment.gates)
        spdlog::info("{}: {}", gate.is_passed ? "held" : "broken", gate.text);
    if (assessment.total)
        spdlog::info("score {:.0f} of 100, by weights {} ({})", 100 * assessment.total->score,
                     assessment.total->weights_version, assessment.total->weights_hash);
}

void addGate(topics::TaskState& state, const GateResult& gate, topics::TaskState::Gate::State how) {
    topics::TaskState::Gate& shown = *state.add_gates();
    shown.set_state(how);
    shown.set_text(gate.text);
}

}  // namespace

TaskMonitor::TaskMonitor(std::shared_ptr<const JudgedTask> task, const BoneModel& bone, BoneHistory& history)
    : task_(std::move(task)),
      bone_(bone),
      history_(history),
      shows_zones_(task_ && task_->feedback == TaskFeedback::kLive) {
    if (!task_) return;
    scanned_counts_ = countProduct(history.scanned(), history.scanned(), *task_);
    tally_.emplace(history.scanned(), bone.volume, bone.lattice, *task_);
}

TaskMonitor::~TaskMonitor() {
    if (judging_.valid()) judging_.wait();
}

void TaskMonitor::round() {
    if (isReady(judging_)) finish();
    const int64_t now_ns = monotonicNowNs();
    if (!tally_ || task_->feedback != TaskFeedback::kLive || now_ns < next_update_ns_) return;
    tally_->update();
    next_update_ns_ = now_ns + kUpdatePeriodNs;
}

void TaskMonitor::beginAttempt() {
    last_.reset();
    if (task_ && task_->feedback == TaskFeedback::kAfterwards) shows_zones_ = false;
}

std::shared_future<TaskMonitor::Result> TaskMonitor::endAttempt(std::shared_ptr<const BoneSnapshot> bone,
                                                                std::optional<double> breach,
                                                                Figures technique) {
    if (!task_) return {};
    judging_ = std::async(
        std::launch::async, [this, breach, technique = std::move(technique), snapshot = std::move(bone),
                             before = std::exchange(judging_, {})]() mutable {
            if (before.valid()) before.wait();  // one after the other: each takes a core
            Result result;
            try {
                const VoxelVolume now = history_.volumeOf(*snapshot, bone_.lattice);
                Product product = measureProduct({history_.scanned(), now, *task_, breach});
                for (const std::string& what : product.left_out) spdlog::warn("not measured: {}", what);
                technique.insert(technique.end(), product.figures.begin(), product.figures.end());
                result.assessment = judge(*task_, std::move(technique));
                result.picture = std::move(product.picture);
                logResult(result.assessment);
            } catch (const std::exception& error) {
                result.problem = error.what();
                spdlog::error("the attempt could not be judged: {}", result.problem);
            }
            return result;
        });
    if (task_->feedback == TaskFeedback::kAfterwards) shows_zones_ = true;
    return judging_;
}

void TaskMonitor::finish() {
    if (!judging_.valid()) return;
    if (const Result& result = judging_.get(); result.problem.empty()) last_ = result.assessment;
    judging_ = {};
}

// Of what is counted all along.
Figures TaskMonitor::runningFigures() const {
    ProductCounts counts = scanned_counts_;
    for (size_t zone = 0; zone < counts.zones.size(); ++zone)
        counts.zones[zone].removed = tally_->removed()[zone];
    counts.ideal_removed = tally_->idealRemoved();
    Figures figures;
    addZoneFigures(counts, *task_, bone_.volume.voxelVolume(), figures);
    std::erase_if(figures,
                  [](const Figure& figure) { return figure.id.find("density") != std::string::npos; });
    return figures;
}

void TaskMonitor::describeZones(topics::TaskState& state) const {
    const double voxel_mm3 = bone_.volume.voxelVolume() * kPerCubicMillimetre;
    for (size_t n = 0; n < task_->zones.size(); ++n) {
        topics::TaskState::Zone& zone = *state.add_zones();
        zone.set_name(task_->zones[n].name);
        zone.set_role(uint32_t(task_->zones[n].role));
        zone.set_bone_mm3(double(scanned_counts_.zones[n + 1].bone) * voxel_mm3);
        zone.set_removed_mm3(double(tally_->removed()[n + 1]) * voxel_mm3);
    }
}

void TaskMonitor::describe(bool is_running, double time_s, topics::Status& status) const {
    if (!task_) return;
    topics::TaskState state;
    if (is_running && task_->time_limit_s > 0) state.set_time_left_s(task_->time_limit_s - time_s);
    const bool shows_result = !is_running && last_ && task_->feedback != TaskFeedback::kNever;
    if (task_->feedback == TaskFeedback::kLive) describeZones(state);
    if (shows_result) {
        state.set_is_result(true);
        for (const GateResult& gate : last_->gates)
            addGate(state, gate,
                    gate.is_passed ? topics::TaskState::Gate::HELD : topics::TaskState::Gate::BROKEN);
        if (last_->total) state.set_score(last_->total->score);
    } else if (task_->feedback == TaskFeedback::kLive) {
        // What has still to be reached, or is not counted all along, is open.
        const Figures figures = runningFigures();
        for (const GateResult& gate : judge(*task_, figures).gates) {
            const bool is_known = findFigure(figures, gate.figure_id) != nullptr;
            addGate(state, gate,
                    !is_known        ? topics::TaskState::Gate::OPEN
                    : gate.is_passed ? topics::TaskState::Gate::HELD
                    : gate.is_most   ? topics::TaskState::Gate::BROKEN
                                     : topics::TaskState::Gate::OPEN);
        }
    }
    if (state.ByteSizeLong() > 0) *status.mutable_task() = std::move(state);
}

}  // namespace bonemill
