// Videos are made, and read again by ffprobe and ffmpeg.
#include "render_client/look/offscreen/video_file.h"

#include <gtest/gtest.h>
#include <sys/resource.h>

#include <array>
#include <csignal>
#include <cstdio>
#include <cstdlib>
#include <fstream>

#include "common/base/user_error.h"
#include "tests/support/temporary_folder.h"

namespace bonemill {
namespace {

std::string outputOf(const std::string& command) {
    std::string output;
    FILE* const pipe = popen(command.c_str(), "r");
    std::array<char, 4096> block;
    while (const size_t count = std::fread(block.data(), 1, block.size(), pipe))
        output.append(block.data(), count);
    pclose(pipe);
    return output;
}

Picture filled(int width, int height, std::array<uint8_t, 3> color) {
    Picture picture(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width * 3; ++x) picture.row(y)[x] = color[size_t(x % 3)];
    return picture;
}

Picture noise(int width, int height, unsigned seed) {
    Picture picture(width, height);
    for (int y = 0; y < height; ++y)
        for (int x = 0; x < width * 3; ++x)
            picture.row(y)[x] = uint8_t((seed = seed * 1664525u + 1013904223u) >> 24);
    return picture;
}

std::string messageOf(const std::function<void()>& work) {
    try {
        work();
    } catch (const UserError& error) {
        return error.what();
    }
    return "";
}

class VideoFileTest : public testing::Test {
  protected:
    test::TemporaryFolder folder_;
    std::filesystem::path path_ = folder_.path() / "out.mp4";
};

TEST_F(VideoFileTest, HasTheFramesAndTheColoursThatWentIn) {
    VideoFile video(path_, 65, 48, 25);  // an odd width is filled up
    video.add(filled(65, 48, {200, 30, 30}), 20);
    for (int n = 0; n < 5; ++n) video.add(filled(65, 48, {30, 30, 200}));
    EXPECT_FALSE(std::filesystem::exists(path_)) << "a video that is not whole";
    video.finish();
    EXPECT_EQ(outputOf("ffprobe -v error -count_frames -select_streams v -show_entries "
                       "stream=codec_name,width,height,r_frame_rate,nb_read_frames -of csv=p=0 " +
                       path_.string()),
              "h264,66,48,25/1,25\n");
    const std::string rgb =
        outputOf("ffmpeg -v error -i " + path_.string() + " -f rawvideo -pix_fmt rgb24 -");
    ASSERT_EQ(rgb.size(), size_t(25 * 66 * 48 * 3));
    const auto* first = reinterpret_cast<const uint8_t*>(rgb.data());
    const auto* last = first + 24 * 66 * 48 * 3;
    EXPECT_GT(first[0], 150);
    EXPECT_LT(first[2], 80);
    EXPECT_LT(last[0], 80);
    EXPECT_GT(last[2], 150);
}

TEST_F(VideoFileTest, LeavesTheOldFileWhereItIsNotFinished) {
    std::ofstream(path_) << "old";
    { VideoFile(path_, 64, 48, 25).add(filled(64, 48, {9, 9, 9})); }
    EXPECT_EQ(std::filesystem::file_size(path_), 3u);
    EXPECT_EQ(std::distance(std::filesystem::directory_iterator(folder_.path()), {}), 1);
}

TEST_F(VideoFileTest, SaysThatTheDiskIsFull) {
    rlimit before{};
    getrlimit(RLIMIT_FSIZE, &before);
    const auto handler = std::signal(SIGXFSZ, SIG_IGN);  // the encoder inherits both
    const rlimit small{40'000, before.rlim_max};
    setrlimit(RLIMIT_FSIZE, &small);
    const std::string message = messageOf([&] {
        VideoFile video(path_, 320, 240, 25);
        for (unsigned n = 0; n < 30; ++n) video.add(noise(320, 240, n));
        video.finish();
    });
    setrlimit(RLIMIT_FSIZE, &before);
    std::signal(SIGXFSZ, handler);
    EXPECT_NE(message.find("out.mp4: the video could not be written (disk full?)"), std::string::npos)
        << message;
    EXPECT_NE(message.find("File too large"), std::string::npos) << message;
    EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(VideoFileTest, SaysHowToGetTheEncoder) {
    const std::string path = std::getenv("PATH");
    setenv("PATH", folder_.path().c_str(), 1);
    const std::string message = messageOf([&] { VideoFile(path_, 64, 48, 25); });
    setenv("PATH", path.c_str(), 1);
    EXPECT_NE(message.find("ffmpeg, which makes videos, is not installed; type: apt install ffmpeg"),
              std::string::npos)
        << message;
    EXPECT_TRUE(std::filesystem::is_empty(folder_.path()));
}

TEST_F(VideoFileTest, RefusesOtherNamesAndFoldersThatAreNotThere) {
    EXPECT_NE(messageOf([&] { VideoFile(folder_.path() / "out.avi", 64, 48, 25); }).find(".mp4"),
              std::string::npos);
    EXPECT_NE(messageOf([&] { VideoFile(folder_.path() / "no" / "out.mp4", 64, 48, 25); }).find("folder"),
              std::string::npos);
}

}  // namespace
}  // namespace bonemill
