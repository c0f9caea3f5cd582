#include "render_client/link/subscribe/command_words.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <optional>
#include <sstream>
#include <vector>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/commands/command_rows.h"
#include "common/config/live_fields.h"
#include "common/config/scene_tools.h"

namespace bonemill {
namespace {

using google::protobuf::FieldDescriptor;
using google::protobuf::Message;
using topics::CommandForm;

struct Words {
    std::string action, argument;  // the rest of the text: a tool's name may be several words
};

Words split(const std::string& text) {
    const size_t from = text.find_first_not_of(' ');
    if (from == std::string::npos) return {};
    const size_t to = text.find_last_not_of(' ') + 1;
    const size_t end = std::min(text.find(' ', from), to);
    const size_t rest = std::min(text.find_first_not_of(' ', end), to);
    return {text.substr(from, end - from), text.substr(rest, to - rest)};
}

std::optional<uint32_t> numberOf(const std::string& text) {
    uint32_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc() && end == text.data() + text.size() ? std::optional(number) : std::nullopt;
}

std::optional<double> realOf(const std::string& text) {
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    const bool is_number = error == std::errc() && end == text.data() + text.size();
    return is_number && std::isfinite(number) ? std::optional(number) : std::nullopt;
}

// "X Y Z" in mm; without a number each, nothing.
std::optional<std::array<double, 3>> placeOf(const std::string& text) {
    std::istringstream words(text);
    std::array<double, 3> place{};
    std::string word;
    for (double& part : place) {
        const auto number = words >> word ? realOf(word) : std::nullopt;
        if (!number) return std::nullopt;
        part = *number * kMillimetre;
    }
    return words >> word ? std::nullopt : std::optional(place);
}

// "scene" is the scene's own, in which nothing is tuned.
std::optional<scene::Tuning> tunedBy(const std::string& text) {
    return text == "scene" ? scene::Tuning() : tuningOfText(text);
}

uint32_t toolOf(const std::string& name, const topics::SceneInfo& scene) {
    const std::vector<std::string> names(scene.tool_names().begin(), scene.tool_names().end());
    return uint32_t(toolIndexOf(names, name));
}

uint32_t checkpointOf(const std::string& text, const topics::Status& status) {
    if (text != "last") return *numberOf(text);
    if (status.checkpoints().empty()) throw UserError("the session has no checkpoint to go back to");
    return status.checkpoints().rbegin()->id();
}

struct Session {
    const topics::SceneInfo& scene;
    const topics::Status& status;
};

struct KnownWord {
    CommandAction action = topics::Command::ACTION_NOT_SET;
    const CommandForm* form = nullptr;
};

KnownWord find(const std::string& word) {
    KnownWord found;
    forEachCommand([&](CommandAction action, const topics::CommandRow& row) {
        for (const CommandForm& form : row.forms())
            if (form.has_word() && form.word() == word) found = {action, &form};
    });
    return found;
}

std::string knownCommands() {
    std::string text;
    for (const std::string& words : commandWords()) text += (text.empty() ? "" : ", ") + words;
    return text;
}

// Why the argument is none of its kind, as far as can be said without a session.
std::string argumentProblem(CommandForm::Kind kind, const std::string& argument) {
    switch (kind) {
        case CommandForm::CHECKPOINT:
            return argument == "last" || numberOf(argument) ? "" : "no checkpoint's number, nor last";
        case CommandForm::REMARK:
            return argument == "all" || numberOf(argument).value_or(0) > 0
                       ? ""
                       : "no number of a note or stroke, nor all";
        case CommandForm::SECONDS:
            return realOf(argument) ? "" : "no number of seconds";
        case CommandForm::FACTOR:
            return realOf(argument) ? "" : "no number of times";
        case CommandForm::PLACE:
            return placeOf(argument) ? "" : "no place: three numbers, in mm";
        case CommandForm::SCENE_TEXT:
            return tunedBy(argument) ? "" : "no part of a scene file that can be tuned, nor scene";
        default:
            return "";
    }
}

uint32_t indexOf(CommandForm::Kind kind, const std::string& argument, const Session& session) {
    if (kind == CommandForm::TOOL) return toolOf(argument, session.scene);
    if (kind == CommandForm::CHECKPOINT) return checkpointOf(argument, session.status);
    return argument == "all" ? 0 : *numberOf(argument);
}

void setPlace(topics::Place& place, const std::string& argument) {
    const std::array<double, 3> p_m = placeOf(argument).value();
    for (const double part : p_m) place.add_p_m(part);
}

// Sets what the word means in the field that its form names.
void mean(Message& message, const FieldDescriptor& field, const CommandForm& form,
          const std::string& argument, const Session& session) {
    const auto& r = *message.GetReflection();
    switch (field.cpp_type()) {
        case FieldDescriptor::CPPTYPE_BOOL:
            return r.SetBool(&message, &field, !form.has_value() || form.value() != 0);
        case FieldDescriptor::CPPTYPE_INT32:
            return r.SetInt32(&message, &field, form.value());
        case FieldDescriptor::CPPTYPE_UINT32:
            return r.SetUInt32(&message, &field, indexOf(form.kind(), argument, session));
        case FieldDescriptor::CPPTYPE_DOUBLE:
            return r.SetDouble(&message, &field, *realOf(argument));
        case FieldDescriptor::CPPTYPE_STRING:
            return r.SetString(&message, &field, argument);
        default:
            if (form.kind() == CommandForm::SCENE_TEXT)
                return r.MutableMessage(&message, &field)->CopyFrom(tunedBy(argument).value());
            return setPlace(dynamic_cast<topics::Place&>(*r.MutableMessage(&message, &field)), argument);
    }
}

}  // namespace

std::vector<std::string> commandWords() {
    std::vector<std::string> words;
    forEachCommand([&](CommandAction, const topics::CommandRow& row) {
        for (const CommandForm& form : row.forms())
            if (form.has_word())
                words.push_back(form.word() + (form.has_argument() ? " " + form.argument() : ""));
    });
    return words;
}

std::string commandProblem(const std::string& text) {
    constexpr size_t kLongest = 1024;  // a server drops what has more than 4 KiB without an answer
    if (text.size() > kLongest)
        return "a command of " + std::to_string(text.size()) + " letters is too long; " +
               std::to_string(kLongest) + " at most";
    const auto [word, argument] = split(text);
    const CommandForm* const form = find(word).form;
    if (!form) return "'" + text + "' is no command; there are: " + knownCommands();
    if (form->has_argument() && argument.empty())
        return "'" + text + "' says not which; there are: " + knownCommands();
    if (!form->has_argument() && !argument.empty()) return "'" + word + "' takes no '" + argument + "'";
    const std::string problem = argumentProblem(form->kind(), argument);
    return problem.empty() ? "" : "'" + argument + "' is " + problem;
}

topics::Command commandOf(const std::string& text, const topics::SceneInfo& scene,
                          const topics::Status& status) {
    if (const std::string problem = commandProblem(text); !problem.empty()) throw UserError(problem);
    const auto [word, argument] = split(text);
    const auto [known, form] = find(word);
    const auto [action, inner] = placeOf(known, *form);
    topics::Command command;
    Message& message = inner ? *command.GetReflection()->MutableMessage(&command, action) : command;
    mean(message, inner ? *inner : *action, *form, argument, {scene, status});
    return command;
}

}  // namespace bonemill
