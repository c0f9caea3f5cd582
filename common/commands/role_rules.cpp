#include "common/commands/role_rules.h"

namespace bonemill {

using topics::Viewer;

bool mayOrder(Viewer::Role role, CommandAction action, OpenTo open_to) {
    if (role == Viewer::INSTRUCTOR) return true;
    if (open_to != OpenTo::kAllRoles) return false;
    const topics::CommandRow& row = rowOf(action);
    return (role == Viewer::OPERATOR && row.may_operator()) ||
           (role == Viewer::EXAMINER && row.may_examiner());
}

std::string whyNotOrder(Viewer::Role role, CommandAction action, OpenTo open_to) {
    if (mayOrder(role, action, open_to)) return "";
    if (open_to == OpenTo::kInstructorsInExam)
        return "this scene is an examination; only instructors command it";
    if (open_to == OpenTo::kInstructors) return "only instructors command this session (--instructor-only)";
    if (action == topics::Command::kShutDown && role != Viewer::VIEWER)
        return "only an instructor ends the session (docs/lab/security.md)";
    if (role == Viewer::EXAMINER)
        return "an examiner leaves bone, tool and device to operator and instructor (docs/lab/security.md)";
    if (role == Viewer::OPERATOR) return "only an instructor may that (docs/lab/security.md)";
    return "a viewer only looks; an operator may that (docs/lab/security.md)";
}

bool mayOrderAnything(Viewer::Role role) {
    bool may = false;
    forEachCommand([&](CommandAction action, const topics::CommandRow&) { may |= mayOrder(role, action); });
    return may;
}

}  // namespace bonemill
