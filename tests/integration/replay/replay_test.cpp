// A recorded session is replayed by the program, and seen and led by viewers.
#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <filesystem>
#include <map>

#include "render_client/link/subscribe/scene_subscriber.h"
#include "tests/support/dds_session.h"
#include "tests/support/process.h"
#include "tests/support/recorded_session.h"

namespace bonemill {
namespace {

using test::Process;

// To the last vertex, whichever revision of the leaves it is.
bool areTheSame(const std::map<uint32_t, NodeMesh>& a, const std::map<uint32_t, NodeMesh>& b) {
    return std::ranges::equal(a, b, [](const auto& one, const auto& other) {
        return one.first == other.first && one.second.vertices == other.second.vertices &&
               one.second.indices == other.second.indices;
    });
}

class Replay : public testing::Test {
  protected:
    Replay() : session_(test::recordSession(folder_.path())) {}

    std::vector<std::string> server(const std::vector<std::string>& more = {}) const {
        std::vector<std::string> arguments{"bonemill_lab", "replay", session_.journal};
        return with(std::move(arguments), more);
    }
    std::vector<std::string> client(const std::vector<std::string>& more) const {
        return with({"render_client"}, more);
    }
    std::string command(const std::string& text) const {
        const test::Finished finished = test::run(client({"--command", text}));
        return std::to_string(finished.exit_code) + " " + finished.out;
    }

    test::TemporaryFolder folder_;
    test::RecordedSession session_;

  private:
    static std::vector<std::string> with(std::vector<std::string> arguments,
                                         const std::vector<std::string>& more) {
        arguments.insert(arguments.end(), more.begin(), more.end());
        arguments.insert(arguments.end(), {"--session", std::to_string(testSession()), "--domain",
                                           std::to_string(testDomain())});
        return arguments;
    }
};

// What a viewer sees of it.
class Watcher {
  public:
    bool sees(const std::function<bool(const SceneSubscriber&)>& condition) {
        return test::waitFor([&] {
            for (SceneModel::Change& change : subscriber_.poll().nodes)
                nodes_[change.mesh.leaf] = std::move(change.mesh);
            return condition(subscriber_);
        });
    }
    bool standsAt(double seconds) {
        return sees([&](const SceneSubscriber& s) {
            return s.toolState() && s.status() && s.status()->has_replay() &&
                   !s.status()->replay().is_seeking() &&
                   std::abs(s.toolState()->session_s() - seconds) < 2e-3;
        });
    }
    const topics::Status& status() const { return *subscriber_.status(); }
    uint64_t digest() const { return subscriber_.digest().value(); }
    const topics::SceneInfo& info() const { return *subscriber_.sceneInfo(); }
    const std::map<uint32_t, NodeMesh>& nodes() const { return nodes_; }
    // Those with a surface of the leaves below, and of this one and those behind, which count from it on.
    std::map<uint32_t, NodeMesh> nodesUntil(uint32_t leaf) const { return shown(0, leaf); }
    std::map<uint32_t, NodeMesh> nodesFrom(uint32_t leaf) const { return shown(leaf, UINT32_MAX); }

  private:
    std::map<uint32_t, NodeMesh> shown(uint32_t from, uint32_t to) const {
        std::map<uint32_t, NodeMesh> shown;
        for (auto node = nodes_.lower_bound(from); node != nodes_.lower_bound(to); ++node)
            if (!node->second.isEmpty()) shown.emplace(node->first - from, node->second);
        return shown;
    }

    std::map<uint32_t, NodeMesh> nodes_;  // by leaf
    SceneSubscriber subscriber_{
        SubscriberOptions{.domain = testDomain(), .session = testSession(), .name = "w"}};
};

TEST_F(Replay, IsALiveSessionToItsViewersAndGoesWhereItIsLed) {
    Process server(this->server({"--paused"}));
    Watcher watcher;
    ASSERT_TRUE(watcher.standsAt(0)) << server.errSoFar();
    ASSERT_TRUE(watcher.sees(
        [](const SceneSubscriber& s) { return s.isComplete() && !s.status()->is_model_partial(); }));
    const uint64_t scanned = watcher.digest();
    const auto scanned_nodes = watcher.nodes();
    EXPECT_FALSE(watcher.status().replay().is_playing());
    EXPECT_NEAR(watcher.status().replay().length_s(), 2.999, 1e-3);
    EXPECT_EQ(watcher.status().removed_mm3(), 0);

    EXPECT_EQ(command("seek 1.7"), "0 go to 1.70 s: done\n");
    ASSERT_TRUE(watcher.standsAt(1.7));
    const double voxel_mm3 = 0.25 * 0.25 * 0.25,
                 removed_mm3 = double(session_.missing_voxels[1700]) * voxel_mm3;
    ASSERT_TRUE(watcher.sees([&](const SceneSubscriber& s) {
        return std::abs(s.status()->removed_mm3() - removed_mm3) < 0.02 * removed_mm3 && s.isComplete() &&
               s.digest().value() != scanned;
    }));
    EXPECT_FALSE(areTheSame(watcher.nodes(), scanned_nodes));
    EXPECT_EQ(command("seek 0"), "0 go to 0.00 s: done\n");
    EXPECT_TRUE(watcher.sees([&](const SceneSubscriber& s) {
        return s.isComplete() && areTheSame(watcher.nodes(), scanned_nodes);
    }));

    ASSERT_TRUE(watcher.sees([](const SceneSubscriber& s) { return s.status()->replay().known_s() > 2.99; }));
    EXPECT_EQ(command("next").substr(0, 20), "0 next event: done: ") << "what happened is said";
    EXPECT_EQ(command("speed 16"), "0 speed 16: done\n");
    EXPECT_EQ(command("resume"), "0 go on milling: done\n");
    ASSERT_TRUE(watcher.sees([](const SceneSubscriber& s) {
        return s.toolState()->session_s() > 2.99 && !s.status()->replay().is_playing();
    }));
    EXPECT_EQ(command("reset").substr(0, 1), "1") << "a recording stays as it was";
    EXPECT_EQ(command("tool 2").substr(0, 1), "1");
    server.signal(SIGTERM);
    EXPECT_EQ(server.wait().exit_code, 0) << server.errSoFar();
}

// Two attempts at one scene, side by side: the other way is shorter, and shifted along y.
class ComparedReplay : public Replay {
  protected:
    static constexpr double kShift = 0.8e-3;
    static test::RecordedSessionOptions shown() { return {.has_orders = false, .file = "a.mcap"}; }
    static test::RecordedSessionOptions shorter() {
        return {.ticks = 1200, .has_orders = false, .file = "b.mcap", .shift = kShift};
    }
    ComparedReplay() : other_(test::recordSession(folder_.path(), shorter())) {
        session_ = test::recordSession(folder_.path(), shown());
    }

    test::RecordedSession other_;
};

bool isGhostAt(const SceneSubscriber& subscriber, double x, double y) {
    const auto& tool = subscriber.toolState();
    return tool && tool->p_wt_expert_m_size() == 3 && std::abs(tool->p_wt_expert_m(0) - x) < 50e-6 &&
           std::abs(tool->p_wt_expert_m(1) - y) < 50e-6;
}

// The places (V, m) along y of the vertices that show this number.
std::vector<double> placesOf(uint8_t number, const std::map<uint32_t, NodeMesh>& nodes) {
    std::vector<double> places;
    for (const auto& [leaf, mesh] : nodes)
        for (size_t n = 0; n < mesh.materials.size(); ++n)
            if (mesh.materials[n] == number)
                places.push_back(double(mesh.origin.y() + mesh.step.y() * float(mesh.vertices[n].y)));
    return places;
}

TEST_F(ComparedReplay, TheOtherToolIsAGhostAndColoursTellTheDifference) {
    Process server(this->server({"--paused", "--against", other_.journal}));
    Watcher watcher;
    for (const uint64_t tick : {700u, 300u, 1100u}) {
        EXPECT_EQ(command("seek " + std::to_string(double(tick) * 1e-3 + 30e-6)).substr(0, 1), "0");
        EXPECT_TRUE(watcher.sees([&](const SceneSubscriber& s) {
            return std::abs(s.toolState() ? s.toolState()->session_s() - double(tick) * 1e-3 : 1) < 2e-3 &&
                   isGhostAt(s, other_.x_m[tick], other_.y_m[tick]);
        })) << tick
            << server.errSoFar();
    }
    const topics::Comparison comparison = watcher.status().replay().comparison();
    EXPECT_EQ(comparison.problem(), "");
    EXPECT_NEAR(comparison.length_s(), 1.199, 1e-3);
    const auto first = uint8_t(comparison.first_material());
    ASSERT_GT(first, 0);
    const auto numbered = [&](int part) { return placesOf(uint8_t(first + part), watcher.nodes()); };
    EXPECT_TRUE(numbered(0).empty() && numbered(1).empty() && numbered(2).empty()) << "it is not switched on";
    EXPECT_EQ(command("difference"), "0 show the difference: done\n");
    ASSERT_TRUE(watcher.sees([&](const SceneSubscriber& s) {
        return s.isComplete() && numbered(0).size() > 50 && numbered(1).size() > 50 &&
               numbered(2).size() > 50;
    }));
    constexpr double kBall = 1.05e-3;  // m, the burr's radius and a little more
    const double last_here = std::ranges::max(session_.y_m) + kBall,
                 first_there = std::ranges::min(other_.y_m) - kBall;
    for (const double y : numbered(0)) EXPECT_LT(y, last_here);
    for (const double y : numbered(1)) EXPECT_GT(y, first_there);
    for (const double y : numbered(2)) EXPECT_TRUE(y > first_there && y < last_here) << y;
    EXPECT_EQ(command("no-difference"), "0 hide the difference: done\n");
    EXPECT_TRUE(watcher.sees([&](const SceneSubscriber& s) {
        return s.isComplete() && numbered(0).empty() && numbered(1).empty() && numbered(2).empty();
    }));
    EXPECT_EQ(command("alone"), "0 compare with no other attempt: done\n");
    EXPECT_TRUE(watcher.sees([](const SceneSubscriber& s) {
        return !s.status()->replay().has_comparison() && s.toolState()->p_wt_expert_m().empty();
    }));
    EXPECT_EQ(command("compare b").substr(0, 1), "1") << "it was not told where attempts are";
}

// At the beginning both bones are as scanned, later each as its own attempt has left it.
TEST_F(ComparedReplay, TheOtherBoneComesBesideTheFirstWhereItIsWished) {
    Process server(this->server({"--paused", "--against", other_.journal}));
    Watcher watcher;
    ASSERT_TRUE(watcher.sees([](const SceneSubscriber& s) {
        return s.isComplete() && !s.status()->is_model_partial() && s.toolState()->p_wt_expert_m_size() == 3;
    })) << server.errSoFar();
    const uint32_t first = watcher.info().other_first_leaf();
    ASSERT_GT(first, 0u);
    EXPECT_TRUE(watcher.nodesFrom(first).empty());
    EXPECT_EQ(command("side-by-side"), "0 show both bones: done\n");
    const auto areBoth = [&](bool are_same) {
        return watcher.sees([&](const SceneSubscriber& s) {
            return s.isComplete() && !watcher.nodesFrom(first).empty() &&
                   areTheSame(watcher.nodesFrom(first), watcher.nodesUntil(first)) == are_same;
        });
    };
    EXPECT_TRUE(areBoth(true));
    EXPECT_EQ(command("seek 1").substr(0, 1), "0");
    EXPECT_TRUE(areBoth(false));
    EXPECT_EQ(command("seek 0").substr(0, 1), "0");
    EXPECT_TRUE(areBoth(true));
    EXPECT_EQ(command("one-view"), "0 show one bone: done\n");
    EXPECT_TRUE(watcher.sees(
        [&](const SceneSubscriber& s) { return s.isComplete() && watcher.nodesFrom(first).empty(); }));
    EXPECT_EQ(command("side-by-side").substr(0, 1), "0");
    EXPECT_TRUE(areBoth(true)) << "and comes again";
    EXPECT_EQ(command("alone").substr(0, 1), "0");
    EXPECT_TRUE(watcher.sees(
        [&](const SceneSubscriber& s) { return s.isComplete() && watcher.nodesFrom(first).empty(); }));
}

TEST_F(ComparedReplay, WhatCannotBeComparedIsRefusedInOneLine) {
    std::filesystem::create_directories(folder_ / "other");
    const test::RecordedSession foreign = test::recordSession(
        folder_ / "other", {.ticks = 100, .has_orders = false, .scene_text = "loop { rate_hz: 500 }"});
    test::writeFile(folder_ / "broken.mcap", "no recording");
    for (const auto& [file, part] :
         {std::pair<std::string, std::string>{folder_ / "none.mcap", "none.mcap"},
          {folder_ / "broken.mcap", "broken.mcap"},
          {foreign.journal,
           "in another version than what is replayed: compare attempts of the same scene"}}) {
        const test::Finished finished = test::run(server({"--against", file}));
        EXPECT_EQ(finished.exit_code, 2) << file;
        for (const std::string& word :
             {std::string("error: --against: "), part, std::string("lists attempts")})
            EXPECT_NE(finished.err.find(word), std::string::npos) << finished.err;
    }
}

TEST_F(Replay, AViewerOnlyLooksAndAVideoIsMadeOfIt) {
    Process server(this->server({"--speed", "0.5"}));
    const test::Finished refused = test::run(client({"--role", "viewer", "--command", "seek 1"}));
    EXPECT_EQ(refused.exit_code, 1);
    EXPECT_NE(refused.out.find("refused"), std::string::npos) << refused.out << refused.err;
    const test::Finished video =
        test::run(client({"--offscreen", "--video", folder_ / "v.mp4", "--fps", "10", "--seconds", "0.5",
                          "--size", "160x120", "--wait-complete"}));
    EXPECT_EQ(video.exit_code, 0) << video.err;
    EXPECT_NE(video.out.find("\"frames\":5,"), std::string::npos) << video.out;
    EXPECT_GT(std::filesystem::file_size(folder_ / "v.mp4"), 1000u);
}

// A picture may take longer than a server may be silent.
TEST_F(Replay, AVideoSurvivesALongPicture) {
    Process server(this->server({"--paused", "--at", "1", "--speed", "0.25"}));
    Watcher watcher;
    ASSERT_TRUE(watcher.standsAt(1)) << server.errSoFar();
    Process video(client({"--offscreen", "--video", folder_ / "v.mp4", "--fps", "20", "--seconds", "0.5",
                          "--size", "1280x800"}));
    ASSERT_TRUE(watcher.sees([](const SceneSubscriber& s) { return !s.viewers().empty(); }));
    EXPECT_EQ(command("resume").substr(0, 1), "0");
    video.signal(SIGSTOP);
    EXPECT_TRUE(watcher.sees([](const SceneSubscriber& s) { return s.toolState()->session_s() > 1.9; }));
    video.signal(SIGCONT);
    const test::Finished finished = video.wait();
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    EXPECT_NE(finished.out.find("\"frames\":10,"), std::string::npos) << finished.out;
}

TEST_F(Replay, AVideoThatLeadsLacksNoPicture) {
    Process server(this->server({"--paused", "--at", "1"}));
    const auto film = [&](const std::string& from, const std::string& seconds) {
        return test::run(client({"--offscreen", "--video", folder_ / "v.mp4", "--fps", "20", "--seconds",
                                 seconds, "--size", "160x120", "--wait-complete", "--lead-replay", from}))
            .out;
    };
    const std::string whole = film("1", "1"), to_the_end = film("1.95", "30");
    EXPECT_NE(whole.find("\"frames\":20,\"drawn\":20,"), std::string::npos) << whole;
    EXPECT_NE(to_the_end.find("\"frames\":21,\"drawn\":21,"), std::string::npos) << to_the_end;
}

TEST_F(Replay, WhatCannotBeReplayedIsRefusedInOneLine) {
    for (const auto& [file, word] :
         {std::pair<std::string, std::string>{folder_ / "missing.mcap", "missing.mcap"},
          {session_.scene, "no journal"}}) {
        const test::Finished finished =
            test::run({"bonemill_lab", "replay", file, "--session", std::to_string(testSession())});
        EXPECT_EQ(finished.exit_code, 2);
        EXPECT_NE(finished.err.find(word), std::string::npos) << finished.err;
    }
    std::filesystem::remove(folder_ / "slab.nrrd");
    const test::Finished finished = test::run(server());
    EXPECT_EQ(finished.exit_code, 2);
    EXPECT_NE(finished.err.find("slab.nrrd"), std::string::npos) << finished.err;
}

TEST_F(Replay, FilesAreExportedByTheProgram) {
    const test::Finished finished =
        test::run({"bonemill_lab", "session", "export", session_.journal, "--h5", folder_ / "s.h5", "--csv",
                   folder_ / "s.csv", "--traj", folder_ / "t.csv"});
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    for (const char* name : {"s.h5", "s.csv", "t.csv"})
        EXPECT_TRUE(std::filesystem::exists(folder_ / name)) << name;
    const test::Finished nothing = test::run({"bonemill_lab", "session", "export", session_.journal});
    EXPECT_EQ(nothing.exit_code, 2);
    EXPECT_NE(nothing.err.find("--h5"), std::string::npos) << nothing.err;
}

}  // namespace
}  // namespace bonemill
