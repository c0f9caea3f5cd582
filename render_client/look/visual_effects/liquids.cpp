#include "render_client/look/visual_effects/liquids.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/units.h"
#include "common/geometry/coolant_nozzle.h"
#include "render_client/look/visual_effects/bone_surface.h"

namespace bonemill {
namespace {

constexpr float kBrim = 0.55f;                              // of a full film: from here on blood runs
constexpr float kShortestRun = 1e-3f, kLongestRun = 7e-3f;  // m
constexpr double kMaxCells = 300e3;                         // of the film, that a step looks at
constexpr float kTightness = 0.7f;  // of a cell: nearer to a wound there is no second one
const Eigen::Vector3f kDarkRed(0.105f, 0.0040f, 0.0045f);

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

void Bleeding::open(std::span<const SurfacePoint> cut, const SurfaceFilm& film) {
    const float tight = kTightness * film.cell();
    for (const SurfacePoint& point : cut) {
        if (wounds_.size() >= kMaxWounds) return;
        if (!bleeds_[point.material]) continue;
        const auto is_near = [&](const Wound& w) {
            return (w.at.p_V - point.p_V).squaredNorm() < tight * tight;
        };
        if (film.holds(point.p_V) && std::ranges::none_of(wounds_, is_near)) wounds_.push_back({point, 0, 0});
    }
}

void Bleeding::cutAway(const Eigen::Vector3f& p_V, float radius) {
    const auto is_gone = [&](const auto& w) { return (w.at.p_V - p_V).squaredNorm() < radius * radius; };
    std::erase_if(wounds_, is_gone);
    std::erase_if(runs_, is_gone);
}

void Bleeding::advance(double dt, const Eigen::Vector3f& up_V, const BoneSurface& surface,
                       SurfaceFilm& film) {
    seep(dt, film);
    beginRuns(dt, film);
    run(dt, up_V, surface, film);
}

// Wounds lie close together, so each gives its share only. When they cost more than a picture has time for,
// they take turns.
void Bleeding::seep(double dt, SurfaceFilm& film) {
    const auto delay = float(wish_.delay_s()), end = float(wish_.delay_s() + wish_.clotting_time_s());
    for (Wound& wound : wounds_) {
        wound.age += float(dt);
        if (wound.age >= delay) wound.waited += float(dt);
    }
    double cells = kMaxCells;
    for (size_t n = 0; n < wounds_.size() && cells > 0; ++n) {
        next_ = next_ + 1 < wounds_.size() ? next_ + 1 : 0;
        if (wounds_[next_].waited > 0) cells -= feed(wounds_[next_], film);
    }
    std::erase_if(wounds_, [&](const Wound& w) { return w.age > end || !film.holds(w.at.p_V); });
}

// Returns how many cells it has looked at.
double Bleeding::feed(Wound& wound, SurfaceFilm& film) {
    const auto waited = std::exchange(wound.waited, 0.0f);
    if (!film.holds(wound.at.p_V)) return 0;
    const auto seep = float(wish_.seep_per_s());
    const float grown = std::min(1.0f, (wound.age - float(wish_.delay_s())) * seep);
    const float radius = film.cell() + grown * float(wish_.spread_mm() * kMillimetre);
    const float share = film.cell() / radius;
    film.add(SurfaceFilm::kBlood, wound.at.p_V, waited * seep * share * share, radius);
    return std::pow(2 * double(radius / film.cell()) + 1, 3);
}

void Bleeding::beginRuns(double dt, const SurfaceFilm& film) {
    if (wounds_.empty()) return;
    runs_due_ = std::min(runs_due_ + dt * wish_.runs_per_s(), double(kMaxRuns));
    for (; runs_due_ >= 1; --runs_due_) {
        const Wound& wound = wounds_[random_.below(wounds_.size())];
        const float left = random_.between(kShortestRun, kLongestRun), width = random_.between(0.6f, 1.1f);
        if (runs_.size() < kMaxRuns && film.at(SurfaceFilm::kBlood, wound.at.p_V) > kBrim)
            runs_.push_back({wound.at, left, width * 1.25f * film.cell()});
    }
}

void Bleeding::run(double dt, const Eigen::Vector3f& up_V, const BoneSurface& surface, SurfaceFilm& film) {
    const float distance = float(dt * wish_.run_speed_mm_per_s() * kMillimetre);
    std::erase_if(runs_, [&](Run& run) {
        run.left -= distance;
        const Walk walk = walkDown(surface, up_V, distance, run.at);
        film.add(SurfaceFilm::kBlood, run.at.p_V, float(6 * dt), run.width);
        return run.left <= 0 || walk != Walk::kGoesOn || !film.holds(run.at.p_V);
    });
}

void Bleeding::clear() {
    wounds_.clear();
    runs_.clear();
}

Eigen::Vector3f Bleeding::colour() const {
    if (!wish_.has_color()) return kDarkRed;
    return Eigen::Vector3d(wish_.color().red(), wish_.color().green(), wish_.color().blue()).cast<float>();
}

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
    return usualNozzle(input_.burr_radius);
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
