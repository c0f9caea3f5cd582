// Says in the log who ordered what. It is for the publisher thread.
#pragma once

#include <algorithm>
#include <cinttypes>
#include <cstdio>
#include <string>

#include "common/text/repeated_text.h"
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
    if (field->type() == FieldDescriptor::TYPE_MESSAGE) return field->name();
    return reflection->GetBool(command, field) ? field->name() : field->name() + " false";
}

// Returns "Anna (instructor, proven)", or the sender's number where it has no name.
inline std::string senderText(const topics::Command& command, const std::string& proof) {
    std::string role = topics::Viewer::Role_Name(command.role());
    std::transform(role.begin(), role.end(), role.begin(), [](char c) { return char(c | 0x20); });
    char number[17] = "";
    std::snprintf(number, sizeof number, "%016" PRIx64, command.sender());
    return (command.name().empty() ? number : repeatedText(command.name())) + " (" + role + ", " + proof +
           ")";
}

}  // namespace bonemill
