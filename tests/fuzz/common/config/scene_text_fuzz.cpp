// Every damaged scene is either accepted with all values in range, or refused with one UserError.
#include <gtest/gtest.h>

#include <algorithm>
#include <random>
#include <string>
#include <vector>

#include "common/base/user_error.h"
#include "common/config/scene_check.h"
#include "common/config/scene_text.h"

namespace bonemill {
namespace {

const std::string kScene = R"(
name: "fuzz"
volume { path: "v.nrrd" window_low: -1000 window_high: 3000 iso_value: 600 leaf_voxels: 16 label_path: "l.nrrd" }
tool { shape { sphere { center_mm { x: 1 y: 2 z: 3 } radius_mm: 1.5 } } shape { cone { from_radius_mm: 0.3 } } speed_rpm: 4e4 }
coupling { max_speed_mm_per_s: 500 static_damping: 0.5 }
effects { time_removal { rate_density_per_s: 1e4 } spindle {} bone_dust {} }
material { name: "enamel" from_value: 2000 label: 3 color { red: 0.9 } }
assessment {
  zone { name: "leeway" role: LEEWAY_SIDES shape { box { size_mm { x: 4 y: 4 z: 2 } q_WB { w: 1 } } } color { red: 1 } }
  zone { name: "caries" role: TARGET material: "enamel" shape { cone { to_mm { z: 2 } } } }
  reference { volume_path: "expert.nrrd" }
  gate { figure: "zone.removed:caries" at_least: 90 label: "all of it" }
  sub_score { figure: "overcut.p95" worst: 1 best: 0 weight: 2 }
  time_limit_s: 300 most_attempts: 3 feedback: LIVE approach { z: -1 } plan { tip_mm { z: -5 } }
}
device { p_WD_mm { z: -20 } q_WD { w: 0.7071068 x: 0.7071068 } }
simulated_operator {
  waypoint { time_s: 0 p_WT_mm { z: 5 } }
  waypoint: [ { time_s: 1 remove: true phase: "mill" }, { time_s: 2 } ]
}
)";

struct Tally {
    int accepted = 0;
    int refused = 0;
};

// Anything thrown but UserError fails the test.
void load(const std::string& text, Tally& tally) {
    try {
        const ParsedScene parsed = parseSceneText(text, "fuzz");
        checkScene(parsed, "fuzz");
        ++tally.accepted;
        ASSERT_GE(parsed.scene.coupling().max_speed_mm_per_s(), 1.0);
        ASSERT_LE(parsed.scene.coupling().static_damping(), 0.99);
        ASSERT_FALSE(parsed.scene.volume().path().empty());
        ASSERT_LE(parsed.scene.assessment().zone_size(), 32);
        for (const auto& gate : parsed.scene.assessment().gate())
            ASSERT_NE(gate.limit_case(), scene::Task::Gate::LIMIT_NOT_SET);
    } catch (const UserError& error) {
        ++tally.refused;
        ASSERT_TRUE(std::string(error.what()).starts_with("fuzz:")) << error.what();
    }
}

TEST(SceneTextFuzz, truncatedScenes) {
    Tally tally;
    for (size_t length = 0; length <= kScene.size(); ++length) load(kScene.substr(0, length), tally);
    EXPECT_GT(tally.accepted, 0);
    EXPECT_GT(tally.refused, 0);
}

TEST(SceneTextFuzz, flippedBytes) {
    std::mt19937 random(1);
    Tally tally;
    for (int round = 0; round < 20000; ++round) {
        std::string text = kScene;
        for (int flips = int(random() % 4) + 1; flips > 0; --flips)
            text[random() % text.size()] = static_cast<char>(random());
        load(text, tally);
    }
    EXPECT_GT(tally.accepted, 0);
    EXPECT_GT(tally.refused, 0);
}

TEST(SceneTextFuzz, shuffledWordsAndOddNumbers) {
    std::mt19937 random(2);
    std::vector<std::string> words;
    for (size_t begin = 0; begin < kScene.size();) {
        const size_t end = std::min(kScene.find_first_of(" \n", begin), kScene.size());
        if (end > begin) words.push_back(kScene.substr(begin, end - begin));
        begin = end + 1;
    }
    const std::vector<std::string> odd{"nan", "-inf", "1e999", "0x7fffffff", "-1",
                                       "{",   "}",    "\"",    "[a.b/c]",    "\xff"};
    Tally tally;
    for (int round = 0; round < 20000; ++round) {
        std::vector<std::string> mixed = words;
        for (int edits = int(random() % 3) + 1; edits > 0; --edits) {
            std::string& word = mixed[random() % mixed.size()];
            word = random() % 2 ? odd[random() % odd.size()] : words[random() % words.size()];
        }
        std::string text;
        for (const std::string& word : mixed) text += word + " ";
        load(text, tally);
    }
    EXPECT_GT(tally.accepted, 0);
    EXPECT_GT(tally.refused, 0);
}

TEST(SceneTextFuzz, deepNestingIsRefused) {
    std::string text;
    for (int i = 0; i < 100000; ++i) text += "volume {";
    Tally tally;
    load(text, tally);
    EXPECT_EQ(tally.refused, 1);
}

}  // namespace
}  // namespace bonemill
