#include "device_daemon/bridges/haply/haply_messages.h"

#include <gtest/gtest.h>

#include <nlohmann/json.hpp>

namespace bonemill::bridge {
namespace {

using nlohmann::json;

TEST(HaplyMessages, WhatAMessageLeavesOutStays) {
    HaplyState state;
    ASSERT_TRUE(takeMessage(R"({"inverse3":[{"device_id":"04BA","config":{"type":"minverse"},
        "state":{"cursor_position":{"x":1,"y":2,"z":3}},"status":{"calibrated":true,"power_supply":true,"ready":true}}]})",
                            "", state));
    EXPECT_EQ(state.device_id, "04BA");
    EXPECT_EQ(state.type, "minverse");
    EXPECT_TRUE(state.is_there && state.is_calibrated && state.has_power && state.is_ready);
    ASSERT_TRUE(
        takeMessage(R"({"inverse3":[{"device_id":"04BA","status":{"calibrated":false}}]})", "", state));
    EXPECT_EQ(state.p_V, Eigen::Vector3d(1, 2, 3));
    EXPECT_FALSE(state.is_calibrated);
    EXPECT_TRUE(state.has_power);
    ASSERT_TRUE(takeMessage(R"({"session_id":7})", "", state));
    EXPECT_TRUE(state.is_there);
    ASSERT_TRUE(takeMessage(R"({"inverse3":[{"device_id":"other"}]})", "", state));
    EXPECT_FALSE(state.is_there) << "the arm that was chosen has gone";
}

TEST(HaplyMessages, TheWantedArmIsTaken) {
    const std::string two = R"({"inverse3":[{"device_id":"a"},{"device_id":"b"}]})";
    HaplyState state;
    takeMessage(two, "b", state);
    EXPECT_EQ(state.device_id, "b");
    HaplyState none;
    takeMessage(two, "c", none);
    EXPECT_FALSE(none.is_there);
}

TEST(HaplyMessages, NonsenseIsRefusedOrHasNoNumbers) {
    HaplyState state;
    for (const char* text : {"", "{", "[]", "null", "3"}) EXPECT_FALSE(takeMessage(text, "", state)) << text;
    for (const char* text :
         {R"({"inverse3":{}})", R"({"inverse3":[1,null,{}]})", R"({"inverse3":[{"device_id":3}]})",
          R"({"verse_grip":"x"})", R"({"inverse3":[{"device_id":"a","state":[],"status":7}]})"})
        EXPECT_TRUE(takeMessage(text, "", state)) << text;
    EXPECT_FALSE(state.p_V);
    takeMessage(R"({"inverse3":[{"device_id":"a","state":{"cursor_position":{"x":"1","y":2}}}]})", "", state);
    ASSERT_TRUE(state.p_V);
    EXPECT_FALSE(state.p_V->allFinite());
}

TEST(HaplyMessages, GripsOfBothKinds) {
    HaplyState wired;
    takeMessage(
        R"({"verse_grip":[{"device_id":"6","state":{"button":true,"orientation":{"w":1,"x":0,"y":0,"z":0}}}]})",
        "", wired);
    EXPECT_TRUE(wired.button_a);
    EXPECT_EQ(wired.R_V->w(), 1);
    HaplyState wireless;
    takeMessage(R"({"wireless_verse_grip":[{"device_id":"7","state":{"buttons":{"a":true,"b":true}}}]})", "",
                wireless);
    EXPECT_TRUE(wireless.button_a && wireless.button_b);
    EXPECT_EQ(json::parse(probeMessage(wireless, {}, false))["wireless_verse_grip"][0]["device_id"], "7");
}

TEST(HaplyMessages, ForcesAreSpelledAsTheVersionWantsThem) {
    HaplyState state;
    state.device_id = "a";
    const auto commandsOf = [](const std::string& text) {
        return json::parse(text)["inverse3"][0]["commands"];
    };
    for (const auto& [version, name] :
         {std::pair{"3.5", "vector"}, {"3.6.2", "vector"}, {"4.0", "vector"}, {"3.4.1", "values"}}) {
        const auto dialect = dialectOf(version);
        ASSERT_TRUE(dialect) << version;
        const json force = commandsOf(forceMessage(state, *dialect, {1, -2, 0.5}))["set_cursor_force"][name];
        EXPECT_EQ(force, (json{{"x", 1.0}, {"y", -2.0}, {"z", 0.5}})) << version;
        EXPECT_EQ(json::parse(probeMessage(state, *dialect, true)).contains("session"),
                  name == std::string("vector"));
        EXPECT_FALSE(json::parse(probeMessage(state, *dialect, false)).contains("session"));
        EXPECT_TRUE(commandsOf(probeMessage(state, *dialect, false)).contains("probe_position"));
    }
    EXPECT_FALSE(dialectOf("new"));
}

}  // namespace
}  // namespace bonemill::bridge
