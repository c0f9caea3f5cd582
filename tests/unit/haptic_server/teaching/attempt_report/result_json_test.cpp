#include <gtest/gtest.h>

#include <nlohmann/json.hpp>
#include <random>

#include "common/base/user_error.h"
#include "haptic_server/teaching/attempt_report/attempt_result.h"
#include "tests/unit/haptic_server/teaching/attempt_report/typical_result.h"

namespace bonemill {
namespace {

TEST(ResultJson, WhatIsWrittenIsReadAgain) {
    const AttemptResult result = test::typicalResult();
    const std::string text = resultJson(result);
    const AttemptResult read = parseResult(text, "a.json");
    EXPECT_EQ(resultJson(read), text);
    EXPECT_EQ(read.pseudonym, "P07");
    EXPECT_EQ(read.assessment.total->weights_hash, "0123456789abcdef");
    EXPECT_EQ(read.assessment.series[0].columns[0].values.size(), 62);
    EXPECT_TRUE(std::isnan(read.assessment.series[0].columns[0].values[0]));
    EXPECT_FALSE(read.assessment.hasPassed());
}

TEST(ResultJson, SaysInPlainWordsHowItWent) {
    const auto json = nlohmann::json::parse(resultJson(test::typicalResult()));
    EXPECT_EQ(json.at("passed"), false);
    EXPECT_EQ(json.at("start_utc"), "2026-11-18T11:36:40Z");
    EXPECT_EQ(json.at("figures")[1].at("unit"), "mm3");
    AttemptResult without_gates = test::typicalResult();
    without_gates.assessment.gates.clear();
    without_gates.assessment.total.reset();
    const auto plain = nlohmann::json::parse(resultJson(without_gates));
    EXPECT_FALSE(plain.contains("passed"));
    EXPECT_FALSE(plain.contains("total"));
}

TEST(ResultJson, RefusesWhatIsNone) {
    auto json = nlohmann::json::parse(resultJson(test::typicalResult()));
    const auto refuses = [](const nlohmann::json& changed) {
        EXPECT_THROW(parseResult(changed.dump(), "a.json"), UserError) << changed.dump().substr(0, 80);
    };
    EXPECT_THROW(parseResult("", "a.json"), UserError);
    EXPECT_THROW(parseResult("[]", "a.json"), UserError);
    EXPECT_THROW(parseResult(std::string(kMaxResult + 1, ' '), "a.json"), UserError);
    auto changed = json;
    changed["bonemill_result"] = 2;
    refuses(changed);
    changed = json;
    changed["figures"][0]["value"] = nullptr;
    refuses(changed);
    changed = json;
    changed["series"][0]["columns"][0]["values"].push_back(1);
    refuses(changed);
    changed = json;
    changed["moments"] = nlohmann::json::array();
    for (int n = 0; n < 20'001; ++n) changed["moments"].push_back(json["moments"][0]);
    refuses(changed);
}

TEST(ResultJson, AnyBytesAreReadOrRefused) {
    const std::string text = resultJson(test::typicalResult());
    std::mt19937 random(1);
    std::uniform_int_distribution<size_t> place(0, text.size() - 1);
    std::uniform_int_distribution<int> byte(0, 255);
    int read = 0;
    for (int n = 0; n < 2000; ++n) {
        std::string mutated = text;
        for (int change = 0; change < 1 + n % 4; ++change) mutated[place(random)] = char(byte(random));
        if (n % 7 == 0) mutated.resize(place(random));
        try {
            parseResult(mutated, "a.json");
            ++read;
        } catch (const UserError&) {
        }
    }
    EXPECT_GT(read, 0);
    EXPECT_LT(read, 2000);
}

}  // namespace
}  // namespace bonemill
