// Writes pictures as an H.264 video (.mp4). The program ffmpeg encodes; pictures go to it through a socket.
// The file is whole or not there: it is written beside its place until finish().
//
// One thread owns it. It waits for the encoder.
#pragma once

#include <sys/types.h>

#include <filesystem>
#include <string>

#include "common/files/whole_file.h"
#include "common/picture/picture.h"

namespace bonemill {

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
