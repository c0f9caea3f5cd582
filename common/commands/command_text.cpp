#include "common/commands/command_text.h"

#include <algorithm>

#include "common/commands/command_rows.h"
#include "common/config/live_fields.h"
#include "common/text/foreign_text.h"
#include "common/text/hex_text.h"
#include "common/text/printed_text.h"

namespace bonemill {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using topics::CommandForm;

struct Value {
    double number = 0;  // of a text, whether there is any
    std::string text;
};

// Empty for another message.
std::string tunedText(const Message& message) {
    const auto* const tuning = dynamic_cast<const scene::Tuning*>(&message);
    if (!tuning) return "";
    std::string text = tuningText(*tuning);
    std::ranges::replace(text, '\n', ' ');
    return text.empty() ? "as the scene file says" : text;
}

Value valueOf(const Message& message, const FieldDescriptor& field) {
    const auto& r = *message.GetReflection();
    switch (field.cpp_type()) {
        case FieldDescriptor::CPPTYPE_BOOL:
            return {r.GetBool(message, &field) ? 1.0 : 0.0, {}};
        case FieldDescriptor::CPPTYPE_UINT32:
            return {double(r.GetUInt32(message, &field)), {}};
        case FieldDescriptor::CPPTYPE_INT32:
            return {double(r.GetInt32(message, &field)), {}};
        case FieldDescriptor::CPPTYPE_DOUBLE:
            return {r.GetDouble(message, &field), {}};
        case FieldDescriptor::CPPTYPE_STRING: {
            const std::string text = r.GetString(message, &field);
            return {text.empty() ? 0.0 : 1.0, text};
        }
        case FieldDescriptor::CPPTYPE_MESSAGE:
            return {0, tunedText(r.GetMessage(message, &field))};
        default:
            return {};
    }
}

std::string argumentText(const CommandForm& form, const Value& value) {
    switch (form.kind()) {
        case CommandForm::TEXT:
        case CommandForm::SCENE_TEXT:
            return value.text;
        case CommandForm::TOOL:
            return printed("%.0f", value.number + 1);
        case CommandForm::SECONDS:
            return printed("%.2f", value.number);
        case CommandForm::FACTOR:
            return printed("%g", value.number);
        default:
            return printed("%.0f", value.number);
    }
}

std::string withInstead(std::string text, const std::string& mark, const std::string& instead) {
    const size_t at = text.find(mark);
    return at == std::string::npos ? text : text.replace(at, mark.size(), instead);
}

// Returns the words of the first form that fits, with the argument in them; empty if there is none.
std::string wordsOf(const topics::Command& command, const std::string& (CommandForm::*words)() const) {
    for (const CommandForm& form : rowOf(command.action_case()).forms()) {
        const auto [action, inner] = placeOf(command.action_case(), form);
        const Message& message = inner ? command.GetReflection()->GetMessage(command, action)
                                       : static_cast<const Message&>(command);
        const FieldDescriptor& field = inner ? *inner : *action;
        if (field.containing_oneof() && !message.GetReflection()->HasField(message, &field)) continue;
        const Value value = valueOf(message, field);
        if (!form.has_value() || value.number == form.value())
            return withInstead((form.*words)(), "{}", argumentText(form, value));
    }
    return "";
}

}  // namespace

std::string commandText(const topics::Command& command) {
    const std::string text = wordsOf(command, &CommandForm::order);
    if (!text.empty()) return text;
    const FieldDescriptor* field = fieldOf(command.action_case());
    return field ? field->name() : "no action";
}

std::string doneText(const topics::Command& command, const std::string& trainee) {
    const std::string text = wordsOf(command, &CommandForm::done);
    if (text.empty()) return CommandForm().done();
    return withInstead(text, "{trainee's}", trainee.empty() ? "The" : trainee + "'s");
}

std::string orderText(const topics::Command& command) {
    const FieldDescriptor* field = fieldOf(command.action_case());
    if (!field) return "nothing";
    const auto* reflection = command.GetReflection();
    if (field->type() == FieldDescriptor::TYPE_STRING)
        return field->name() + " " + repeatedText(reflection->GetString(command, field));
    if (field->type() == FieldDescriptor::TYPE_UINT32)
        return field->name() + " " + std::to_string(reflection->GetUInt32(command, field));
    if (command.has_tune()) return field->name() + " " + tunedText(command.tune());
    if (field->type() == FieldDescriptor::TYPE_MESSAGE) return field->name();
    return reflection->GetBool(command, field) ? field->name() : field->name() + " false";
}

std::string senderText(const topics::Command& command, const std::string& proof) {
    std::string role = topics::Viewer::Role_Name(command.role());
    std::transform(role.begin(), role.end(), role.begin(), [](char c) { return char(c | 0x20); });
    const std::string who = command.name().empty() ? hexText(command.sender()) : repeatedText(command.name());
    return who + " (" + role + ", " + proof + ")";
}

}  // namespace bonemill
