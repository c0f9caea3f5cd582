#include "render_client/look/visual_effects/irrigation.h"

#include <algorithm>
#include <cmath>

#include "common/base/units.h"
#include "render_client/look/visual_effects/surface_walker.h"

namespace bonemill {
namespace {

constexpr double kPiecesPerSecond = 240;  // of the stream
constexpr float kDropFound = 6e-4f;       // m
constexpr float kLife = 1.5f;             // s of a drop
constexpr float kRunSpeed = 0.012f;       // m/s down a vertical wall
constexpr float kRunsOn = 0.22f;          // part of the pieces that run on as drops
constexpr float kSpray = 0.35f;           // part that the burr throws off where they are seen
constexpr float kDropExposure = 0.006f;   // s of flight that a drop's streak shows
constexpr float kWetting = 0.5f;          // of a full film, per piece
constexpr float kSplash = 0.08f;          // of a full film on the bone around the burr, per piece
constexpr float kSplashReach = 2.2f;      // in burr radii
constexpr int kMaxDropSteps = 6;
constexpr float kDropStep = 5e-4f;  // m

}  // namespace

// By continuity this is a round stream of this flow and speed.
float Irrigation::streamRadius() const {
    const double speed = wish_.stream_speed_mm_per_s() * kMillimetre;
    return float(
        std::clamp(std::sqrt(wish_.flow_ml_per_min() * kMillilitre / kMinute / (M_PI * speed)), 5e-5, 5e-3));
}

Eigen::Vector3d Irrigation::nozzle_T() const {
    if (wish_.has_nozzle_mm())
        return kMillimetre *
               Eigen::Vector3d(wish_.nozzle_mm().x(), wish_.nozzle_mm().y(), wish_.nozzle_mm().z());
    return input_.burr_radius * Eigen::Vector3d(2.2, 7, 0);
}

void Irrigation::pour(double dt) {
    if (!input_.X_VT || !input_.is_pedal_down) return;
    const Eigen::Vector3d from_T = nozzle_T();
    const Eigen::Vector3d aim_T = from_T * (0.6 * input_.burr_radius / std::max(from_T.norm(), 1e-6));
    const auto speed = float(wish_.stream_speed_mm_per_s() * kMillimetre);
    const Eigen::Vector3f from = (*input_.X_VT * from_T).cast<float>();
    const Eigen::Vector3f way = (*input_.X_VT * aim_T).cast<float>() - from;
    if (way.norm() < 1e-6f) return;
    due_ += dt * kPiecesPerSecond;
    for (; due_ >= 1; --due_) {
        const float age = float(due_ - 1) / float(kPiecesPerSecond);
        const Eigen::Vector3f v = speed * (way.normalized() + 0.02f * random_.inCube());
        if (drops_.size() >= kMaxDrops) continue;
        Drop& drop = drops_.emplace_back();
        drop.at.p_V = from + age * v;
        drop.v = v;
        drop.radius = streamRadius() * random_.between(0.9f, 1.1f);
        drop.life = kLife;
    }
}

void Irrigation::advance(double dt, const BoneSurface& surface, SurfaceFilm& film) {
    landed_.clear();
    std::erase_if(drops_, [&](Drop& drop) { return !move(drop, float(dt), surface, film); });
    pour(dt);
}

bool Irrigation::move(Drop& drop, float dt, const BoneSurface& surface, SurfaceFilm& film) {
    drop.age += dt;
    if (drop.age > drop.life || !surface.isInFocus(drop.at.p_V)) return false;
    if (drop.state == State::kRunning) return run(drop, dt, surface, film);
    const int steps = std::clamp(int(std::ceil(drop.v.norm() * dt / kDropStep)), 1, kMaxDropSteps);
    const float h = dt / float(steps);
    for (int n = 0; n < steps && drop.state != State::kRunning; ++n) {
        drop.v -= h * kGravity * input_.up_V.cast<float>();
        drop.at.p_V += h * drop.v;
        if (drop.state == State::kStream && !meetBurr(drop, film)) return false;
        if (!meetBone(drop, surface, film)) return false;
    }
    return true;
}

bool Irrigation::meetBurr(Drop& drop, SurfaceFilm& film) {
    if (!input_.X_VT) return true;
    const Eigen::Vector3f centre = input_.X_VT->position.cast<float>();
    const Eigen::Vector3f out = drop.at.p_V - centre;
    if (out.norm() > float(input_.burr_radius) + drop.radius) return true;
    landed_.push_back(drop.at.p_V);
    film.add(SurfaceFilm::kWater, centre, kSplash, kSplashReach * float(input_.burr_radius));
    if (random_.unit() > kSpray || out.norm() < 1e-6f) return false;
    const Eigen::Vector3f axis = (input_.X_VT->rotation * Eigen::Vector3d::UnitY()).cast<float>();
    const Eigen::Vector3f rim = float(std::clamp(input_.spin_speed, -300.0, 300.0) * input_.burr_radius) *
                                axis.cross(out.normalized());
    drop.at.p_V = centre + out.normalized() * (float(input_.burr_radius) + drop.radius);
    drop.v = rim + 0.12f * (out.normalized() + random_.inCube());
    drop.radius *= random_.between(0.25f, 0.5f);
    drop.state = State::kSpray;
    return true;
}

bool Irrigation::meetBone(Drop& drop, const BoneSurface& surface, SurfaceFilm& film) {
    const auto found = surface.nearest(drop.at.p_V, kDropFound);
    if (!found || found->heightOf(drop.at.p_V) > drop.radius) return true;
    film.add(SurfaceFilm::kWater, found->p_V, kWetting, 4 * drop.radius);
    landed_.push_back(found->p_V);
    if (random_.unit() > kRunsOn) return false;
    drop.at = {drop.at.p_V - found->heightOf(drop.at.p_V) * found->n_V, found->n_V};
    drop.radius *= drop.state == State::kStream ? random_.between(0.5f, 0.9f) : 1;
    drop.state = State::kRunning;
    drop.age = 0;
    drop.life = kLife * random_.between(0.4f, 1.6f);
    return true;
}

bool Irrigation::run(Drop& drop, float dt, const BoneSurface& surface, SurfaceFilm& film) {
    const Walk walk = walkDown(surface, input_.up_V.cast<float>(), kRunSpeed * dt, drop.at);
    film.add(SurfaceFilm::kWater, drop.at.p_V, 6 * dt, 2.5f * drop.radius);
    if (walk == Walk::kGoesOn) return true;
    if (walk == Walk::kRests) return true;  // dries there
    drop.state = State::kSpray;
    drop.at.p_V += 1.5f * drop.radius * drop.at.n_V;
    drop.v.setZero();
    return true;
}

void Irrigation::dry(double dt, SurfaceFilm& film) const {
    film.scaleAll(SurfaceFilm::kWater, float(std::exp(-dt / wish_.drying_time_s())));
}

float Irrigation::washFactor(double dt) const {
    return float(std::exp(-dt / wish_.washing_time_s()));
}

void Irrigation::appendTo(Particles& particles) const {
    for (const Drop& drop : drops_) {
        const bool is_stream = drop.state == State::kStream;
        const float trace = is_stream                     ? float(2.5 / kPiecesPerSecond)
                            : drop.state == State::kSpray ? kDropExposure
                                                          : 0;
        const float fade = std::min(1.0f, 4 * (1 - drop.age / drop.life));
        particles.push_back({drop.at.p_V, trace * drop.v, drop.radius * (is_stream ? 1 : 0.8f),
                             Eigen::Vector4f(0.72f, 0.84f, 0.92f, fade * (is_stream ? 0.30f : 0.5f)), 1});
    }
}

}  // namespace bonemill
