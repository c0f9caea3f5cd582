#include "haptic_server/lab/accuracy_report/measures.h"

#include <algorithm>
#include <cmath>

#include "haptic_server/lab/simulate/run_path.h"

namespace bonemill {
namespace {

double square(double x) {
    return x * x;
}

double angleBetween(const Eigen::Vector3d& a, const Eigen::Vector3d& b) {
    return std::atan2(a.cross(b).norm(), a.dot(b));
}

}  // namespace

TimedRun::TimedRun(RunRecords first) : records(std::move(first)) {
    for (const TickRecord& record : records) longest_ns.push_back(record.compute_ns);
}

void TimedRun::add(const RunRecords& again) {
    for (size_t n = 0; n < std::min(records.size(), again.size()); ++n) {
        records[n].compute_ns = std::min(records[n].compute_ns, again[n].compute_ns);
        longest_ns[n] = std::max<int64_t>(longest_ns[n], again[n].compute_ns);
    }
}

TimedRun runPathTimed(const FixedTickConfig& config, BoneModel& bone, std::span<const Pose> path_WT) {
    const std::vector<DeviceInput> path = inputsOf(path_WT, config.dt);
    TimedRun run(runPath(config, bone, path));
    for (int pass = 1; pass < kPasses; ++pass) run.add(runPath(config, bone, path));
    return run;
}

std::vector<TickAnswer> answersOf(const RunRecords& records) {
    std::vector<TickAnswer> answers;
    answers.reserve(records.size());
    for (const TickRecord& r : records)
        answers.push_back(
            {{Eigen::Vector3d(r.p_WT), Eigen::Quaterniond(r.q_WT[0], r.q_WT[1], r.q_WT[2], r.q_WT[3])},
             {Eigen::Vector3d(r.f_hand_W), Eigen::Vector3d(r.t_hand_W)}});
    return answers;
}

void ErrorSum::add(const std::vector<TickAnswer>& answers, const std::vector<TickAnswer>& truth) {
    for (size_t n = 0; n < std::min(answers.size(), truth.size()); ++n) {
        const TickAnswer &a = answers[n], &t = truth[n];
        const double force = t.hand_W.force.norm();
        if (force < Errors::kFeltForce) continue;
        ++ticks_;
        const double difference = (a.hand_W.force - t.hand_W.force).squaredNorm();
        force_vector_ += difference;
        worst_ = std::max(worst_, difference);
        force_ += square(a.hand_W.force.norm() - force);
        true_force_ += square(force);
        torque_ += square(a.hand_W.torque.norm() - t.hand_W.torque.norm());
        true_torque_ += t.hand_W.torque.squaredNorm();
        direction_ += square(angleBetween(a.hand_W.force, t.hand_W.force));
        position_ += (a.X_WT.position - t.X_WT.position).squaredNorm();
        rotation_ += logRotation(a.X_WT.rotation * t.X_WT.rotation.conjugate()).squaredNorm();
    }
}

Errors ErrorSum::errors() const {
    if (ticks_ == 0) return {};
    const double n = double(ticks_);
    return {.force_vector = std::sqrt(force_vector_ / true_force_),
            .worst = std::sqrt(worst_ * n / true_force_),
            .force = std::sqrt(force_ / true_force_),
            .torque = true_torque_ > 0 ? std::sqrt(torque_ / true_torque_) : 0,
            .direction = std::sqrt(direction_ / n),
            .position = std::sqrt(position_ / n),
            .rotation = std::sqrt(rotation_ / n),
            .ticks = ticks_};
}

void NoiseSum::add(const std::vector<TickAnswer>& answers) {
    for (size_t n = 1; n + 1 < answers.size(); ++n) {
        const auto force = [&](size_t tick) { return answers[tick].hand_W.force; };
        sum_ += (force(n + 1) - 2 * force(n) + force(n - 1)).squaredNorm();
        ++count_;
    }
}

double NoiseSum::noise() const {
    return count_ ? std::sqrt(sum_ / double(count_)) : 0;
}

PathEnergy energyOf(const std::vector<TickAnswer>& answers, std::span<const Pose> device) {
    PathEnergy energy;
    for (size_t n = 1; n < std::min(answers.size(), device.size()); ++n) {
        const Eigen::Vector3d moved = device[n].position - device[n - 1].position;
        const Eigen::Vector3d turned = logRotation(device[n].rotation * device[n - 1].rotation.conjugate());
        energy.at_end -= 0.5 * (answers[n].hand_W.force + answers[n - 1].hand_W.force).dot(moved);
        energy.at_end -= 0.5 * (answers[n].hand_W.torque + answers[n - 1].hand_W.torque).dot(turned);
        energy.lowest = std::min(energy.lowest, energy.at_end);
    }
    return energy;
}

}  // namespace bonemill
