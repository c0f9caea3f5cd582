// `haptic_server simulate --set` and `--sweep`, and ways of the hand by deploy/make-trajectory.
#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <sstream>
#include <vector>

#include "tests/support/places.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

using test::run;
using test::writeFile;

class Sweep : public testing::Test {
  protected:
    Sweep() {
        EXPECT_EQ(run({"make_phantom", "body", "--kind", "slab", "--out", folder_ / "slab.nrrd"}).exit_code,
                  0);
        writeFile(scene(), "effects { time_removal {} } volume { path: \"slab.nrrd\" }");
        makeWay({"at", "0.03", "-0.08", "3.3", "drill", "0.8", "2"});
    }
    std::string scene() const { return folder_ / "s.textproto"; }
    std::string way() const { return folder_ / "way.csv"; }
    test::Finished makeWay(std::vector<std::string> words) const {
        words.insert(words.begin(), {test::sourceDir() + "/deploy/make-trajectory", way()});
        return run(words);
    }
    test::Finished simulate(const std::vector<std::string>& more) const {
        std::vector<std::string> words{"haptic_server", "simulate",     "--scene",
                                       scene(),         "--trajectory", way()};
        words.insert(words.end(), more.begin(), more.end());
        return run(words);
    }
    static nlohmann::json lastLineOf(const std::string& out) {
        std::string last;
        std::istringstream lines(out);
        for (std::string line; std::getline(lines, line);) last = line;
        return nlohmann::json::parse(last);
    }

    test::TemporaryFolder folder_;
};

TEST_F(Sweep, ASettingIsAsIfTheSceneSaidIt) {
    const auto plain = lastLineOf(simulate({}).out);
    const auto set = lastLineOf(simulate({"--set", "effects.time_removal.rate_density_per_s=150"}).out);
    EXPECT_NE(plain["state_hash"], set["state_hash"]);
    writeFile(scene(), "effects { time_removal { rate_density_per_s: 150 } } volume { path: \"slab.nrrd\" }");
    EXPECT_EQ(lastLineOf(simulate({}).out)["state_hash"], set["state_hash"]);
}

TEST_F(Sweep, AnEffectIsTakenAwayAsIfTheSceneNeverHadIt) {
    const auto with_it = lastLineOf(simulate({}).out);
    const auto taken = lastLineOf(simulate({"--set", "effects.time_removal="}).out);
    EXPECT_NE(with_it["state_hash"], taken["state_hash"]);
    writeFile(scene(), "effects { } volume { path: \"slab.nrrd\" }");
    EXPECT_EQ(lastLineOf(simulate({}).out)["state_hash"], taken["state_hash"]);
    const auto refused = simulate({"--set", "effects.time_removal="});
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_NE(refused.err.find("--set effects.time_removal=: the scene has no `time_removal` to take away\n"),
              std::string::npos)
        << refused.err;
}

TEST_F(Sweep, IsARunWithEachValue) {
    const auto finished = simulate({"--sweep", "accuracy.preset=FAST,BALANCED"});
    ASSERT_EQ(finished.exit_code, 0) << finished.err;
    EXPECT_NE(finished.out.find("accuracy.preset\n"), std::string::npos);
    const auto runs = lastLineOf(finished.out);
    ASSERT_EQ(runs.size(), 2u);
    EXPECT_EQ(runs[0]["preset"], "fast");
    EXPECT_EQ(runs[1]["preset"], "balanced");
    EXPECT_EQ(runs[1]["value"], "BALANCED");
    EXPECT_EQ(runs[1]["state_hash"],
              lastLineOf(simulate({"--set", "accuracy.preset=BALANCED"}).out)["state_hash"]);
}

TEST_F(Sweep, WhatIsWrongIsOneMessage) {
    for (const auto& [words, part] :
         {std::pair<std::vector<std::string>, std::string>{{"--set", "accuracy.presett=FAST"},
                                                           "did you mean `preset`"},
          {{"--set", "loop.rate_hz=1e9"}, "rate_hz"},
          {{"--sweep", "accuracy.preset"}, "give PATH=VALUE,VALUE"},
          {{"--sweep", "accuracy.preset=FAST", "--trace", "t.csv"}, "would write over t.csv"}}) {
        const auto finished = simulate(words);
        EXPECT_EQ(finished.exit_code, 2) << finished.err;
        EXPECT_NE(finished.err.find(part), std::string::npos) << finished.err;
    }
}

// The worked example of docs/howto/check_physics.md.
TEST_F(Sweep, AWayOfAFewWordsPressesABallOnAPlane) {
    ASSERT_EQ(run({"make_phantom", "body", "--kind", "slab", "--voxel-mm", "0.125", "--dims", "64", "64",
                   "64", "--out", folder_ / "slab.nrrd"})
                  .exit_code,
              0);
    writeFile(scene(), "name: \"press\" volume { path: \"slab.nrrd\" }");
    ASSERT_EQ(makeWay({"at", "0", "0", "3.2", "press", "0.3", "0.3", "hold", "0.5"}).exit_code, 0);
    const auto result = lastLineOf(simulate({}).out);
    EXPECT_EQ(result["ticks"], 1501);
    EXPECT_NEAR(result["max_force_n"].get<double>(), 0.2719, 0.005);  // moving costs a little more
}

TEST_F(Sweep, WaysThatAreNoneAreRefused) {
    for (const std::vector<std::string>& words : {std::vector<std::string>{"press", "1", "1"},
                                                  {"at", "1", "2"},
                                                  {"at", "0", "0", "x"},
                                                  {"fly"},
                                                  {"at", "0", "0", "3", "press", "1", "0"},
                                                  {"at", "0", "0", "3"},
                                                  {"at", "0", "0", "3", "hold", "1e9"},
                                                  {"at", "0", "0", "nan", "hold", "1"},
                                                  {"--rate", "7"},
                                                  {"shaft", "0", "0", "0"}}) {
        const auto finished = makeWay(words);
        EXPECT_EQ(finished.exit_code, 2) << words[0];
        EXPECT_TRUE(finished.err.starts_with("make-trajectory: ")) << finished.err;
    }
}

}  // namespace
}  // namespace bonemill
