#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

#include "haptic_server/teaching/attempt_report/attempt_result.h"
#include "tests/unit/haptic_server/teaching/attempt_report/typical_result.h"

namespace bonemill {
namespace {

TEST(Xapi, AStatementSaysWhoDidWhatHowLongAndHowWell) {
    const std::string line = xapiStatement(test::typicalResult());
    EXPECT_EQ(line.find('\n'), std::string::npos);
    const auto json = nlohmann::json::parse(line);
    EXPECT_EQ(json.at("actor").at("account").at("name"), "P07");
    EXPECT_EQ(json.at("verb").at("id"), "http://adlnet.gov/expapi/verbs/failed");
    EXPECT_EQ(json.at("result").at("duration"), "PT61.50S");
    EXPECT_EQ(json.at("result").at("success"), false);
    EXPECT_DOUBLE_EQ(json.at("result").at("score").at("scaled"), 0.47);
    EXPECT_EQ(json.at("timestamp"), "2026-11-18T11:36:40Z");
    EXPECT_EQ(json.at("result").at("extensions").begin().value().at("force.max@1").at("unit"), "N");

    // Of URL names and "https://bonemill.invalid/attempts/P07\n00000000deadbeef\n1795001800000000000".
    EXPECT_EQ(json.at("id"), "3699b508-3979-5f45-a8e8-69f336d64c3e");
}

TEST(Xapi, WithoutGatesAnAttemptIsCompletedAndWithoutWeightsUnscored) {
    AttemptResult result = test::typicalResult();
    result.assessment.gates.clear();
    result.assessment.total.reset();
    const auto json = nlohmann::json::parse(xapiStatement(result));
    EXPECT_EQ(json.at("verb").at("id"), "http://adlnet.gov/expapi/verbs/completed");
    EXPECT_FALSE(json.at("result").contains("success"));
    EXPECT_FALSE(json.at("result").contains("score"));
}

TEST(Xapi, TheSameAttemptHasTheSameIdAndAnotherAnother) {
    const auto idOf = [](const AttemptResult& result) {
        return nlohmann::json::parse(xapiStatement(result)).at("id").get<std::string>();
    };
    EXPECT_EQ(idOf(test::typicalResult()), idOf(test::typicalResult()));
    EXPECT_NE(idOf(test::typicalResult("P07", 3)), idOf(test::typicalResult("P07", 4)));
    EXPECT_NE(idOf(test::typicalResult("P07", 3)), idOf(test::typicalResult("P08", 3)));
}

}  // namespace
}  // namespace bonemill
