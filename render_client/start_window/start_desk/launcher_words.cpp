#include "render_client/start_window/start_desk/launcher_words.h"

#include <algorithm>

#include "common/text/printed_text.h"

namespace bonemill {
namespace {

using Words = std::vector<std::string>;

// Appends the option, unless `words` have it or it has no value.
void add(Words& words, const std::string& option, const std::string& value) {
    if (!value.empty() && std::ranges::find(words, option) == words.end())
        words.insert(words.end(), {option, value});
}

Words with(Words words, const Words& network) {
    words.insert(words.end(), network.begin(), network.end());
    return words;
}

}  // namespace

Words startWords(const SceneCard& card, const StartChoice& choice, const Words& network) {
    Words words = with({choice.is_class ? "host" : "start", card.is_own ? card.file : card.name}, network);
    add(words, "--device", choice.device);
    if (!choice.is_class) return words;
    add(words, "--interface", choice.interface);
    add(words, "--class", choice.class_name);
    return words;
}

Words watchWords(const FoundSession& session, const Words& network) {
    Words words = with({"watch", "--session", session.number}, network);
    add(words, "--profile", session.profile);
    add(words, "--interface", session.interface);
    return words;
}

Words watchOwnWords(const RunningSession& session) {
    return {"watch", "--session", session.number};
}

Words watchHostWords(const std::string& host, const Words& network) {
    return with({"watch", host}, network);
}

Words replayWords(const std::string& file, const Words& network) {
    return with({"replay", file}, network);
}

std::string commandLineOf(const Words& words) {
    std::string line = "bonemill";
    for (const std::string& word : words) line += " " + quoted(word);
    return line;
}

}  // namespace bonemill
