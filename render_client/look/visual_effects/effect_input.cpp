#include "render_client/look/visual_effects/effect_input.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "common/device_messages/device_messages.h"

namespace bonemill {
namespace {

constexpr double kFastestSpin = 25000;              // rad/s: a turbine of 240,000 rpm
constexpr double kMaxForce = 1000;                  // N
constexpr double kMaxPower = 1e4;                   // W
constexpr double kMaxHeat = 1000;                   // °C
constexpr double kMaxRemoved = 1e-7;                // m³
constexpr double kMinBurr = 1e-4, kMaxBurr = 5e-2;  // m
constexpr double kTouch = 0.05;                     // N

double bounded(double value, double low, double high) {
    return std::isfinite(value) ? std::clamp(value, low, high) : std::clamp(0.0, low, high);
}

Eigen::Vector3d upOf(const topics::SceneInfo& info) {
    const auto up = readVector(info.camera().up());
    return up && up->norm() > 1e-9 ? up->normalized() : Eigen::Vector3d::UnitZ();
}

}  // namespace

EffectInput effectInputOf(const topics::ToolState& tool, const topics::SceneInfo& info) {
    EffectInput input;
    const Pose X_VW = readPose(info.p_wv_m(), info.q_wv()).value_or(Pose()).inverse();
    if (const auto X_WT = readPose(tool.p_wt_m(), tool.q_wt())) input.X_VT = X_VW * *X_WT;
    input.burr_radius = bounded(info.burr_radius_m(), kMinBurr, kMaxBurr);
    input.is_pedal_down = (tool.buttons() & kButtonRemove) != 0 && !tool.waits_for_release();
    input.up_V = X_VW.rotation * upOf(info);
    const auto force_W = readVector(tool.force_n());
    if (force_W && force_W->norm() > kTouch) input.towards_bone_V = X_VW.rotation * -force_W->normalized();
    const topics::EffectState& effects = tool.effects();
    input.spin_speed = bounded(effects.spin_speed(), -kFastestSpin, kFastestSpin);
    input.burr_force = bounded(effects.burr_force_n(), 0, kMaxForce);
    input.cutting_power = bounded(effects.cutting_power_w(), 0, kMaxPower);
    if (effects.has_temperature_c()) input.hottest_c = bounded(effects.temperature_c(), 0, kMaxHeat);
    input.protected_force = bounded(effects.protected_force_n(), 0, kMaxForce);
    input.is_protected_touched = (effects.events() & topics::EffectState::PROTECTED_TOUCHED) != 0;
    input.is_protected_damaged = (effects.events() & topics::EffectState::PROTECTED_DAMAGED) != 0;
    input.removed = bounded(effects.removed_mm3() * kCubicMillimetre, 0, kMaxRemoved);
    return input;
}

}  // namespace bonemill
