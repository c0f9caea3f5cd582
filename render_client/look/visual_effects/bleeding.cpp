#include "render_client/look/visual_effects/bleeding.h"

#include <algorithm>
#include <cmath>
#include <utility>

#include "common/base/units.h"
#include "render_client/look/visual_effects/surface_walker.h"

namespace bonemill {
namespace {

constexpr float kBrim = 0.55f;                              // of a full film: from here on blood runs
constexpr float kShortestRun = 1e-3f, kLongestRun = 7e-3f;  // m
constexpr double kMaxCells = 300e3;                         // of the film, that a step looks at
constexpr float kTightness = 0.7f;  // of a cell: nearer to a wound there is no second one
const Eigen::Vector3f kDarkRed(0.105f, 0.0040f, 0.0045f);

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

}  // namespace bonemill
