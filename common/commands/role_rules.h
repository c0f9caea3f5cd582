// Says which role may order what of the server: the only place that decides it (docs/lab/security.md has the
// same table). It is thread-safe and does not allocate.
#pragma once

#include <array>
#include <cstdint>
#include <string_view>

#include "proto/topics.pb.h"

namespace bonemill {

struct RoleRule {
    topics::Command::ActionCase action;
    bool may_operator, may_examiner;  // an instructor may everything, a viewer nothing
};

inline constexpr std::array<RoleRule, 15> kRoleRules{{
    {topics::Command::kResetVolume, true, false},
    {topics::Command::kPauseMilling, true, true},
    {topics::Command::kSetAccuracy, true, false},
    {topics::Command::kSelectTool, true, false},
    {topics::Command::kSaveCheckpoint, true, true},
    {topics::Command::kRestoreCheckpoint, true, false},
    {topics::Command::kExport, true, true},
    {topics::Command::kResetDevice, true, false},
    {topics::Command::kChooseScene, true, true},
    {topics::Command::kStartAttempt, true, true},
    {topics::Command::kStopAttempt, true, true},
    {topics::Command::kAddRemark, true, true},
    {topics::Command::kEraseRemark, true, true},
    {topics::Command::kReplay, true, true},
    {topics::Command::kShutDown, false, false},
}};

// A role that is not known may nothing, and an action that has no rule is an instructor's.
constexpr bool mayOrder(topics::Viewer::Role role, topics::Command::ActionCase action) {
    if (role == topics::Viewer::INSTRUCTOR) return true;
    for (const RoleRule& rule : kRoleRules) {
        if (rule.action != action) continue;
        return (role == topics::Viewer::OPERATOR && rule.may_operator) ||
               (role == topics::Viewer::EXAMINER && rule.may_examiner);
    }
    return false;
}

// Returns "refused: <why>", or nothing if the role may order it.
constexpr std::string_view refusalOfRole(topics::Viewer::Role role, topics::Command::ActionCase action) {
    if (mayOrder(role, action)) return "";
    if (action == topics::Command::kShutDown && role != topics::Viewer::VIEWER)
        return "refused: only an instructor ends the session (docs/lab/security.md)";
    if (role == topics::Viewer::EXAMINER)
        return "refused: an examiner leaves bone, tool and device to operator and instructor "
               "(docs/lab/security.md)";
    if (role == topics::Viewer::OPERATOR)
        return "refused: only an instructor may that (docs/lab/security.md)";
    return "refused: a viewer only looks; an operator may that (docs/lab/security.md)";
}

}  // namespace bonemill
