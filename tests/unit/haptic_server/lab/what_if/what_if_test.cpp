#include "haptic_server/lab/what_if/what_if.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>
#include <sstream>

#include "common/base/user_error.h"
#include "haptic_server/lab/assess/assess_journal.h"
#include "haptic_server/recording/rerun/recording.h"
#include "haptic_server/recording/rerun/verify_journal.h"
#include "tests/support/recorded_session.h"
#include "tests/support/temporary_folder.h"

namespace bonemill {
namespace {

constexpr char kGroove[] =
    "assessment { zone { name: \"groove\" role: TARGET shape { cylinder { from_mm { x: 8 y: 8 z: 9 } "
    "to_mm { x: 8 y: 8 z: 12 } radius_mm: 4 } } } }";
constexpr char kFineTool[] =
    " tool { name: \"fine\" burr_radius_mm: 0.7 shape { sphere { center_mm { x: 0 y: 0 z: 0 } "
    "radius_mm: 0.7 } } }";

class WhatIf : public testing::Test {
  protected:
    // Session and scene, with attempts of P1, P2 and P3, the last of which did not end.
    test::RecordedSession withAttempts() {
        return test::recordSession(folder_.path(), {.has_orders = false,
                                                    .scene_text = std::string(kGroove) + kFineTool,
                                                    .attempts = {500, 1500, 2500}});
    }
    WhatIfOptions from(double at_s, const test::RecordedSession& session) const {
        WhatIfOptions options;
        options.journal = session.journal;
        options.at_s = at_s;
        options.out = folder_ / "other.mcap";
        options.version = "test";
        return options;
    }
    nlohmann::json resultOf(const WhatIfOptions& options) {
        std::ostringstream said;
        whatIf(options, said);
        said_ = said.str();
        std::ifstream file(folder_ / "other.json");
        return nlohmann::json::parse(file);
    }
    std::string refusalOf(const WhatIfOptions& options) {
        std::ostringstream said;
        try {
            whatIf(options, said);
        } catch (const UserError& error) {
            return error.what();
        }
        return "not refused";
    }
    static double figure(const nlohmann::json& course, const char* id) {
        return course.at("figures").at(id).get<double>();
    }

    test::TemporaryFolder folder_;
    std::string said_;
};

TEST_F(WhatIf, WithNothingOtherwiseIsTheSessionToTheBit) {
    // Silence, another tool, an order to put the bone back, a pause and a checkpoint come after the moment.
    const test::RecordedSession session = test::recordSession(folder_.path());
    WhatIfOptions options = from(0.3, session);
    options.shift_mm = {0, 0, 0};
    const nlohmann::json result = resultOf(options);
    EXPECT_EQ(result["happened"], result["otherwise"]);
    const Recording happened(session.journal), other(options.out);
    ASSERT_EQ(other.ticks(), happened.ticks());
    RecordedTicks then(happened), now(other);
    for (uint64_t tick = 0; tick < happened.ticks(); ++tick) {
        ASSERT_EQ(now.at(tick).check, then.at(tick).check) << tick;
        ASSERT_EQ(now.at(tick).start_ns, then.at(tick).start_ns) << tick;
    }
}

TEST_F(WhatIf, ADeeperHandRemovesMore) {
    const test::RecordedSession session = withAttempts();
    WhatIfOptions options = from(1.8, session);
    options.shift_mm = {0, 0, -0.5};
    const nlohmann::json result = resultOf(options);
    EXPECT_GT(figure(result["otherwise"], "removal.volume"),
              2 * figure(result["happened"], "removal.volume"));
    EXPECT_EQ(result["otherwise"]["duration_s"], result["happened"]["duration_s"]);
    EXPECT_NE(result["proof"].get<std::string>().find("all 1799 ticks"), std::string::npos);
    EXPECT_NE(said_.find("the hand shifted by (0, 0, -0.5) mm"), std::string::npos) << said_;
}

TEST_F(WhatIf, JudgesTheAttemptAlone) {
    const test::RecordedSession session = withAttempts();
    WhatIfOptions options = from(1.8, session);
    options.shift_mm = {0, 0, 0};
    const nlohmann::json result = resultOf(options);
    std::ostringstream said;
    ASSERT_EQ(assessJournal({.journal = session.journal, .out = folder_ / "class"}, said), 0);
    for (const auto& entry : std::filesystem::directory_iterator(folder_ / "class/results")) {
        if (entry.path().extension() != ".json") continue;
        std::ifstream file(entry.path());
        const nlohmann::json judged = nlohmann::json::parse(file);
        if (judged.at("pseudonym") != "P2") continue;
        EXPECT_EQ(judged.at("duration_s"), result["happened"]["duration_s"]);
        for (const nlohmann::json& one : judged.at("figures"))
            EXPECT_EQ(one.at("value"), result["otherwise"]["figures"].at(one.at("id").get<std::string>()));
        return;
    }
    FAIL() << "there is no result of P2";
}

TEST_F(WhatIf, ASlowerHandGoesTheSameWay) {
    const test::RecordedSession session = withAttempts();
    WhatIfOptions options = from(1.7, session);
    options.pace = 0.5;
    const nlohmann::json result = resultOf(options);
    const Recording other(options.out);
    constexpr uint64_t kFirst = 1700, kLeft = 2500 - kFirst;
    EXPECT_NEAR(double(other.ticks()), double(kFirst + 2 * kLeft), 2);
    RecordedTicks ticks(other);
    const Recording happened(session.journal);
    RecordedTicks recorded(happened);
    for (const uint64_t k : {0u, 100u, 400u, 700u}) {
        const TickInput &slow = ticks.at(kFirst + 2 * k).input, &was = recorded.at(kFirst + k).input;
        for (int axis = 0; axis < 3; ++axis) EXPECT_NEAR(slow.p_WT[axis], was.p_WT[axis], 20e-6) << k;
    }
    EXPECT_NEAR(result["otherwise"]["duration_s"].get<double>(),
                result["happened"]["duration_s"].get<double>() + 1e-3 * double(kLeft), 3e-3);
}

TEST_F(WhatIf, AnotherBurrCutsOtherwise) {
    const test::RecordedSession session = withAttempts();
    WhatIfOptions options = from(0.7, session);
    options.tool = "fine";
    const nlohmann::json result = resultOf(options);
    EXPECT_LT(figure(result["otherwise"], "removal.volume"), figure(result["happened"], "removal.volume"));
    EXPECT_EQ(recordedAttempts(Recording(options.out).content()).back().trainee, "P1");
}

TEST_F(WhatIf, AnotherLawIsFelt) {
    const test::RecordedSession session = withAttempts();
    WhatIfOptions options = from(1.6, session);
    options.accuracy = "exact";
    const nlohmann::json result = resultOf(options);
    EXPECT_NE(result["otherwise"]["figures"], result["happened"]["figures"]);
    EXPECT_NE(said_.find("computed as exact"), std::string::npos) << said_;
}

TEST_F(WhatIf, TheExpertsHandTakesTheTool) {
    // Beside the slab, where no bone is: from there on the expert removes nothing.
    std::ofstream way(folder_ / "way.csv");
    way << "t_s,px_m,py_m,pz_m,qw,qx,qy,qz,buttons\n";
    for (int row = 0; row <= 200; ++row) way << row * 1e-2 << ",0.008,0.008,0.030,1,0,0,0,0\n";
    way.close();
    std::string scene(kGroove);
    scene.insert(scene.rfind('}'), " expert_path: \"way.csv\" ");
    const test::RecordedSession session = test::recordSession(
        folder_.path(), {.has_orders = false, .scene_text = scene, .attempts = {500, 2900}});
    WhatIfOptions options = from(1.6, session);
    options.is_experts = true;
    const nlohmann::json result = resultOf(options);
    EXPECT_LT(figure(result["otherwise"], "removal.volume"), figure(result["happened"], "removal.volume"));
    EXPECT_NEAR(result["otherwise"]["duration_s"].get<double>(), 2, 2e-2);  // so long the expert took
    options.at_s = 2.6;
    options.out = folder_ / "late.mcap";
    EXPECT_NE(refusalOf(options).find("the expert's way does not cover that moment"), std::string::npos);
}

TEST_F(WhatIf, LeavesARecordingThatIsProvenAndNoResult) {
    const test::RecordedSession session = withAttempts();
    WhatIfOptions options = from(1.8, session);
    options.shift_mm = {1, 0, 0};
    resultOf(options);
    EXPECT_TRUE(verifyJournal(options.out, "test", "").isProven());
    std::ostringstream said;
    EXPECT_THROW(assessJournal({.journal = options.out, .out = folder_ / "class"}, said), UserError);
    EXPECT_NE(refusalOf(options).find("other.mcap is there already"), std::string::npos);
}

TEST_F(WhatIf, WhatCannotBeIsRefusedInOneLine) {
    const test::RecordedSession session = withAttempts();
    const auto refused = [&](auto change) {
        WhatIfOptions options = from(1.8, session);
        change(options);
        return refusalOf(options);
    };
    EXPECT_NE(refused([](auto&) {}).find("say what is otherwise"), std::string::npos);
    EXPECT_NE(refused([](auto& options) { options.tool = "chisel"; }).find("chisel"), std::string::npos);
    EXPECT_NE(refused([](auto& options) { options.accuracy = "best"; }).find("balanced"), std::string::npos);
    EXPECT_NE(refused([](auto& options) { options.is_experts = true; }).find("expert_path"),
              std::string::npos);
    EXPECT_NE(refused([](auto& options) { options.pace = 2, options.at_s = 3; }).find("ends after"),
              std::string::npos);
    EXPECT_NE(refused([](auto& options) { options.pace = 2, options.out = "x"; }).find("ends in .mcap"),
              std::string::npos);
}

}  // namespace
}  // namespace bonemill
