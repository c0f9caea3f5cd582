#include "render_client/sound/sound_output.h"

#include <AL/al.h>
#include <AL/alc.h>
#include <AL/alext.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <array>
#include <chrono>
#include <cmath>
#include <cstring>
#include <stdexcept>
#include <vector>

#include "common/base/user_error.h"

namespace bonemill {
namespace {

constexpr uint64_t kMaxBytes = 0xffff0000u;
constexpr uint32_t kHeaderBytes = 44;

void put(std::vector<char>& bytes, uint32_t value, int count) {
    for (int i = 0; i < count; ++i) bytes.push_back(char(value >> (8 * i) & 0xff));
}

constexpr int kBuffers = 4;
constexpr size_t kBlock = 768;                 // samples: 16 ms, 64 ms in all buffers
constexpr std::chrono::milliseconds kLook{4};  // between two looks for played buffers
constexpr int kFadeLooks = 40;                 // until the end has been played

}  // namespace

WavFile::WavFile(const std::filesystem::path& path, int sample_rate)
    : path_(path), file_(path, std::ios::binary), sample_rate_(uint32_t(sample_rate)) {
    writeHeader();
    if (!file_) throw UserError("cannot write the sound to " + path.string() + ": " + std::strerror(errno));
}

WavFile::~WavFile() {
    try {
        finish();
    } catch (const UserError&) {
        // Whoever wants to know whether it failed calls finish().
    }
}

void WavFile::writeHeader() {
    std::vector<char> header;
    const auto name = [&](const char* four) { header.insert(header.end(), four, four + 4); };
    name("RIFF");
    put(header, uint32_t(bytes_) + kHeaderBytes - 8, 4);
    name("WAVE");
    name("fmt ");
    put(header, 16, 4);
    put(header, 1, 2);  // PCM
    put(header, 1, 2);  // mono
    put(header, sample_rate_, 4);
    put(header, sample_rate_ * 2, 4);
    put(header, 2, 2);
    put(header, 16, 2);
    name("data");
    put(header, uint32_t(bytes_), 4);
    file_.seekp(0);
    file_.write(header.data(), std::streamsize(header.size()));
}

void WavFile::write(std::span<const float> samples) {
    if (is_finished_ || bytes_ + 2 * samples.size() > kMaxBytes) return;
    packed_.clear();
    for (const float sample : samples) {
        const auto value = int16_t(std::lround(std::clamp(sample, -1.0f, 1.0f) * 32767));
        put(packed_, uint16_t(value), 2);
    }
    file_.write(packed_.data(), std::streamsize(packed_.size()));
    bytes_ += packed_.size();
}

void WavFile::finish() {
    if (is_finished_) return;
    is_finished_ = true;
    writeHeader();
    file_.close();
    if (!file_) throw UserError("the sound could not be written whole to " + path_.string());
}

// It has OpenAL's device, its context and a source that plays buffers one after the other.
class SoundPlayer::Output {
  public:
    // Throws std::runtime_error.
    Output() : device_(alcOpenDevice(nullptr), alcCloseDevice) {
        if (!device_) throw std::runtime_error("no sound device");
        context_ = {alcCreateContext(device_.get(), nullptr), alcDestroyContext};
        if (!context_ || !alcMakeContextCurrent(context_.get()))
            throw std::runtime_error("the sound device refuses a context");
        alGenBuffers(kBuffers, buffers_.data());
        alGenSources(1, &source_);
        if (alGetError() != AL_NO_ERROR) throw std::runtime_error("the sound device refuses buffers");
    }
    ~Output() {
        alSourceStop(source_);
        alDeleteSources(1, &source_);
        alDeleteBuffers(kBuffers, buffers_.data());
        alcMakeContextCurrent(nullptr);
    }
    // Fills all buffers that have been played. Returns false when the device is gone.
    bool fill(MillingSynth& synth) {
        ALint played = 0, state = 0;
        alGetSourcei(source_, AL_BUFFERS_PROCESSED, &played);
        for (; played > 0; --played) {
            ALuint buffer = 0;
            alSourceUnqueueBuffers(source_, 1, &buffer);
            queue(buffer, synth);
        }
        for (; filled_ < kBuffers; ++filled_) queue(buffers_[size_t(filled_)], synth);
        alGetSourcei(source_, AL_SOURCE_STATE, &state);
        if (state != AL_PLAYING) alSourcePlay(source_);  // at the start, and after a late block
        ALCint is_connected = 1;
        if (alcIsExtensionPresent(device_.get(), "ALC_EXT_disconnect"))
            alcGetIntegerv(device_.get(), ALC_CONNECTED, 1, &is_connected);
        return is_connected && alGetError() == AL_NO_ERROR;
    }

  private:
    void queue(ALuint buffer, MillingSynth& synth) {
        synth.render(samples_);
        std::ranges::transform(samples_, packed_.begin(),
                               [](float s) { return ALshort(std::lround(s * 32767)); });
        alBufferData(buffer, AL_FORMAT_MONO16, packed_.data(), ALsizei(sizeof packed_),
                     MillingSynth::kSampleRate);
        alSourceQueueBuffers(source_, 1, &buffer);
    }

    std::unique_ptr<ALCdevice, ALCboolean (*)(ALCdevice*)> device_;
    std::unique_ptr<ALCcontext, void (*)(ALCcontext*)> context_{nullptr, alcDestroyContext};
    std::array<ALuint, kBuffers> buffers_{};
    ALuint source_ = 0;
    int filled_ = 0;
    std::array<float, kBlock> samples_{};
    std::array<ALshort, kBlock> packed_{};
};

SoundPlayer::SoundPlayer(const scene::MillingSound& wish) : synth_(wish), thread_([this] { run(); }) {}

SoundPlayer::~SoundPlayer() {
    must_stop_ = true;
    thread_.join();
}

void SoundPlayer::setLoad(const SoundLoad& load, bool is_heard) noexcept {
    spin_speed_.store(load.spin_speed, std::memory_order_relaxed);
    burr_force_.store(load.burr_force, std::memory_order_relaxed);
    cutting_power_.store(load.cutting_power, std::memory_order_relaxed);
    is_heard_.store(is_heard, std::memory_order_relaxed);
}

void SoundPlayer::takeLoad() noexcept {
    constexpr auto kOrder = std::memory_order_relaxed;
    synth_.setLoad({spin_speed_.load(kOrder), burr_force_.load(kOrder), cutting_power_.load(kOrder)},
                   is_heard_.load(kOrder) && !must_stop_.load(kOrder));
}

void SoundPlayer::run() {
    try {
        Output output;
        is_playing_ = true;
        for (int ending = 0; ending < kFadeLooks; ending += must_stop_ ? 1 : 0) {
            takeLoad();
            if (!output.fill(synth_)) throw std::runtime_error("the sound device is gone");
            std::this_thread::sleep_for(kLook);
        }
    } catch (const std::exception& error) {
        spdlog::warn("no milling sound: {}", error.what());
    }
    is_playing_ = false;
}

}  // namespace bonemill
