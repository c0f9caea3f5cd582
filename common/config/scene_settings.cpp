#include "common/config/scene_settings.h"

#include <google/protobuf/stubs/logging.h>
#include <google/protobuf/text_format.h>

#include <regex>
#include <vector>

#include "common/base/user_error.h"
#include "common/config/scene_text.h"

namespace bonemill {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using google::protobuf::TextFormat;

// A field on the way to the one that is set.
struct Step {
    std::string name;
    int index = -1;  // -1: no element of a list was named
};

std::vector<Step> stepsOf(const std::string& path, const std::string& refusal) {
    static const std::regex kStep("([A-Za-z_][A-Za-z0-9_]*)(?:\\[([0-9]{1,4})\\])?");
    std::vector<Step> steps;
    for (size_t at = 0; at <= path.size();) {
        const size_t end = std::min(path.find('.', at), path.size());
        const std::string word = path.substr(at, end - at);
        std::smatch parts;
        if (!std::regex_match(word, parts, kStep))
            throw UserError(refusal + "give PATH=VALUE, as coupling.max_speed_mm_per_s=80");
        steps.push_back({parts[1], parts[2].matched ? std::stoi(parts[2]) : -1});
        at = end + 1;
    }
    return steps;
}

const FieldDescriptor& fieldOf(const Message& message, const Step& step, const std::string& refusal) {
    const FieldDescriptor* const field = message.GetDescriptor()->FindFieldByName(step.name);
    if (!field) throw UserError(refusal + unknownFieldText(*message.GetDescriptor(), step.name));
    if (field->is_repeated() != (step.index >= 0))
        throw UserError(refusal + "`" + step.name + "` is " +
                        (field->is_repeated() ? "a list: say which, as " + step.name + "[0]" : "no list"));
    return *field;
}

Message& enter(Message& message, const FieldDescriptor& field, const Step& step, const std::string& refusal) {
    if (field.cpp_type() != FieldDescriptor::CPPTYPE_MESSAGE)
        throw UserError(refusal + "`" + step.name + "` has no fields of its own");
    const auto& reflection = *message.GetReflection();
    if (!field.is_repeated()) return *reflection.MutableMessage(&message, &field);
    const int count = reflection.FieldSize(message, &field);
    if (step.index > count)
        throw UserError(refusal + "there are " + std::to_string(count) + " of `" + step.name + "`");
    return step.index == count ? *reflection.AddMessage(&message, &field)
                               : *reflection.MutableRepeatedMessage(&message, &field, step.index);
}

bool isText(const FieldDescriptor& field) {
    return field.cpp_type() == FieldDescriptor::CPPTYPE_STRING;
}

std::string quotedText(const std::string& value) {
    const bool is_quoted = value.size() >= 2 && value.front() == '"' && value.back() == '"';
    if (is_quoted) return value;
    std::string text = "\"";
    for (const char c : value) text += c == '"' || c == '\\' ? std::string{'\\', c} : std::string{c};
    return text + "\"";
}

// A message is there by {}, with its defaults, and gone by nothing at all.
void setMessage(Message& message, const FieldDescriptor& field, const std::string& value,
                const std::string& refusal) {
    const auto& reflection = *message.GetReflection();
    if (!value.empty() && value != "{}")
        throw UserError(refusal + "`" + field.name() + "` takes no " + value +
                        "; set its fields, or {} to have it, or nothing to be without it");
    if (value.empty() && !reflection.HasField(message, &field))
        throw UserError(refusal + "the scene has no `" + field.name() + "` to take away");
    reflection.ClearField(&message, &field);
    if (!value.empty()) reflection.MutableMessage(&message, &field);
}

}  // namespace

void setField(scene::Scene& scene, const std::string& assignment) {
    const google::protobuf::LogSilencer silencer;  // what is wrong is said once, and by us
    const std::string refusal = "--set " + assignment + ": ";
    const size_t equals = assignment.find('=');
    if (equals == std::string::npos)
        throw UserError(refusal + "give PATH=VALUE, as coupling.max_speed_mm_per_s=80");
    const std::vector<Step> steps = stepsOf(assignment.substr(0, equals), refusal);
    Message* message = &scene;
    for (size_t n = 0; n + 1 < steps.size(); ++n)
        message = &enter(*message, fieldOf(*message, steps[n], refusal), steps[n], refusal);
    const FieldDescriptor& field = fieldOf(*message, steps.back(), refusal);
    if (field.is_repeated())
        throw UserError(refusal + "elements of `" + steps.back().name + "` are set field by field");
    const std::string value = assignment.substr(equals + 1);
    if (field.message_type()) return setMessage(*message, field, value, refusal);
    message->GetReflection()->ClearField(message, &field);
    if (!TextFormat::ParseFieldValueFromString(isText(field) ? quotedText(value) : value, &field, message))
        throw UserError(refusal + "`" + field.name() + "` takes no " +
                        (value.empty() ? "empty value" : value));
}

}  // namespace bonemill
