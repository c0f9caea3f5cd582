#include "render_client/look/visual_effects/burr_effects.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"

namespace bonemill {
namespace {

constexpr double kLongestExposure = 1.0 / 24;  // s: pictures that come slower are stills

constexpr float kFastest = 2, kSlowest = 0.06f;  // m/s at the start
constexpr float kStep = 4e-4f;                   // m that a grain flies between two looks for bone
constexpr int kMaxSteps = 8;
constexpr float kFound = 5e-4f;                  // m: farther from all vertices there is no bone
constexpr float kBounce = 0.25f, kSlide = 0.5f;  // what is left of the speed, into and along the bone
constexpr float kRest = 0.08f;                   // m/s: slower after a bounce a grain stays
constexpr float kExposure = 0.002f;              // s of flight that a grain's streak shows
constexpr float kFading = 0.8f;                  // of its life, when it begins to fade
constexpr float kAroundContact = 0.9f;           // how far off the contact's direction grains leave

}  // namespace

void BurrSpin::advance(double dt, double spin_speed) {
    angle_ = std::remainder(angle_ + spin_speed * dt, kTurn);
    swept_ += spin_speed * dt;
    time_ += dt;
}

BurrTurn BurrSpin::takeTurn() {
    if (time_ > 0) {
        turn_.angle = float(angle_);
        turn_.sweep = float(swept_ * std::min(1.0, kLongestExposure / time_));
        swept_ = time_ = 0;
    }
    return turn_;
}

BoneDust::BoneDust(const scene::BoneDust& wish) : wish_(wish) {
    grains_.reserve(wish.most_grains());
}

void BoneDust::take(const EffectInput& input) {
    input_ = input;
    if (!input.X_VT) return;
    due_ = std::min(due_ + input.removed * kPerCubicMillimetre * wish_.grains_per_mm3(),
                    double(wish_.most_grains()));
    if (!input.is_pedal_down) return;
    // No grain lies where the burr sweeps.
    const Eigen::Vector3f centre = input.X_VT->position.cast<float>();
    for (Grain& grain : grains_)
        if (grain.is_resting && (grain.p - centre).norm() < float(input.burr_radius))
            grain.age = float(wish_.lifetime_s());
}

void BoneDust::advance(double dt, const BoneSurface& surface) {
    const auto leaving = input_.X_VT ? size_t(due_) : 0;
    due_ -= double(leaving);
    for (Grain& grain : grains_) {
        grain.age += float(dt);
        if (!grain.is_resting && grain.age < float(wish_.lifetime_s())) fly(grain, float(dt), surface);
    }
    for (size_t n = 0; n < leaving; ++n) launch(random_.unit() * float(dt));
}

void BoneDust::launch(float age) {
    const Eigen::Vector3f axis = (input_.X_VT->rotation * Eigen::Vector3d::UnitY()).cast<float>();
    Eigen::Vector3f out = kAroundContact * random_.inCube() + input_.towards_bone_V.cast<float>();
    out -= 0.8f * axis.dot(out) * axis;  // most leave near the burr's equator
    out = out.norm() > 1e-3f ? out.normalized() : axis.unitOrthogonal();
    const auto radius = float(input_.burr_radius);
    Eigen::Vector3f v = float(input_.spin_speed * wish_.rim_speed_share()) * radius * axis.cross(out);
    v *= random_.between(0.6f, 1.1f);
    if (v.norm() > kFastest) v *= kFastest / v.norm();
    v += (kSlowest + 0.35f * v.norm()) * random_.inCube() + kSlowest * input_.up_V.cast<float>();
    const float size = float(wish_.grain_size_um()) * 0.5e-6f * random_.between(0.5f, 1.5f);
    const Eigen::Vector3f p = input_.X_VT->position.cast<float>() + 1.02f * radius * out + age * v;
    const Grain grain{p, v, size, age, random_.unit(), false};
    if (grains_.size() < wish_.most_grains()) return grains_.push_back(grain);
    grains_[next_ % grains_.size()] = grain;
    next_ = (next_ + 1) % grains_.size();
}

void BoneDust::fly(Grain& grain, float dt, const BoneSurface& surface) {
    const float speed = grain.v.norm();
    const int steps = std::clamp(int(std::ceil(speed * dt / kStep)), 1, kMaxSteps);
    const float h = dt / float(steps), drag_time = float(wish_.drag_time_ms() * kMillisecond);
    const Eigen::Vector3f gravity = -kGravity * input_.up_V.cast<float>();
    for (int n = 0; n < steps && !grain.is_resting; ++n) {
        grain.v = (grain.v + h * gravity) / (1 + h / drag_time);
        grain.p += h * grain.v;
        meetBone(grain, surface);
    }
    if (!surface.isInFocus(grain.p)) grain.age = float(wish_.lifetime_s());
}

void BoneDust::meetBone(Grain& grain, const BoneSurface& surface) {
    const auto found = surface.nearest(grain.p, kFound);
    if (!found || found->heightOf(grain.p) > grain.radius) return;
    grain.p += (grain.radius - found->heightOf(grain.p)) * found->n_V;
    const float into = found->n_V.dot(grain.v);
    if (into >= 0) return;
    grain.v = kSlide * (grain.v - into * found->n_V) - kBounce * into * found->n_V;
    grain.is_resting = grain.v.norm() < kRest && found->n_V.dot(input_.up_V.cast<float>()) > -0.3f;
}

void BoneDust::wash(const Eigen::Vector3f& p_V, float radius, float chance) {
    for (Grain& grain : grains_)
        if (grain.is_resting && (grain.p - p_V).norm() < radius && random_.unit() < chance)
            grain.age = float(wish_.lifetime_s());
}

void BoneDust::appendTo(Particles& particles) const {
    const auto life = float(wish_.lifetime_s());
    for (const Grain& grain : grains_) {
        if (grain.age >= life) continue;
        const float fade = std::min(1.0f, (life - grain.age) / ((1 - kFading) * life));
        const Eigen::Vector3f colour = (0.75f + 0.3f * grain.shade) * Eigen::Vector3f(0.88f, 0.80f, 0.66f);
        const float trace = grain.is_resting ? 0 : kExposure;
        const float thinned = 2 * grain.radius / (2 * grain.radius + trace * grain.v.norm());
        particles.push_back({grain.p, trace * grain.v, grain.radius,
                             Eigen::Vector4f(colour.x(), colour.y(), colour.z(), fade * thinned), 0});
    }
}

size_t BoneDust::restingCount() const {
    return size_t(std::ranges::count_if(
        grains_, [&](const Grain& g) { return g.is_resting && g.age < float(wish_.lifetime_s()); }));
}

}  // namespace bonemill
