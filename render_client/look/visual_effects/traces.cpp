#include "render_client/look/visual_effects/traces.h"

#include <algorithm>

namespace bonemill {
namespace {

// Shares of the burr's radius.
constexpr double kHotPrint = 0.45;  // heat goes so far beside the contact, and below it
constexpr double kTouchPrint = 0.6, kDamagePrint = 1.45;

constexpr double kSlightest = 0.3;  // of the most that touch does

}  // namespace

void Browning::take(const EffectInput& input, SurfaceFilm& film) {
    if (!input.X_VT || !input.hottest_c) return;
    if (input.removed > 0)
        film.scale(SurfaceFilm::kBurn, input.X_VT->position.cast<float>(), 0, float(input.burr_radius));
    const bool is_falling = before_c_ && *input.hottest_c < *before_c_;
    before_c_ = input.hottest_c;
    const bool is_working = input.burr_force > 0 && !input.towards_bone_V.isZero();
    const double share =
        (*input.hottest_c - wish_.brown_from_c()) / (wish_.charred_from_c() - wish_.brown_from_c());
    if (is_falling || !is_working || !(share > 0)) return;  // nor what is not a number
    film.raise(SurfaceFilm::kBurn, input.contact(), float(std::min(share, 1.0)),
               float(kHotPrint * input.burr_radius));
}

void Bruising::take(const EffectInput& input, SurfaceFilm& film) const {
    if (!input.X_VT) return;
    const auto radius = [&](double print) { return float(print * input.burr_radius); };
    if (input.is_protected_touched) {
        const double share = std::clamp(input.protected_force / wish_.full_force_n(), kSlightest, 1.0);
        film.raise(SurfaceFilm::kBruise, input.contact(), kMostOfTouch * float(share), radius(kTouchPrint));
    }
    if (input.is_protected_damaged)
        film.raise(SurfaceFilm::kBruise, input.X_VT->position.cast<float>(), 1, radius(kDamagePrint));
}

}  // namespace bonemill
