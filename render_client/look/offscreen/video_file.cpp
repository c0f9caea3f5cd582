#include "render_client/look/offscreen/video_file.h"

#include <fcntl.h>
#include <spawn.h>
#include <sys/mman.h>
#include <sys/socket.h>
#include <sys/wait.h>
#include <unistd.h>

#include <array>
#include <cerrno>
#include <csignal>
#include <cstdio>
#include <cstring>
#include <vector>

#include "common/base/user_error.h"

namespace bonemill {
namespace {

constexpr int kPicturesForEncoder = 0, kComplaintsOfEncoder = 2;  // its descriptors
// H.264 in the colours that every player knows halves the colour's resolution: sizes become even.
constexpr const char* kFilter = "pad=ceil(iw/2)*2:ceil(ih/2)*2,format=yuv420p";

const std::filesystem::path& requireMp4(const std::filesystem::path& path) {
    if (path.extension() != ".mp4")
        throw UserError("--video " + path.string() + ": a video's name ends in .mp4");
    return path;
}

std::string rateText(double fps) {
    std::array<char, 32> text;
    std::snprintf(text.data(), text.size(), "%.6g", fps);
    return text.data();
}

void closeIfOpen(int& descriptor) {
    if (descriptor >= 0) close(descriptor);
    descriptor = -1;
}

// It has a process group of its own: Ctrl-C ends the viewer, which then ends the video in order. Returns 0 or
// an errno.
int spawnEncoder(std::vector<std::string> words, int pictures, int complaints, pid_t& encoder) {
    std::vector<char*> raw;
    for (std::string& word : words) raw.push_back(word.data());
    raw.push_back(nullptr);
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, pictures, kPicturesForEncoder);
    posix_spawn_file_actions_adddup2(&actions, complaints, kComplaintsOfEncoder);
    posix_spawn_file_actions_addclosefrom_np(&actions, kComplaintsOfEncoder + 1);
    posix_spawnattr_t attributes;
    posix_spawnattr_init(&attributes);
    posix_spawnattr_setflags(&attributes, POSIX_SPAWN_SETPGROUP);
    posix_spawnattr_setpgroup(&attributes, 0);
    const int error = posix_spawnp(&encoder, raw[0], &actions, &attributes, raw.data(), environ);
    posix_spawnattr_destroy(&attributes);
    posix_spawn_file_actions_destroy(&actions);
    return error;
}

}  // namespace

VideoFile::VideoFile(const std::filesystem::path& path, int width, int height, double fps)
    : file_(requireMp4(path)) {
    std::array<int, 2> ends{-1, -1};  // ours, the encoder's
    if (socketpair(AF_UNIX, SOCK_STREAM | SOCK_CLOEXEC, 0, ends.data()) != 0)
        throw UserError(path.string() + ": no socket to the encoder: " + std::strerror(errno));
    complaints_ = memfd_create("ffmpeg", MFD_CLOEXEC);
    const std::string size = std::to_string(width) + "x" + std::to_string(height);
    const int error =
        spawnEncoder({"ffmpeg",      "-nostdin",   "-hide_banner", "-loglevel",     "error",
                      "-y",          "-f",         "rawvideo",     "-pixel_format", "rgb24",
                      "-video_size", size,         "-framerate",   rateText(fps),   "-i",
                      "pipe:0",      "-an",        "-vf",          kFilter,         "-c:v",
                      "libx264",     "-preset",    "veryfast",     "-crf",          "20",
                      "-movflags",   "+faststart", "-f",           "mp4",           "file:" + file_.part()},
                     ends[1], complaints_, encoder_);
    close(ends[1]);
    pictures_ = ends[0];
    if (error == 0) return;
    encoder_ = -1;
    closeIfOpen(pictures_);
    closeIfOpen(complaints_);
    throw UserError(path.string() + ": the program ffmpeg, which makes videos, " +
                    (error == ENOENT ? "is not installed; type: apt install ffmpeg"
                                     : "cannot be started: " + std::string(std::strerror(error))));
}

VideoFile::~VideoFile() {
    if (encoder_ > 0) kill(encoder_, SIGKILL);
    waitForEncoder();
    closeIfOpen(complaints_);
}

void VideoFile::add(const Picture& picture, size_t times) {
    const size_t size = size_t(picture.width()) * size_t(picture.height()) * 3;
    for (size_t n = 0; n < times; ++n) {
        const uint8_t* bytes = picture.row(0);
        for (size_t left = size; left > 0;) {
            const ssize_t sent = send(pictures_, bytes, left, MSG_NOSIGNAL);
            if (sent < 0 && errno == EINTR) continue;
            if (sent <= 0) fail();
            bytes += sent;
            left -= size_t(sent);
        }
    }
}

void VideoFile::finish() {
    if (waitForEncoder() != 0) fail();
    file_.finish();
}

int VideoFile::waitForEncoder() {
    closeIfOpen(pictures_);  // says that no picture comes any more
    int status = 0;
    if (encoder_ <= 0) return status;
    while (waitpid(encoder_, &status, 0) < 0 && errno == EINTR) {
    }
    encoder_ = -1;
    return status;
}

void VideoFile::fail() {
    const int status = waitForEncoder();
    std::string why = complaint();
    if (why.empty() && WIFSIGNALED(status)) why = strsignal(WTERMSIG(status));
    throw UserError(file_.path().string() +
                    ": the video could not be written (disk full?); ffmpeg says: " + why);
}

// The first lines say what went wrong, the others what came of it.
std::string VideoFile::complaint() const {
    constexpr size_t kMax = 300;
    std::string text(kMax, '\0');
    const ssize_t count = pread(complaints_, text.data(), text.size(), 0);
    text.resize(count > 0 ? size_t(count) : 0);
    while (!text.empty() && text.back() == '\n') text.pop_back();
    for (char& sign : text)
        if (sign == '\n') sign = ' ';
    return text;
}

}  // namespace bonemill
