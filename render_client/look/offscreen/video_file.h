// Writes pictures as an H.264 video (.mp4). The program ffmpeg encodes; pictures go to it through a socket.
// The file is whole or not there: it is written beside its place until finish().
//
// One thread owns it. It waits for the encoder.
#pragma once

#include <sys/types.h>

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <filesystem>
#include <string>

#include "common/files/whole_file.h"
#include "common/picture/picture.h"

namespace bonemill {

// Says how many frames of a video are due, so that a second of the video is a second of what it shows,
// however slowly pictures are drawn.
class VideoClock {
  public:
    // A clock that leaps (a replay's: a viewer seeks in it) goes on in the video as if it had not.
    VideoClock(double fps, bool may_leap) : fps_(fps), may_leap_(may_leap) {}

    // The clock of what is shown stands at `now_s`, and would have gone on by `expected_s` without a leap:
    // returns the number of frames that are due and have not been before, one at the first call.
    uint64_t due(double now_s, double expected_s = 0) {
        if (frames_ == 0) {
            start_s_ = now_s;
        } else if (const double passed = now_s - last_s_;
                   passed < 0 || (may_leap_ && passed > expected_s + kLeapS)) {
            start_s_ += passed;
        }
        last_s_ = now_s;
        const auto wanted = uint64_t(std::max(0.0, std::floor((now_s - start_s_) * fps_ + kRounding))) + 1;
        const uint64_t count = wanted > frames_ ? wanted - frames_ : 0;
        frames_ += count;
        return count;
    }

  private:
    static constexpr double kLeapS = 0.5;
    static constexpr double kRounding = 1e-6;  // of a frame

    double fps_;
    bool may_leap_;
    double start_s_ = 0, last_s_ = 0;
    uint64_t frames_ = 0;
};

class VideoFile {
  public:
    // Each picture will be of this size (pixels). Throws UserError: the path cannot be written, does not end
    // in .mp4, or ffmpeg is missing.
    VideoFile(const std::filesystem::path& path, int width, int height, double fps);
    // Without finish() nothing is left.
    ~VideoFile();
    VideoFile(const VideoFile&) = delete;
    VideoFile& operator=(const VideoFile&) = delete;

    // Shows it for `times` frames. Throws UserError with what ffmpeg says.
    void add(const Picture& picture, size_t times = 1);

    // Waits for the encoder and puts the file in its place. Throws UserError if either fails.
    void finish();

  private:
    [[noreturn]] void fail();
    int waitForEncoder();  // returns its status
    std::string complaint() const;

    WholeFile file_;
    int pictures_ = -1;    // the socket to the encoder
    int complaints_ = -1;  // a file in memory, its standard error
    pid_t encoder_ = -1;
};

}  // namespace bonemill
