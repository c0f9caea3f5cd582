// What a user wants may cost something: then it is asked about first. These are the deeds that can be asked
// about, and the questions. They are plain values and pure functions, for any thread.
#pragma once

#include <optional>
#include <string>

#include "render_client/hand/controls/session_view.h"

namespace bonemill {

struct Deed {
    enum class Kind { kCommand, kNextTrainee, kQuit };
    Kind kind = Kind::kCommand;
    topics::Command command = {};  // of kCommand
};
bool isSame(const Deed& a, const Deed& b);

struct Question {
    std::string text;  // UTF-8, with what would be lost
    std::string yes;   // labels of the answers
    std::string no = "Stay";
    bool offers_checkpoint = false;  // a checkpoint keeps what would be lost
};

// Returns nothing when nothing is lost by the deed.
std::optional<Question> questionBefore(const Deed& deed, const SessionView& session);

// A start puts the bone back. Where no trainee loses anything by it nobody is asked, and a checkpoint keeps
// what is milled.
bool wantsCheckpointBefore(const Deed& deed, const SessionView& session);

}  // namespace bonemill
