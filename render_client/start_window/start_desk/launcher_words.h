// The words that bonemill is given for what is clicked: the very ones that somebody would type. Plain
// functions, for any thread.
#pragma once

#include <string>
#include <vector>

#include "render_client/start_window/start_desk/launcher_facts.h"

namespace bonemill {

// How sessions are started from now on.
struct StartChoice {
    std::string device;  // a word of --device; empty: the best hand that is there
    bool is_class = false;
    std::string interface;   // of a class: to the viewers' PCs
    std::string class_name;  // empty: the date
};

// All without the program itself. `network` are the options that all commands are given.
std::vector<std::string> startWords(const SceneCard& card, const StartChoice& choice,
                                    const std::vector<std::string>& network);
std::vector<std::string> watchWords(const FoundSession& session, const std::vector<std::string>& network);
std::vector<std::string> watchOwnWords(const RunningSession& session);
std::vector<std::string> watchHostWords(const std::string& host, const std::vector<std::string>& network);
// A result or a recording.
std::vector<std::string> replayWords(const std::string& file, const std::vector<std::string>& network);

// As people type it.
std::string commandLineOf(const std::vector<std::string>& words);

}  // namespace bonemill
