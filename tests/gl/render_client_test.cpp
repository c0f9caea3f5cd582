// Runs the program render_client off screen, fed by a real publisher over DDS.
#include <gtest/gtest.h>
#include <png.h>
#include <sys/wait.h>

#include <algorithm>
#include <atomic>
#include <cstdio>
#include <filesystem>
#include <fstream>
#include <thread>

#include "haptic_server/server/publish/publisher.h"
#include "tests/gl/synthetic_scene.h"
#include "tests/support/dds_session.h"
#include "tests/support/places.h"

namespace bonemill {
namespace {

const std::string kProgram = test::binDir() + "/render_client";

struct Outcome {
    int exit_code = -1;
    std::string output;
    std::string errors;
};

std::string readFile(const std::filesystem::path& path) {
    std::ifstream file(path, std::ios::binary);
    return {std::istreambuf_iterator<char>(file), std::istreambuf_iterator<char>()};
}

class RenderClient : public testing::Test {
  protected:
    RenderClient()
        : folder_(std::filesystem::path(testing::TempDir()) / ("render_client_" + std::to_string(getpid()))) {
        std::filesystem::remove_all(folder_);
        std::filesystem::create_directories(folder_);
    }
    ~RenderClient() override { std::filesystem::remove_all(folder_); }

    Outcome run(const std::string& arguments) const {
        const std::string command = std::string("exec ") + kProgram + " " + arguments + " >" +
                                    (folder_ / "stdout").string() + " 2>" + (folder_ / "stderr").string();
        const int status = std::system(("env -u DISPLAY -u WAYLAND_DISPLAY sh -c '" + command + "'").c_str());
        return {WIFEXITED(status) ? WEXITSTATUS(status) : -1, readFile(folder_ / "stdout"),
                readFile(folder_ / "stderr")};
    }
    std::string sessionArguments() const {
        return " --domain " + std::to_string(testDomain()) + " --session " + std::to_string(testSession());
    }

    std::filesystem::path folder_;
};

// The server shows a sphere and goes on saying so.
class SphereServer {
  public:
    SphereServer() : publisher_({.domain = testDomain(), .session = testSession(), .epoch = 0}) {
        const Eigen::Vector3d center = Eigen::Vector3d::Constant(0.008);
        const Eigen::Vector3d half = Eigen::Vector3d::Constant(0.005);
        nodes_ =
            test::meshBody(65, 2.5e-4, [=](const Eigen::Vector3d& p) { return (p - center).norm() - 0.005; });
        topics::SceneInfo info = test::makeSceneInfo("sphere", center - half, center + half);
        *info.mutable_tool() = test::makeToolMesh(1e-3, 5e-4, 0.02);
        info.set_burr_radius_m(1e-3);
        publisher_.publishSceneInfo(info);
        for (const NodeMesh& node : nodes_) publisher_.publishNodes({&node, 1});
        thread_ = std::thread([this] {
            while (!stop_) {
                publisher_.publishStatus(test::makeStatus());
                publisher_.publishToolState(restingTool());
                std::this_thread::sleep_for(std::chrono::milliseconds(50));
            }
        });
    }
    ~SphereServer() {
        stop_ = true;
        thread_.join();
    }
    size_t nodeCount() const { return nodes_.size(); }

  private:
    static TickRecord restingTool() {
        TickRecord record{};
        record.tick = 1000;
        record.q_WT[0] = record.q_WT_device[0] = 1;
        record.p_WT[0] = record.p_WT_device[0] = 0.012;
        return record;
    }

    Publisher publisher_;
    std::vector<NodeMesh> nodes_;
    std::atomic<bool> stop_ = false;
    std::thread thread_;
};

TEST_F(RenderClient, ClientsThatStartEarlyAndLateShowTheSamePicture) {
    const std::string early_folder = (folder_ / "early").string(), late_folder = (folder_ / "late").string();
    const std::string common =
        " --frames 1 --size 320x240 --wait-complete --timeout-s 120" + sessionArguments();
    Outcome early;
    std::thread early_client([&] { early = run("--offscreen --out " + early_folder + common); });
    std::this_thread::sleep_for(std::chrono::milliseconds(300));  // the client waits for its server
    const SphereServer server;
    early_client.join();
    const Outcome late = run("--offscreen --out " + late_folder + common);

    ASSERT_EQ(early.exit_code, 0) << early.errors;
    ASSERT_EQ(late.exit_code, 0) << late.errors;
    EXPECT_EQ(early.output, late.output);
    const std::string expected = "\"nodes\":" + std::to_string(server.nodeCount()) + ",";
    EXPECT_NE(late.output.find(expected), std::string::npos) << late.output;
    EXPECT_NE(late.output.find("\"complete\":true"), std::string::npos) << late.output;
    const std::string early_png = readFile(early_folder + "/frame_0000.png");
    ASSERT_GT(early_png.size(), 1000u);
    EXPECT_TRUE(early_png == readFile(late_folder + "/frame_0000.png"));
}

TEST_F(RenderClient, ShowsTheViewThatItsOptionsSay) {
    const SphereServer server;
    const std::string common = " --size 320x240 --wait-complete --timeout-s 120" + sessionArguments();
    const std::string plain_folder = (folder_ / "plain").string(), cut_folder = (folder_ / "cut").string();
    const Outcome plain = run("--offscreen --no-hud --out " + plain_folder + common);
    const Outcome cut =
        run("--offscreen --no-hud --cut-y 0.5 --flip-y --transparent 0.3 --stereo side-by-side --out " +
            cut_folder + common);
    ASSERT_EQ(plain.exit_code, 0) << plain.errors;
    ASSERT_EQ(cut.exit_code, 0) << cut.errors;
    EXPECT_FALSE(readFile(plain_folder + "/frame_0000.png") == readFile(cut_folder + "/frame_0000.png"));
    const std::string uploaded = "\"uploaded_nodes\":" + std::to_string(server.nodeCount()) + ",";
    EXPECT_NE(plain.output.find(uploaded), std::string::npos) << plain.output;
}

TEST_F(RenderClient, WritesEveryFrameAtTheWantedSizeWithoutAServerToo) {
    const Outcome result = run("--offscreen --frames 3 --interval-ms 10 --size 160x90 --out " +
                               (folder_ / "out").string() + sessionArguments());
    ASSERT_EQ(result.exit_code, 0) << result.errors;
    for (const char* name : {"frame_0000.png", "frame_0001.png", "frame_0002.png"}) {
        png_image header{};
        header.version = PNG_IMAGE_VERSION;
        ASSERT_TRUE(png_image_begin_read_from_file(&header, (folder_ / "out" / name).c_str())) << name;
        EXPECT_EQ(header.width, 160u);
        EXPECT_EQ(header.height, 90u);
        png_image_free(&header);
    }
    EXPECT_FALSE(std::filesystem::exists(folder_ / "out" / "frame_0003.png"));
    EXPECT_EQ(std::count(result.output.begin(), result.output.end(), '\n'), 3);
    EXPECT_NE(result.output.find("\"server\":false"), std::string::npos);
}

TEST_F(RenderClient, WaitCompleteGivesUpWithAHint) {
    const Outcome result = run("--offscreen --wait-complete --timeout-s 1 --out " +
                               (folder_ / "out").string() + sessionArguments());
    EXPECT_EQ(result.exit_code, 1);
    EXPECT_NE(result.errors.find("is a haptic_server running"), std::string::npos) << result.errors;
}

TEST_F(RenderClient, WithoutADisplayItTellsAboutOffscreen) {
    const Outcome result = run("");
    EXPECT_EQ(result.exit_code, 2);
    EXPECT_EQ(result.errors.rfind("error: ", 0), 0u) << result.errors;
    EXPECT_NE(result.errors.find("--offscreen"), std::string::npos) << result.errors;
}

TEST_F(RenderClient, BadArgumentsEndWithCodeTwo) {
    for (const char* arguments : {"--bogus", "--offscreen", "--size 1x1", "--offscreen --out /dev/null/x",
                                  "--cut-x 2", "--transparent --command reset"}) {
        const Outcome result = run(arguments);
        EXPECT_EQ(result.exit_code, 2) << arguments;
        EXPECT_EQ(result.errors.rfind("error: ", 0), 0u) << result.errors;
    }
}

}  // namespace
}  // namespace bonemill
