#include "render_client/sound/wav_file.h"

#include <algorithm>
#include <cmath>
#include <cstring>

#include "common/base/user_error.h"

namespace bonemill {
namespace {

constexpr uint64_t kMaxBytes = 0xffff0000u;
constexpr uint32_t kHeaderBytes = 44;

void put(std::vector<char>& bytes, uint32_t value, int count) {
    for (int i = 0; i < count; ++i) bytes.push_back(char(value >> (8 * i) & 0xff));
}

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

}  // namespace bonemill
