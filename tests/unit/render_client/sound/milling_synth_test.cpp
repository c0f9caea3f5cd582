#include "render_client/sound/milling_synth.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <limits>
#include <vector>

#include "tests/support/tone.h"

namespace bonemill {
namespace {

using test::rms;

constexpr double kRate = MillingSynth::kSampleRate;

double speedOf(double hertz) {
    return 2 * M_PI * hertz;
}

std::vector<float> play(MillingSynth& synth, const SoundLoad& load, double seconds, bool is_heard = true) {
    synth.setLoad(load, is_heard);
    std::vector<float> samples(size_t(seconds * kRate));
    synth.render(samples);
    return samples;
}

double amplitudeAt(const std::vector<float>& samples, double frequency) {
    return test::amplitudeAt(samples, frequency, kRate);
}

double loudest(const std::vector<float>& samples, double low, double high) {
    return test::loudestTone(samples, low, high, kRate);
}

double largestStep(const std::vector<float>& samples) {
    double largest = 0;
    for (size_t i = 1; i < samples.size(); ++i)
        largest = std::max(largest, std::abs(double(samples[i]) - samples[i - 1]));
    return largest;
}

TEST(MillingSynth, soundsAtTheRotationFrequencyAndItsHarmonics) {
    MillingSynth synth{scene::MillingSound()};
    const SoundLoad load{speedOf(400), 0, 0};
    play(synth, load, 0.5);
    const auto samples = play(synth, load, 0.25);
    EXPECT_NEAR(loudest(samples, 100, 1000), 400, 4);
    EXPECT_GT(amplitudeAt(samples, 800), 20 * amplitudeAt(samples, 700));
    EXPECT_GT(amplitudeAt(samples, 1200), 20 * amplitudeAt(samples, 1100));
}

TEST(MillingSynth, fallsInPitchWithTheSpeedAndSoundsAlikeBackwards) {
    MillingSynth synth{scene::MillingSound()};
    play(synth, {speedOf(500), 3, 5}, 0.5);
    const auto loaded = play(synth, {-speedOf(320), 3, 5}, 1.0);
    const std::vector<float> end(loaded.end() - 12000, loaded.end());
    EXPECT_NEAR(loudest(end, 100, 700), 320, 4);
    EXPECT_NEAR(synth.frequency(), 320, 0.1);
}

TEST(MillingSynth, isSilentAtStandstill) {
    MillingSynth synth{scene::MillingSound()};
    EXPECT_EQ(rms(play(synth, {0, 5, 0}, 0.2)), 0);
    play(synth, {speedOf(400), 5, 5}, 0.3);
    play(synth, {0, 5, 0}, 1.0);
    EXPECT_LT(rms(play(synth, {0, 5, 0}, 0.1)), 1e-6);
}

TEST(MillingSynth, outOfContactIsAsLoudAsTheSceneSays) {
    const auto idle = [](double level) {
        scene::MillingSound wish;
        wish.set_idle_level(level);
        MillingSynth synth(wish);
        play(synth, {speedOf(400), 0, 0}, 1.0);
        return rms(play(synth, {speedOf(400), 0, 0}, 0.2));
    };
    EXPECT_EQ(idle(0), 0);
    EXPECT_NEAR(idle(0.5) / idle(1), 0.5, 0.02);  // nearly: loud samples are rounded off
}

TEST(MillingSynth, cuttingIsNoiseAtTheToothsPace) {
    scene::MillingSound wish;
    wish.set_idle_level(0);
    MillingSynth synth(wish);
    const SoundLoad light{speedOf(300), 1, 1}, heavy{speedOf(300), 6, 8};
    play(synth, light, 0.5);
    const double quiet = rms(play(synth, light, 0.3));
    play(synth, heavy, 0.5);
    auto samples = play(synth, heavy, 1.0);
    EXPECT_GT(rms(samples), 1.1 * quiet);
    // The noise's strength, not the noise itself, goes with the teeth: 8 flutes at 300 Hz.
    for (float& s : samples) s *= s;
    EXPECT_GT(amplitudeAt(samples, 2400), 2 * amplitudeAt(samples, 2250));
}

// Returns the strength of a noise about a frequency (Hz), the mean of many short pieces.
double strengthAbout(std::span<const float> samples, double frequency) {
    constexpr size_t kPiece = 480;  // 100 Hz
    double sum = 0;
    for (size_t at = 0; at + kPiece <= samples.size(); at += kPiece) {
        const double amplitude = test::amplitudeAt(samples.subspan(at, kPiece), frequency, kRate);
        sum += amplitude * amplitude;
    }
    return sum;
}

double middleOfNoise(double wall) {
    scene::MillingSound wish;
    wish.set_idle_level(0);
    MillingSynth synth(wish);
    const SoundLoad load{speedOf(20), 1, 1, wall};  // the motor's tones lie far below
    play(synth, load, 0.5);
    auto samples = play(synth, load, 6);
    double best = 0, most = 0;
    for (double f = 1500; f < 8000; f *= 1.06)
        if (const double strength = strengthAbout(samples, f); strength > most) most = strength, best = f;
    return best;
}

TEST(MillingSynth, aThinWallSoundsHigherBeforeTheBurrBreaksThrough) {
    const double thick = MillingSynth::kNoiseMiddle, thin = MillingSynth::kThinNoiseMiddle;
    EXPECT_NEAR(middleOfNoise(1) / thick, 1, 0.15);
    EXPECT_NEAR(middleOfNoise(MillingSynth::kThinWall / 2) / std::sqrt(thick * thin), 1, 0.15);
    EXPECT_NEAR(middleOfNoise(0) / thin, 1, 0.1);
}

TEST(MillingSynth, theToothsPaceIsTurnsTimesFlutes) {
    for (const double turns : {300.0, 700.0, 1100.0})
        for (const uint32_t flutes : {2u, 5u}) {
            scene::MillingSound wish;
            wish.set_idle_level(0);
            wish.set_flutes(flutes);
            MillingSynth synth(wish);
            const SoundLoad load{speedOf(turns), 0, 2};
            play(synth, load, 0.5);
            auto samples = play(synth, load, 2);
            for (float& s : samples) s *= s;
            const double pace = turns * flutes;
            EXPECT_GT(amplitudeAt(samples, pace), 1.5 * amplitudeAt(samples, 0.93 * pace))
                << turns << ' ' << flutes;
            EXPECT_GT(amplitudeAt(samples, pace), 1.5 * amplitudeAt(samples, 1.07 * pace))
                << turns << ' ' << flutes;
        }
}

TEST(MillingSynth, neverClicks) {
    scene::MillingSound wish;
    wish.set_volume(1);
    MillingSynth steady(wish);
    const SoundLoad heavy{speedOf(500), 10, 10};
    play(steady, heavy, 0.5);
    const double bound = 1.3 * largestStep(play(steady, heavy, 1.0));
    MillingSynth synth(wish);
    std::vector<float> all;
    // Speed, contact and hearing all jump every 10 ms.
    for (int n = 0; n < 150; ++n) {
        const SoundLoad load{speedOf(n % 3 ? 500 : 40), n % 2 ? 10.0 : 0, n % 5 ? 10.0 : 0, n % 4 ? 1.0 : 0};
        const auto block = play(synth, load, 0.01, n % 7 != 0);
        all.insert(all.end(), block.begin(), block.end());
    }
    EXPECT_GT(rms(all), 0.01);
    EXPECT_LT(largestStep(all), bound);
}

TEST(MillingSynth, doesNotDependOnTheLengthOfBlocks) {
    MillingSynth one{scene::MillingSound()}, other{scene::MillingSound()};
    const SoundLoad load{speedOf(350), 2, 3};
    const auto whole = play(one, load, 0.2);
    std::vector<float> parts(whole.size());
    other.setLoad(load);
    for (size_t at = 0; at < parts.size(); at += 100)
        other.render(std::span(parts).subspan(at, std::min<size_t>(100, parts.size() - at)));
    EXPECT_EQ(whole, parts);
}

TEST(MillingSynth, staysBoundedWhateverItHears) {
    MillingSynth synth{scene::MillingSound()};
    const double nan = std::numeric_limits<double>::quiet_NaN(),
                 inf = std::numeric_limits<double>::infinity();
    for (const SoundLoad& load :
         {SoundLoad{nan, nan, nan, inf}, SoundLoad{inf, -inf, inf}, SoundLoad{1e300, 1e300, 1e300},
          SoundLoad{-25000, -5, -5, -1}, SoundLoad{3000, 5, 5, nan}})
        for (const float s : play(synth, load, 0.2)) ASSERT_LE(std::abs(s), 1);
    EXPECT_GT(rms(play(synth, {speedOf(300), 2, 2}, 1)), 0.01);
}

}  // namespace
}  // namespace bonemill
