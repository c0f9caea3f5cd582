#include "render_client/look/visual_effects/pulse.h"

#include <algorithm>
#include <cmath>
#include <numbers>

#include "common/base/units.h"

namespace bonemill {
namespace {

constexpr double kUp = 1.0 / 6;                     // of a beat
constexpr double kSecondWave = 0.5;                 // its place in the beat
constexpr double kSecondRise = 0.12, kWide = 0.07;  // and its size
constexpr double kSteps = 12;                       // of the whole rise

}  // namespace

Pulse::Pulse(const scene::Pulse& wish, const google::protobuf::RepeatedPtrField<scene::Material>& materials)
    : beats_per_s_(wish.rate_per_min() / 60), rise_(wish.rise_um() * kMicrometre), pulsates_{false} {
    for (const scene::Material& material : materials)
        pulsates_.push_back(std::ranges::count(wish.material(), material.name()) > 0);
}

void Pulse::advance(double dt) {
    beat_ += dt * beats_per_s_;
    beat_ -= std::floor(beat_);
}

double Pulse::waveAt(double beat) {
    const double second = kSecondRise * std::exp(-std::pow((beat - kSecondWave) / kWide, 2) / 2);
    if (beat < kUp) return std::pow(std::sin(std::numbers::pi / 2 * beat / kUp), 2);
    return std::pow(1 - (beat - kUp) / (1 - kUp), 2) + second;
}

float Pulse::riseOf(uint32_t structure) const {
    if (structure >= pulsates_.size() || !pulsates_[structure]) return 0;
    return float(std::round(kSteps * waveAt(beat_)) / kSteps * rise_);
}

}  // namespace bonemill
