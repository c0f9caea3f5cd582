// Reads a Scene message from its text format, with the line that every field stands on.
#pragma once

#include <map>
#include <string>

#include "proto/scene.pb.h"

namespace bonemill {

// The path of a field ("coupling.max_speed_mm_per_s", "simulated_operator.waypoint[3].q_WT") leads to its
// line, counted from 1.
using FieldLines = std::map<std::string, int>;

struct ParsedScene {
    scene::Scene scene;
    FieldLines lines;  // of the fields that the text sets
};

// `name` is the file's name for messages. Throws UserError "name:line: ..." for bad syntax and for unknown
// fields (with the nearest known name). Ranges are not looked at. It is for start-up only.
ParsedScene parseSceneText(const std::string& text, const std::string& name);

// "unknown field `x` in Type", with the nearest name or all that are known.
std::string unknownFieldText(const google::protobuf::Descriptor& type, const std::string& name);

// It is "name:line: " with the line of the field or of the nearest enclosing one, and "name: " when the
// text has neither.
std::string placeOf(const std::string& name, const FieldLines& lines, std::string field_path);

}  // namespace bonemill
