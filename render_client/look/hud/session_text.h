// Puts the session into words, the same in the figures, the panel and the log. The functions are pure; any
// thread may call them.
#pragma once

#include <string>

#include "proto/topics.pb.h"

namespace bonemill {

inline constexpr topics::Viewer::Role kRoles[] = {topics::Viewer::VIEWER, topics::Viewer::OPERATOR,
                                                  topics::Viewer::INSTRUCTOR, topics::Viewer::EXAMINER};
// A role that this version does not know is "?".
std::string roleName(topics::Viewer::Role role);

// Returns the name of a watcher, or something to read when there is none.
std::string watcherName(const std::string& name);

// Returns what a list of watchers says of one: "operator, 60 Hz", "viewer by browser, 12 Hz, incomplete".
std::string watcherText(const topics::Viewer& watcher);

// Returns a time of the session (s) as h:mm:ss in whole seconds, at most 1e9 s; a dash for what is no time.
std::string clockText(double seconds);

}  // namespace bonemill
