// It is a mono 16-bit WAV file that grows while it is written (RIFF; IBM, Microsoft: Multimedia Programming
// Interface 1.0, 1991). It is for one thread. The header says the length after finish() or destruction.
#pragma once

#include <cstdint>
#include <filesystem>
#include <fstream>
#include <span>
#include <vector>

namespace bonemill {

class WavFile {
  public:
    // Throws UserError when the file cannot be made.
    WavFile(const std::filesystem::path& path, int sample_rate);
    ~WavFile();
    WavFile(const WavFile&) = delete;
    WavFile& operator=(const WavFile&) = delete;

    // Samples go from -1 to 1; louder ones are cut. After 4 GiB nothing is added.
    void write(std::span<const float> samples);
    // Throws UserError when something could not be written.
    void finish();

  private:
    void writeHeader();

    std::filesystem::path path_;
    std::ofstream file_;
    uint32_t sample_rate_;
    uint64_t bytes_ = 0;
    std::vector<char> packed_;
    bool is_finished_ = false;
};

}  // namespace bonemill
