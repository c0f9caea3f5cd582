#include "common/commands/role_rules.h"

#include <gtest/gtest.h>

namespace bonemill {
namespace {

using topics::Command;
using topics::Viewer;

constexpr Viewer::Role kRoles[] = {Viewer::VIEWER, Viewer::OPERATOR, Viewer::INSTRUCTOR, Viewer::EXAMINER,
                                   Viewer::Role(9)};
// What changes the bone, the tool or the device.
constexpr CommandAction kOfTheHand[] = {
    Command::kResetVolume, Command::kRestoreCheckpoint, Command::kSetAccuracy, Command::kSelectTool,
    Command::kResetDevice, Command::kBeginAgain,        Command::kTakeOver};

TEST(RoleRules, InstructorsMayEverythingAndObserversAndUnknownRolesNothing) {
    forEachCommand([](CommandAction action, const topics::CommandRow&) {
        EXPECT_TRUE(mayOrder(Viewer::INSTRUCTOR, action)) << fieldOf(action)->name();
        EXPECT_FALSE(mayOrder(Viewer::VIEWER, action)) << fieldOf(action)->name();
        EXPECT_FALSE(mayOrder(Viewer::Role(9), action)) << fieldOf(action)->name();
    });
    EXPECT_TRUE(mayOrderAnything(Viewer::INSTRUCTOR));
    EXPECT_FALSE(mayOrderAnything(Viewer::VIEWER));
    EXPECT_FALSE(mayOrderAnything(Viewer::Role(9)));
}

TEST(RoleRules, ExaminersLeaveTheHandAloneAndOperatorsDoAllButTuneAndEndTheSession) {
    for (const CommandAction action : kOfTheHand) {
        EXPECT_FALSE(mayOrder(Viewer::EXAMINER, action)) << fieldOf(action)->name();
        EXPECT_TRUE(mayOrder(Viewer::OPERATOR, action)) << fieldOf(action)->name();
    }
    forEachCommand([](CommandAction action, const topics::CommandRow&) {
        EXPECT_EQ(mayOrder(Viewer::OPERATOR, action),
                  action != Command::kShutDown && action != Command::kTune)
            << fieldOf(action)->name();
        EXPECT_TRUE(!mayOrder(Viewer::EXAMINER, action) || mayOrder(Viewer::OPERATOR, action));
    });
    EXPECT_FALSE(mayOrder(Viewer::EXAMINER, Command::kShutDown));
    EXPECT_TRUE(mayOrder(Viewer::EXAMINER, Command::kStartAttempt));
    EXPECT_TRUE(mayHoldTool(Viewer::OPERATOR));
    EXPECT_FALSE(mayHoldTool(Viewer::EXAMINER));
    EXPECT_FALSE(mayPoint(Viewer::OPERATOR));
}

TEST(RoleRules, WhatHasNoRowIsTheInstructors) {
    EXPECT_TRUE(mayOrder(Viewer::INSTRUCTOR, CommandAction(999)));
    EXPECT_FALSE(mayOrder(Viewer::OPERATOR, CommandAction(999)));
}

TEST(RoleRules, OnlyInstructorsMayWhereTheSessionOrAnExamSaysSo) {
    for (const OpenTo open_to : {OpenTo::kInstructors, OpenTo::kInstructorsInExam})
        for (const Viewer::Role role : kRoles)
            EXPECT_EQ(mayOrder(role, Command::kPauseMilling, open_to), role == Viewer::INSTRUCTOR) << role;
}

// The words must fit what is refused, not only be there.
TEST(RoleRules, ARefusalNamesWhoMayInstead) {
    const auto says = [](Viewer::Role role, CommandAction action, const char* words,
                         OpenTo open_to = OpenTo::kAllRoles) {
        return whyNotOrder(role, action, open_to).find(words) != std::string::npos;
    };
    EXPECT_TRUE(says(Viewer::VIEWER, Command::kShutDown, "a viewer only looks"));
    EXPECT_TRUE(says(Viewer::OPERATOR, Command::kShutDown, "only an instructor ends the session"));
    EXPECT_TRUE(says(Viewer::EXAMINER, Command::kShutDown, "only an instructor ends the session"));
    EXPECT_TRUE(says(Viewer::EXAMINER, Command::kSelectTool, "an examiner leaves bone, tool and device"));
    EXPECT_TRUE(says(Viewer::OPERATOR, CommandAction(999), "only an instructor may that"));
    EXPECT_TRUE(says(Viewer::OPERATOR, Command::kPauseMilling, "an examination", OpenTo::kInstructorsInExam));
    EXPECT_TRUE(says(Viewer::VIEWER, Command::kPauseMilling, "--instructor-only", OpenTo::kInstructors));
    EXPECT_EQ(whyNotOrder(Viewer::OPERATOR, Command::kPauseMilling), "");
    EXPECT_EQ(whyNotOrder(Viewer::INSTRUCTOR, Command::kShutDown, OpenTo::kInstructorsInExam), "");
}

}  // namespace
}  // namespace bonemill
