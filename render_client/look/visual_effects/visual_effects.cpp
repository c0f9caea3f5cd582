#include "render_client/look/visual_effects/visual_effects.h"

#include <algorithm>

namespace bonemill {
namespace {

// A quick picture draws all that is wet anew when it changes: not sooner than that, nor than some times as
// long as the slowest picture since then took, so that others come between.
constexpr double kShownStep = 0.15;  // s
constexpr double kShownRest = 3;
constexpr double kFilmStep = 1.0 / 15;              // s: blood and drying are slow
constexpr double kCellsPerRadius = 4;               // of the burr
constexpr double kMinCell = 1e-4, kMaxCell = 6e-4;  // m
constexpr double kTrailTime = 0.6;                  // s that a mesh may come after its cut
constexpr size_t kMaxTrail = 64;
constexpr float kCutMargin = 3e-4f;  // m beside the burr where a new vertex is a cut

SurfaceFilm filmFor(double burr_radius) {
    return SurfaceFilm(float(std::clamp(burr_radius / kCellsPerRadius, kMinCell, kMaxCell)));
}

MaterialSet bleedingOf(const scene::Bleeding& wish, const VisualEffects::Materials& materials) {
    MaterialSet bleeds;
    if (wish.material().empty()) return bleeds.set();
    for (size_t n = 0; n < size_t(materials.size()) && n + 1 < bleeds.size(); ++n)
        bleeds[n + 1] = std::ranges::count(wish.material(), materials[int(n)].name()) > 0;
    return bleeds;
}

}  // namespace

bool VisualEffects::anyIn(const scene::Effects& wish) {
    return wish.has_bone_dust() || wish.has_burr_spin() || wish.has_pulse() || needsFilm(wish);
}

bool VisualEffects::needsFilm(const scene::Effects& wish) {
    return wish.has_bleeding() || wish.has_irrigation() || wish.has_browning() || wish.has_bruising();
}

VisualEffects::VisualEffects(const scene::Effects& wish, double burr_radius, const Materials& materials) {
    if (wish.has_bone_dust()) dust_.emplace(wish.bone_dust());
    if (wish.has_bleeding()) bleeding_.emplace(wish.bleeding(), bleedingOf(wish.bleeding(), materials));
    if (wish.has_irrigation()) irrigation_.emplace(wish.irrigation());
    if (wish.has_burr_spin()) spin_.emplace(wish.burr_spin());
    if (wish.has_browning()) browning_.emplace(wish.browning());
    if (wish.has_bruising()) bruising_.emplace(wish.bruising());
    if (wish.has_pulse()) pulse_.emplace(wish.pulse(), materials);
    if (needsFilm(wish)) film_.emplace(filmFor(burr_radius));
    if (bleeding_) surface_.trackFresh();
}

void VisualEffects::take(const EffectInput& input) {
    input_ = input;
    if (dust_) dust_->take(input);
    if (irrigation_) irrigation_->take(input);
    if (!input.X_VT) return;
    if (film_) takeToFilm();
    if (!needsSurface()) return;
    const Eigen::Vector3f centre = input.X_VT->position.cast<float>();
    surface_.focusOn(centre);
    if (!input.is_pedal_down) return;
    if (trail_.size() >= kMaxTrail) trail_.erase(trail_.begin());
    trail_.push_back({centre, time_});
    if (bleeding_) bleeding_->cutAway(centre, float(input.burr_radius) - film_->cell());
}

void VisualEffects::takeToFilm() {
    const bool leaves_trace =
        input_.is_pedal_down || input_.is_protected_touched || input_.is_protected_damaged;
    if (leaves_trace) film_->centreOn(input_.X_VT->position.cast<float>());
    if (browning_) browning_->take(input_, *film_);
    if (bruising_) bruising_->take(input_, *film_);
}

void VisualEffects::setNode(const NodeMesh& mesh) {
    if (needsSurface()) surface_.set(mesh);
}

void VisualEffects::clear() {
    surface_.clear();
    forget();
}

void VisualEffects::forget() {
    trail_.clear();
    if (dust_) dust_->clear();
    if (bleeding_) bleeding_->clear();
    if (irrigation_) irrigation_->clear();
    if (browning_) browning_->clear();
    if (film_) film_->clear();
    if (film_) film_->markDue();
}

void VisualEffects::advance(double dt) {
    if (!(dt > 0)) return;
    left_ += std::min(dt, kLongestAdvance);
    slowest_picture_ = std::max(slowest_picture_, std::min(dt, kLongestAdvance));
    if (spin_) spin_->advance(dt, input_.spin_speed);
    if (pulse_) pulse_->advance(dt);
    for (; left_ >= kStep; left_ -= kStep) step();
}

void VisualEffects::step() {
    time_ += kStep;
    if (input_.X_VT && needsSurface()) surface_.focusOn(input_.X_VT->position.cast<float>());
    if (dust_) dust_->advance(kStep, surface_);
    if (irrigation_) irrigation_->advance(kStep, surface_, *film_);
    if (irrigation_) wash(kStep);
    if (!film_) return;
    shown_time_ += kStep;
    if (shown_time_ >= std::max(kShownStep, kShownRest * slowest_picture_)) {
        film_->markDue();
        shown_time_ = slowest_picture_ = 0;
    }
    film_time_ += kStep;
    if (film_time_ < kFilmStep) return;
    stepFilm(film_time_);
    film_time_ = 0;
}

void VisualEffects::stepFilm(double dt) {
    if (bleeding_) openCuts();
    if (bleeding_) bleeding_->advance(dt, input_.up_V.cast<float>(), surface_, *film_);
    if (irrigation_) irrigation_->dry(dt, *film_);
}

// Of the vertices that are new, the cuts are those beside which the burr was while it cut.
void VisualEffects::openCuts() {
    std::vector<SurfacePoint> fresh = surface_.takeFresh();
    std::erase_if(trail_, [&](const Trail& t) { return time_ - t.time > kTrailTime; });
    const float reach = float(input_.burr_radius) + kCutMargin;
    std::erase_if(fresh, [&](const SurfacePoint& point) {
        return std::ranges::none_of(
            trail_, [&](const Trail& t) { return (t.centre - point.p_V).squaredNorm() < reach * reach; });
    });
    // The cut is white until it bleeds again.
    for (const SurfacePoint& point : fresh) film_->scale(SurfaceFilm::kBlood, point.p_V, 0, film_->cell());
    bleeding_->open(fresh, *film_);
}

void VisualEffects::wash(double dt) {
    const auto reach = float(input_.burr_radius);
    for (const Eigen::Vector3f& p_V : irrigation_->landed()) {
        // Some pieces of water land in each step: each washes its part.
        const float stays = irrigation_->washFactor(dt);
        if (bleeding_) film_->scale(SurfaceFilm::kBlood, p_V, stays, reach);
        if (dust_) dust_->wash(p_V, reach, 1 - stays);
    }
}

}  // namespace bonemill
