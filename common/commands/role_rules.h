// Says which role may order what of the server, by the rows of command_rows.h: the only place that decides it
// (docs/lab/security.md has the same table). It is thread-safe.
#pragma once

#include <string>

#include "common/commands/command_rows.h"

namespace bonemill {

// A session may be led by instructors alone.
enum class OpenTo { kAllRoles, kInstructors, kInstructorsInExam };

// A role that is not known may nothing, and an action without a row is an instructor's.
bool mayOrder(topics::Viewer::Role role, CommandAction action, OpenTo open_to = OpenTo::kAllRoles);

// Says why the role may not order it; empty if it may.
std::string whyNotOrder(topics::Viewer::Role role, CommandAction action, OpenTo open_to = OpenTo::kAllRoles);

// Returns true for those who may order anything at all.
bool mayOrderAnything(topics::Viewer::Role role);

// Whose mouse may hold the tool, and who points: no commands, but matters of the role as well.
inline bool mayHoldTool(topics::Viewer::Role role) {
    return mayOrder(role, topics::Command::kSelectTool);
}
inline bool mayPoint(topics::Viewer::Role role) {
    return role == topics::Viewer::INSTRUCTOR;
}

}  // namespace bonemill
