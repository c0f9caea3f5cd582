#include "common/commands/command_rows.h"

namespace bonemill {

using google::protobuf::FieldDescriptor;

const FieldDescriptor* fieldOf(CommandAction action) {
    const FieldDescriptor* field = topics::Command::descriptor()->FindFieldByNumber(int(action));
    return field && field->containing_oneof() ? field : nullptr;
}

const topics::CommandRow& rowOf(CommandAction action) {
    const FieldDescriptor* field = fieldOf(action);
    return field ? field->options().GetExtension(topics::row) : topics::CommandRow::default_instance();
}

void forEachCommand(const std::function<void(CommandAction, const topics::CommandRow&)>& see) {
    const auto& actions = *topics::Command::descriptor()->FindOneofByName("action");
    for (int n = 0; n < actions.field_count(); ++n)
        see(CommandAction(actions.field(n)->number()), actions.field(n)->options().GetExtension(topics::row));
}

CommandPlace placeOf(CommandAction action, const topics::CommandForm& form) {
    const FieldDescriptor* field = fieldOf(action);
    return {field, form.has_field() ? field->message_type()->FindFieldByName(form.field()) : nullptr};
}

}  // namespace bonemill
