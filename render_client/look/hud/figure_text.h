// The figures over the picture show numbers, names and the session so. The functions are pure; any thread may
// call them.
#pragma once

#include <span>
#include <string>
#include <vector>

#include "proto/topics.pb.h"

namespace bonemill {

// This dash stands for a value that is no number.
inline constexpr char kNoNumber[] = "\u2013";

// Returns the number with N decimals, and its unit.
std::string figureText(double value, int decimals, const char* unit);
// Returns the number with three significant digits or so, whatever its size, and its unit.
std::string readableText(double value, const char* unit);
// Returns the length of a vector of three numbers, times `scale`, in the same form; a dash for what is no
// vector.
std::string lengthText(std::span<const double> v, double scale, const char* unit);
// Returns at most N signs (UTF-8), the last one an ellipsis if some are left out.
std::string shortenedText(const std::string& text, size_t most);
// How many characters a row has room for.
inline constexpr size_t kLongestRow = 26;
// Returns lines of at most `most` bytes, cut at spaces; a longer word stays whole.
std::vector<std::string> wrappedText(const std::string& text, size_t most);

// Puts the session into words, the same in the figures, the panel and the log.
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
