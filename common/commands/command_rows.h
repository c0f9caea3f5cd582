// What is to be known of each command besides what it does: the option (row) of its action in
// proto/topics_commands.proto, which proto/topics_command_rows.proto explains. Thread-safe.
#pragma once

#include <google/protobuf/descriptor.h>

#include <functional>

#include "proto/topics.pb.h"

namespace bonemill {

using CommandAction = topics::Command::ActionCase;

// Null for an action that this program does not know.
const google::protobuf::FieldDescriptor* fieldOf(CommandAction action);

// An action that is not known has an empty row: it is an instructor's, without limit, and not typed.
const topics::CommandRow& rowOf(CommandAction action);

// In the order of proto/topics_commands.proto.
void forEachCommand(const std::function<void(CommandAction, const topics::CommandRow&)>& see);

// Where a form's argument is: in the command itself, or one message deeper.
struct CommandPlace {
    const google::protobuf::FieldDescriptor* action;
    const google::protobuf::FieldDescriptor* field;  // of a message within the action, or null
};
CommandPlace placeOf(CommandAction action, const topics::CommandForm& form);

}  // namespace bonemill
