#include "common/commands/role_rules.h"

#include "common/base/units.h"

namespace bonemill {
namespace {

using topics::Viewer;

// The action as which this one counts.
CommandAction countedAs(CommandAction action) {
    const topics::CommandRow& row = rowOf(action);
    if (!row.has_limit_of()) return action;
    return CommandAction(topics::Command::descriptor()->FindFieldByName(row.limit_of())->number());
}

}  // namespace

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
        return "only an instructor ends the session (docs/howto/security.md)";
    if (role == Viewer::EXAMINER)
        return "an examiner leaves bone, tool and device to operator and instructor (docs/howto/security.md)";
    if (role == Viewer::OPERATOR) return "only an instructor may that (docs/howto/security.md)";
    return "a viewer only looks; to do this, join again as operator (docs/howto/security.md)";
}

bool mayOrderAnything(Viewer::Role role) {
    bool may = false;
    forEachCommand([&](CommandAction action, const topics::CommandRow&) { may |= mayOrder(role, action); });
    return may;
}

OrderLimits::OrderLimits() {
    forEachCommand([this](CommandAction action, const topics::CommandRow& row) {
        if (row.has_limit())
            limits_.emplace(action, LogLimit(row.limit().at_once(), row.limit().every_s() * kNsPerSecond));
    });
}

std::string OrderLimits::whyNotNow(CommandAction action, int64_t now_ns) {
    const auto limit = limits_.find(countedAs(action));
    if (limit == limits_.end() || limit->second.ask(now_ns) >= 0) return "";
    return "that was too often: it works once in " + std::to_string(rowOf(limit->first).limit().every_s()) +
           " s; wait, then try again";
}

}  // namespace bonemill
