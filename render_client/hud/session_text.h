// How the session is put into words, the same in the figures, the panel and the log. Pure functions, any
// thread.
#pragma once

#include <string>

#include "proto/topics.pb.h"

namespace bonemill {

// "?" for a role that this version does not know.
std::string roleName(topics::Viewer::Role role);

// The name of a watcher; something to read also when there is none.
std::string watcherName(const std::string& name);

// What a list of watchers says of one: "operator, 60 Hz", "viewer, 12 Hz, incomplete".
std::string watcherText(topics::Viewer::Role role, double frame_rate_hz, bool is_complete);

// A time of the session (s) as h:mm:ss, whole seconds; a dash for what is no time. Bounded at 1e9 s.
std::string clockText(double seconds);

}  // namespace bonemill
