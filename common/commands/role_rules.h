// Says which role may order what of the server, and how often, by the rows of command_rows.h: the only place
// that decides it (docs/howto/security.md has the same table). It is thread-safe.
#pragma once

#include <cstdint>
#include <map>
#include <string>

#include "common/commands/command_rows.h"
#include "common/log/log.h"

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

// Bounds how often a server does what costs its tick, its disk or everyone's network, whoever asks: the limit
// of each row. It lives as long as the process; the publisher thread asks.
class OrderLimits {
  public:
    OrderLimits();

    // Says why the order may not be carried out now; empty if it may.
    std::string whyNotNow(CommandAction action, int64_t now_ns);

  private:
    std::map<CommandAction, LogLimit> limits_;  // of those that have one of their own
};

}  // namespace bonemill
