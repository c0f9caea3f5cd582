// Every command for every role, once more by hand.
#include "common/commands/role_rules.h"

#include <gtest/gtest.h>

#include <map>

namespace bonemill {
namespace {

using Action = topics::Command::ActionCase;
using topics::Viewer;

struct Rights {
    bool viewer, operating, instructor, examiner;
};

const std::map<std::string, Rights> kRights{
    {"reset_volume", {false, true, true, false}},   {"pause_milling", {false, true, true, true}},
    {"set_accuracy", {false, true, true, false}},   {"select_tool", {false, true, true, false}},
    {"save_checkpoint", {false, true, true, true}}, {"restore_checkpoint", {false, true, true, false}},
    {"export", {false, true, true, true}},          {"reset_device", {false, true, true, false}},
    {"choose_scene", {false, true, true, true}},    {"start_attempt", {false, true, true, true}},
    {"stop_attempt", {false, true, true, true}},    {"add_remark", {false, true, true, true}},
    {"erase_remark", {false, true, true, true}},    {"shut_down", {false, false, true, false}},
    {"replay", {false, true, true, true}},
};

TEST(RoleRules, EveryCommandHasARuleForEveryRole) {
    const auto* actions = topics::Command::descriptor()->oneof_decl(0);
    ASSERT_EQ(size_t(actions->field_count()), kRights.size());
    ASSERT_EQ(kRoleRules.size(), kRights.size());
    for (int n = 0; n < actions->field_count(); ++n) {
        const std::string name = actions->field(n)->name();
        const auto action = Action(actions->field(n)->number());
        ASSERT_TRUE(kRights.contains(name)) << name;
        const Rights& rights = kRights.at(name);
        EXPECT_EQ(mayOrder(Viewer::VIEWER, action), rights.viewer) << name;
        EXPECT_EQ(mayOrder(Viewer::OPERATOR, action), rights.operating) << name;
        EXPECT_EQ(mayOrder(Viewer::INSTRUCTOR, action), rights.instructor) << name;
        EXPECT_EQ(mayOrder(Viewer::EXAMINER, action), rights.examiner) << name;
        EXPECT_FALSE(mayOrder(Viewer::Role(9), action)) << name;
    }
}

TEST(RoleRules, ARefusalIsSaidExactlyWhereNothingMayBeDone) {
    for (const RoleRule& rule : kRoleRules) {
        for (const Viewer::Role role :
             {Viewer::VIEWER, Viewer::OPERATOR, Viewer::INSTRUCTOR, Viewer::EXAMINER, Viewer::Role(9)})
            EXPECT_EQ(refusalOfRole(role, rule.action).empty(), mayOrder(role, rule.action));
    }
    EXPECT_FALSE(mayOrder(Viewer::OPERATOR, Action(999))) << "what has no rule is the instructor's";
}

}  // namespace
}  // namespace bonemill
