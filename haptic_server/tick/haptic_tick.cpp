#include "haptic_server/tick/haptic_tick.h"

#include <algorithm>
#include <cmath>

#include "common/rt/rt_guard.h"

namespace bonemill {
namespace {

template <size_t N, class Vector>
void copyTo(double (&out)[N], const Vector& v) noexcept {
    for (size_t i = 0; i < N; ++i) out[i] = v[Eigen::Index(i)];
}

Eigen::Vector4d wxyz(const Eigen::Quaterniond& q) noexcept {
    return {q.w(), q.x(), q.y(), q.z()};
}

constexpr double kQuaternionNormSlack = 1e-2;
constexpr double kFarthest = 1e3;  // m from W's origin: beyond any scan, and squares stay finite

}  // namespace

HapticTick::HapticTick(const TickConfig& config, BoneModel& bone, const SdfGrid& tool_sdf, VolumeReset* reset)
    : config_(config),
      bone_(bone),
      tool_sdf_(tool_sdf),
      reset_(reset),
      milling_(config.milling, bone.volume, config.burr_radius),
      X_VW_(bone.volume.geometry().X_WV.inverse()) {}

bool HapticTick::tick(TickIo& io) noexcept {
    DeviceInput input;
    if (!io.read(input)) return false;
    const RtScope scope;
    uint32_t faults = input.is_stale ? kFaultStaleDevice : kFaultNone;
    device_ = acceptPose(input, faults);
    const ContactResult contact = contactInWorld();
    const Wrench wrench_hand = moveAndFeel(contact, input.force_factor, faults);
    const int64_t force_at_ns = io.write(wrench_hand);

    const MillingResult milled = mill(input, faults);
    TickRecord record = makeRecord(input, contact, wrench_hand);
    record.removed_voxels = milled.removed_voxels;
    record.added_voxels = milled.added_voxels;
    record.removed = milled.removed_voxels * bone_.volume.voxelVolume();
    record.added = milled.added_voxels * bone_.volume.voxelVolume();
    record.force_ns = force_at_ns - input.start_ns;
    const int64_t end_ns = io.now();
    record.compute_ns = end_ns - input.start_ns;
    if (end_ns > input.deadline_ns) faults |= kFaultOverrun;
    record.faults = faults;
    latched_faults_ |= faults;
    io.push(record);
    ++tick_;
    return true;
}

Pose HapticTick::acceptPose(const DeviceInput& input, uint32_t& faults) noexcept {
    Pose pose = input.X_WT_device;
    const double norm = pose.rotation.norm();
    if (!pose.isFinite() || !(std::abs(norm - 1) < kQuaternionNormSlack) ||
        !(pose.position.cwiseAbs().maxCoeff() < kFarthest)) {
        faults |= kFaultBadDevicePose;
        return device_;
    }
    pose.rotation.coeffs() /= norm;
    if (!has_pose_) spo_ = pose;  // the simulated tool starts where the hand is
    has_pose_ = true;
    return pose;
}

ContactResult HapticTick::contactInWorld() const noexcept {
    ContactResult contact =
        penaltyContact(config_.contact, bone_.volume, bone_.lattice, bone_.shell, tool_sdf_, X_VW_ * spo_);
    const Eigen::Quaterniond R_WV = X_VW_.rotation.conjugate();
    contact.wrench = contact.wrench.rotatedBy(R_WV);
    const Eigen::Matrix3d R = R_WV.toRotationMatrix();
    Matrix6d R6 = Matrix6d::Zero();
    R6.topLeftCorner<3, 3>() = R;
    R6.bottomRightCorner<3, 3>() = R;
    contact.derivative = R6 * contact.derivative * R6.transpose();
    return contact;
}

Wrench HapticTick::moveAndFeel(const ContactResult& contact, double force_factor, uint32_t& faults) noexcept {
    const CouplingConfig& coupling = config_.coupling;
    const Wrench net = contact.wrench + couplingWrench(coupling, spo_, device_);
    const Matrix6d derivative = contact.derivative + couplingDerivative(coupling, spo_, device_);
    const EquilibriumStep solved = solveEquilibrium(coupling, net, derivative, config_.dt);
    if (!solved.is_regular) faults |= kFaultSolve;
    if (solved.is_clamped) faults |= kFaultMotionClamped;
    const Vector6d moved = (1 - coupling.static_damping) * solved.step;
    spo_ = spo_.incremented(moved.head<3>(), moved.tail<3>());

    Wrench wrench_hand = -couplingWrench(coupling, spo_, device_);
    if (limitWrench(coupling, wrench_hand)) faults |= kFaultForceClamped;
    wrench_hand.force *= force_factor;
    wrench_hand.torque *= force_factor;
    return wrench_hand;
}

MillingResult HapticTick::mill(const DeviceInput& input, uint32_t& faults) noexcept {
    if (reset_) reset_->startIfRequested();
    if (reset_ && reset_->isRunning()) {
        if (!reset_->restoreSome(bone_)) faults |= kFaultShellOverflow;
        return {};
    }
    const bool remove = input.buttons & kButtonRemove;
    const bool add = input.buttons & kButtonAdd;
    if (input.is_stale || remove == add || (reset_ && reset_->isMillingPaused())) return {};
    const MillingResult milled = milling_.apply(bone_.volume, bone_.lattice, bone_.shell,
                                                X_VW_ * spo_.position, remove ? -1 : 1, config_.dt);
    if (!milled.shell_is_complete) faults |= kFaultShellOverflow;
    return milled;
}

TickRecord HapticTick::makeRecord(const DeviceInput& input, const ContactResult& contact,
                                  const Wrench& wrench_hand) const noexcept {
    TickRecord record{};
    record.tick = tick_;
    record.start_ns = input.start_ns;
    record.wakeup_latency_ns = input.wakeup_latency_ns;
    record.t_s = input.t_s;
    copyTo(record.p_WT, spo_.position);
    copyTo(record.q_WT, wxyz(spo_.rotation));
    copyTo(record.p_WT_device, device_.position);
    copyTo(record.q_WT_device, wxyz(device_.rotation));
    copyTo(record.f_hand_W, wrench_hand.force);
    copyTo(record.t_hand_W, wrench_hand.torque);
    record.contacts = contact.contacts;
    record.max_penetration = contact.max_penetration;
    record.buttons = input.buttons;
    return record;
}

}  // namespace bonemill
