#include "render_client/link/subscribe/command_words.h"

#include <algorithm>
#include <array>
#include <charconv>
#include <cmath>
#include <iterator>
#include <optional>
#include <sstream>
#include <vector>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/config/scene_tools.h"

namespace bonemill {
namespace {

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

// A command's word, what follows it ("" when nothing does), and what it means.
struct CommandWord {
    const char* word;
    const char* argument;
    void (*mean)(topics::Command& command, const std::string& argument, const Session& session);
};

using topics::Command;
constexpr CommandWord kWords[] = {
    {"reset", "", [](Command& c, const std::string&, const Session&) { c.set_reset_volume(true); }},
    {"pause", "", [](Command& c, const std::string&, const Session&) { c.set_pause_milling(true); }},
    {"resume", "", [](Command& c, const std::string&, const Session&) { c.set_pause_milling(false); }},
    {"tool", "NAME-or-number",
     [](Command& c, const std::string& name, const Session& s) { c.set_select_tool(toolOf(name, s.scene)); }},
    {"checkpoint", "", [](Command& c, const std::string&, const Session&) { c.set_save_checkpoint(true); }},
    {"restore", "NUMBER-or-last",
     [](Command& c, const std::string& which, const Session& s) {
         c.set_restore_checkpoint(checkpointOf(which, s.status));
     }},
    {"accuracy", "NAME",
     [](Command& c, const std::string& name, const Session&) { c.set_set_accuracy(name); }},
    {"export", "NAME", [](Command& c, const std::string& name, const Session&) { c.set_export_(name); }},
    {"reset-device", "", [](Command& c, const std::string&, const Session&) { c.set_reset_device(true); }},
    {"scene", "ID", [](Command& c, const std::string& id, const Session&) { c.set_choose_scene(id); }},
    {"start", "TRAINEE",
     [](Command& c, const std::string& trainee, const Session&) { c.set_start_attempt(trainee); }},
    {"stop", "", [](Command& c, const std::string&, const Session&) { c.set_stop_attempt(true); }},
    {"note", "TEXT",
     [](Command& c, const std::string& text, const Session&) { c.mutable_add_remark()->set_note(text); }},
    {"erase", "NUMBER-or-all",
     [](Command& c, const std::string& which, const Session&) {
         c.set_erase_remark(which == "all" ? 0 : *numberOf(which));
     }},
    {"seek", "SECONDS",
     [](Command& c, const std::string& when, const Session&) {
         c.mutable_replay()->set_seek_s(*realOf(when));
     }},
    {"speed", "FACTOR",
     [](Command& c, const std::string& speed, const Session&) {
         c.mutable_replay()->set_speed(*realOf(speed));
     }},
    {"next", "", [](Command& c, const std::string&, const Session&) { c.mutable_replay()->set_jump(1); }},
    {"previous", "",
     [](Command& c, const std::string&, const Session&) { c.mutable_replay()->set_jump(-1); }},
    {"when", "X Y Z",
     [](Command& c, const std::string& place, const Session&) {
         const std::array<double, 3> p_m = placeOf(place).value();
         for (const double part : p_m) c.mutable_replay()->mutable_removal_at()->add_p_m(part);
     }},
    {"shutdown", "", [](Command& c, const std::string&, const Session&) { c.set_shut_down(true); }},
};

const CommandWord* find(const std::string& word) {
    const auto found = std::find_if(std::begin(kWords), std::end(kWords),
                                    [&](const CommandWord& known) { return known.word == word; });
    return found == std::end(kWords) ? nullptr : found;
}

std::string knownCommands() {
    std::string text;
    for (const CommandWord& known : kWords) {
        text += text.empty() ? "" : ", ";
        text += known.word;
        if (*known.argument) text += std::string(" ") + known.argument;
    }
    return text;
}

}  // namespace

std::string commandProblem(const std::string& text) {
    constexpr size_t kLongest = 1024;  // a server drops what has more than 4 KiB without an answer
    if (text.size() > kLongest)
        return "a command of " + std::to_string(text.size()) + " letters is too long; " +
               std::to_string(kLongest) + " at most";
    const auto [action, argument] = split(text);
    const CommandWord* const known = find(action);
    if (!known) return "'" + text + "' is no command; there are: " + knownCommands();
    const bool needs_argument = *known->argument != 0;
    if (needs_argument && argument.empty())
        return "'" + text + "' says not which; there are: " + knownCommands();
    if (!needs_argument && !argument.empty()) return "'" + action + "' takes no '" + argument + "'";
    if (action == "restore" && argument != "last" && !numberOf(argument))
        return "'" + argument + "' is no checkpoint's number, nor last";
    if (action == "erase" && argument != "all" && numberOf(argument).value_or(0) == 0)
        return "'" + argument + "' is no number of a note or stroke, nor all";
    if ((action == "seek" || action == "speed") && !realOf(argument))
        return "'" + argument + "' is no number of " + (action == "seek" ? "seconds" : "times");
    if (action == "when" && !placeOf(argument)) return "'" + argument + "' is no place: three numbers, in mm";
    return "";
}

topics::Command commandOf(const std::string& text, const topics::SceneInfo& scene,
                          const topics::Status& status) {
    if (const std::string problem = commandProblem(text); !problem.empty()) throw UserError(problem);
    const auto [action, argument] = split(text);
    topics::Command command;
    find(action)->mean(command, argument, {scene, status});
    return command;
}

}  // namespace bonemill
