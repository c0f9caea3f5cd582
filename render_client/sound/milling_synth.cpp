#include "render_client/sound/milling_synth.h"

#include <algorithm>
#include <cmath>
#include <iterator>

#include "common/base/units.h"

namespace bonemill {
namespace {

constexpr double kFastest = 25000;   // rad/s
constexpr double kTouchForce = 0.5;  // N at which contact is fully heard
constexpr double kRubbing = 0.12;    // share of the cutting noise that force alone makes
constexpr double kFullForce = 10;    // N of that
constexpr double kLoaded = 1.0;      // motor's level in contact; out of contact idle_level
constexpr double kMotorLevel = 0.30, kCuttingLevel = 0.85;
constexpr double kSlowestTurn = 8;                           // Hz below which the motor is not heard
constexpr double kNoiseWidth = 0.9, kThinNoiseWidth = 0.45;  // 1/Q of the band-pass
constexpr double kToothDepth = 0.7;
constexpr int kToneBlock = 32;  // samples between two looks at the tones' levels and the band

// These are multiples of the rotation frequency and their strength: the rotor, its harmonics, and
// the whine of the gear.
constexpr struct {
    double multiple, strength;
} kPartials[] = {{1, 1.0}, {2, 0.45}, {3, 0.30}, {4, 0.14}, {5, 0.10}, {6, 0.07}, {11, 0.10}, {13, 0.06}};

double bounded(double value, double low, double high) {
    return std::isfinite(value) ? std::clamp(value, low, high) : 0;
}

// Returns the one-pole weight of one step of this many samples.
double weightOf(double time, int samples) {
    return 1 - std::exp(-samples / (time * MillingSynth::kSampleRate));
}

const double kWeight = weightOf(MillingSynth::kSmoothing, 1), kToneWeight = weightOf(0.01, 1);
const double kBandWeight = weightOf(MillingSynth::kSmoothing, kToneBlock);

}  // namespace

static_assert(std::size(kPartials) == 8);

MillingSynth::MillingSynth(const scene::MillingSound& wish)
    : volume_(wish.volume()),
      idle_level_(wish.idle_level()),
      full_frequency_(wish.full_speed_rpm() / 60),
      full_power_(wish.full_power_w()),
      flutes_(wish.flutes()) {}

void MillingSynth::setLoad(const SoundLoad& load, bool is_heard) noexcept {
    targets_.frequency = std::abs(bounded(load.spin_speed, -kFastest, kFastest)) / kTurn;
    const double force = bounded(load.burr_force, 0, 1000), power = bounded(load.cutting_power, 0, 1e4);
    const double contact = std::min(1.0, std::max(force / kTouchForce, power / (0.05 * full_power_)));
    const double turning = std::clamp((targets_.frequency - kSlowestTurn) / kSlowestTurn, 0.0, 1.0);
    const double speed = turning * std::sqrt(std::min(1.0, targets_.frequency / full_frequency_));
    const double level = is_heard ? volume_ : 0;
    targets_.motor = level * kMotorLevel * speed * (idle_level_ + (kLoaded - idle_level_) * contact);
    const double rubbing = kRubbing * std::min(1.0, force / kFullForce);
    const double cutting = std::min(1.0, std::sqrt(power / full_power_));
    targets_.cutting = level * kCuttingLevel * turning * std::max(cutting, rubbing);
    const double wall = std::isfinite(load.wall) ? load.wall : kThinWall;
    targets_.thinness = std::clamp(1 - wall / kThinWall, 0.0, 1.0);
}

// A tone that would be too high is gone before it gets there.
void MillingSynth::updateTones() noexcept {
    for (size_t i = 0; i < kTones; ++i) {
        const double pitch = frequency_ * kPartials[i].multiple;
        wanted_levels_[i] = kPartials[i].strength * std::clamp(2 * (1 - pitch / kHighest), 0.0, 1.0);
    }
}

void MillingSynth::updateBand() noexcept {
    thinness_ += kBandWeight * (targets_.thinness - thinness_);
    const double middle = kNoiseMiddle * std::pow(kThinNoiseMiddle / kNoiseMiddle, thinness_);
    pitch_ = 2 * std::sin(M_PI * middle / kSampleRate);
    width_ = kNoiseWidth + (kThinNoiseWidth - kNoiseWidth) * thinness_;
}

double MillingSynth::noise() noexcept {
    random_ ^= random_ << 13;
    random_ ^= random_ >> 17;
    random_ ^= random_ << 5;
    return double(random_) * 0x1p-31 - 1;
}

float MillingSynth::nextSample() noexcept {
    frequency_ += kWeight * (targets_.frequency - frequency_);
    motor_ += kWeight * (targets_.motor - motor_);
    cutting_ += kWeight * (targets_.cutting - cutting_);
    double tones = 0;
    const double turn = frequency_ / kSampleRate;
    for (size_t i = 0; i < kTones; ++i) {
        levels_[i] += kToneWeight * (wanted_levels_[i] - levels_[i]);
        phases_[i] += turn * kPartials[i].multiple;
        phases_[i] -= std::floor(phases_[i]);
        tones += levels_[i] * std::sin(kTurn * phases_[i]);
    }
    tooth_phase_ += turn * flutes_;
    tooth_phase_ -= std::floor(tooth_phase_);
    // This is Chamberlin's state variable filter (Dodge, Jerse: Computer Music, 1997).
    low_ += pitch_ * band_;
    band_ += pitch_ * (noise() - low_ - width_ * band_);
    const double tooth = 1 - kToothDepth * 0.5 * (1 + std::cos(kTurn * tooth_phase_));
    const double sum = motor_ * tones + cutting_ * tooth * band_;
    return float(std::tanh(sum));
}

void MillingSynth::render(std::span<float> samples) noexcept {
    for (float& sample : samples) {
        if (to_update_ == 0) {
            updateTones();
            updateBand();
            to_update_ = kToneBlock;
        }
        --to_update_;
        sample = nextSample();
    }
}

}  // namespace bonemill
