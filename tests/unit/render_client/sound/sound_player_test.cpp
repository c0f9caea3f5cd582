// Hears what really leaves OpenAL: its "wave" backend writes a file in real time, as a sound card would
// play it.
#include <gtest/gtest.h>
#include <spdlog/sinks/stdout_sinks.h>
#include <spdlog/spdlog.h>
#include <stdlib.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <thread>
#include <vector>

#include "render_client/sound/sound_output.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/tone.h"

namespace bonemill {
namespace {

using std::chrono::milliseconds;
using Clock = std::chrono::steady_clock;

constexpr int kPlayedRate = MillingSynth::kSampleRate;

// OpenAL reads its settings once per process, so this comes before any test's first call.
void useWaveBackend(const std::string& settings_path, const std::string& settings) {
    std::ofstream(settings_path) << settings;
    setenv("ALSOFT_CONF", settings_path.c_str(), 1);
    setenv("ALSOFT_DRIVERS", "wave", 1);
}

constexpr milliseconds kMinuteToPlay{60'000};  // only ends a test that hangs

// Looks again and again until the condition holds; false when it did not within the limit.
bool holdsWithin(milliseconds limit, const std::function<bool()>& condition) {
    for (const auto end = Clock::now() + limit; Clock::now() < end;
         std::this_thread::sleep_for(milliseconds(5)))
        if (condition()) return true;
    return false;
}

// Waits until the file has grown by so many mono 16-bit samples.
bool playsOn(const std::string& path, size_t samples) {
    const size_t enough = std::filesystem::file_size(path) + samples * sizeof(int16_t);
    return holdsWithin(kMinuteToPlay, [&] { return std::filesystem::file_size(path) >= enough; });
}

// Reads the samples of the chunk "data" of a mono 16-bit file.
std::vector<float> samplesOf(const std::string& path) {
    std::ifstream stream(path, std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(stream)), {});
    const size_t start = bytes.find("data");
    if (start == std::string::npos) return {};
    std::vector<float> samples;
    for (size_t at = start + 8; at + 2 <= bytes.size(); at += 2) {
        int16_t value = 0;
        std::memcpy(&value, &bytes[at], 2);
        samples.push_back(float(value) / 32768);
    }
    return samples;
}

double playedAmplitude(const std::vector<float>& samples, double frequency) {
    return test::amplitudeAt(samples, frequency, kPlayedRate);
}

TEST(SoundPlayer, playsTheSpeedsThatItIsToldAndFadesAtItsEnd) {
    const test::TemporaryFolder folder;
    const std::string path = folder / "played.wav";
    useWaveBackend(
        folder / "alsoft.conf",
        "[general]\nchannels = mono\nsample-type = int16\nfrequency = 48000\n[wave]\nfile = " + path + "\n");
    {
        SoundPlayer player{scene::MillingSound()};
        ASSERT_TRUE(holdsWithin(kMinuteToPlay, [&] { return player.isPlaying(); }));
        player.setLoad({2 * M_PI * 400, 0, 0}, true);
        ASSERT_TRUE(playsOn(path, kPlayedRate / 2));
        player.setLoad({2 * M_PI * 640, 0, 0}, true);
        ASSERT_TRUE(playsOn(path, kPlayedRate / 2));
    }
    const std::vector<float> samples = samplesOf(path);
    ASSERT_GE(samples.size(), size_t(kPlayedRate));
    const double between = playedAmplitude(samples, 540);
    EXPECT_GT(playedAmplitude(samples, 400), 10 * between);
    EXPECT_GT(playedAmplitude(samples, 640), 10 * between);
    const size_t end_size = kPlayedRate / 100;
    EXPECT_LT(test::rms(std::span(samples).last(end_size)), 0.1 * test::rms(samples));
}

// It runs in a process that has not called OpenAL yet, and may not again.
bool playsWithoutDevice() {
    const test::TemporaryFolder folder;
    useWaveBackend(folder / "alsoft.conf", "[wave]\n");  // a backend that has nowhere to write
    spdlog::set_default_logger(spdlog::stderr_logger_mt("to stderr"));
    const SoundPlayer player{scene::MillingSound()};
    return holdsWithin(milliseconds(300), [&] { return player.isPlaying(); });
}

TEST(SoundPlayerDeathTest, withoutADeviceThereIsOneWarningAndSilence) {
    GTEST_FLAG_SET(death_test_style, "threadsafe");
    EXPECT_EXIT(_exit(playsWithoutDevice() ? 1 : 0), testing::ExitedWithCode(0),
                "no milling sound: no sound device\n$");
}

}  // namespace
}  // namespace bonemill
