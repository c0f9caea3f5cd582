#include "render_client/subscribe/command_words.h"

#include <algorithm>
#include <charconv>
#include <optional>
#include <vector>

#include "common/config/scene_tools.h"
#include "common/user_error.h"

namespace bonemill {
namespace {

constexpr const char* kKnown =
    "reset, pause, resume, tool NAME-or-number, checkpoint, restore NUMBER-or-last, accuracy NAME, export "
    "NAME, shutdown";

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

bool isOneOf(const std::string& word, std::initializer_list<const char*> words) {
    return std::find(words.begin(), words.end(), word) != words.end();
}

std::optional<uint32_t> numberOf(const std::string& text) {
    uint32_t number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    return error == std::errc() && end == text.data() + text.size() ? std::optional(number) : std::nullopt;
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

}  // namespace

std::string commandProblem(const std::string& text) {
    const auto [action, argument] = split(text);
    const bool needs_argument = isOneOf(action, {"tool", "restore", "accuracy", "export"});
    if (!needs_argument && !isOneOf(action, {"reset", "pause", "resume", "checkpoint", "shutdown"}))
        return "'" + text + "' is no command; there are: " + kKnown;
    if (needs_argument && argument.empty()) return "'" + text + "' says not which; there are: " + kKnown;
    if (!needs_argument && !argument.empty()) return "'" + action + "' takes no '" + argument + "'";
    if (action == "restore" && argument != "last" && !numberOf(argument))
        return "'" + argument + "' is no checkpoint's number, nor last";
    return "";
}

topics::Command commandOf(const std::string& text, const topics::SceneInfo& scene,
                          const topics::Status& status) {
    if (const std::string problem = commandProblem(text); !problem.empty()) throw UserError(problem);
    const auto [action, argument] = split(text);
    topics::Command command;
    if (action == "reset") command.set_reset_volume(true);
    if (isOneOf(action, {"pause", "resume"})) command.set_pause_milling(action == "pause");
    if (action == "tool") command.set_select_tool(toolOf(argument, scene));
    if (action == "checkpoint") command.set_save_checkpoint(true);
    if (action == "restore") command.set_restore_checkpoint(checkpointOf(argument, status));
    if (action == "accuracy") command.set_set_accuracy(argument);
    if (action == "export") command.set_export_(argument);
    if (action == "shutdown") command.set_shut_down(true);
    return command;
}

}  // namespace bonemill
