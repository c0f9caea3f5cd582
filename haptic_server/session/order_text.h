// Says in the log what a client ordered. It is for the publisher thread.
#pragma once

#include <string>

#include "haptic_server/session/repeated_text.h"
#include "proto/topics.pb.h"

namespace bonemill {

// Returns the field and what is in it: "set_accuracy fast", "select_tool 2", "pause_milling false".
inline std::string orderText(const topics::Command& command) {
    using google::protobuf::FieldDescriptor;
    const FieldDescriptor* field =
        topics::Command::descriptor()->FindFieldByNumber(int(command.action_case()));
    if (!field) return "nothing";
    const auto* reflection = command.GetReflection();
    if (field->type() == FieldDescriptor::TYPE_STRING)
        return field->name() + " " + repeatedText(reflection->GetString(command, field));
    if (field->type() == FieldDescriptor::TYPE_UINT32)
        return field->name() + " " + std::to_string(reflection->GetUInt32(command, field));
    return reflection->GetBool(command, field) ? field->name() : field->name() + " false";
}

}  // namespace bonemill
