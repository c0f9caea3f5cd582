// A viewer knows this about its session, for those who show it, who may ask the server for what, and what
// must be asked about first.
//
// They are plain values, for any thread. The pointers are the owner's; they are null while nothing has come
// yet.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <type_traits>
#include <vector>

#include "proto/topics.pb.h"
#include "render_client/hand/controls/key_table.h"
#include "render_client/language/language.h"
#include "render_client/look/hud/conditions.h"

namespace bonemill {

// A session that can be joined, where none was asked for.
struct OfferedSession {
    uint32_t number = 0;
    std::string text;  // for people
};

// Somebody is invited to join in a browser.
struct Invitation {
    std::string name;     // whose it is; empty: nobody was invited
    std::string link;     // empty: it is not there yet, or there is a problem
    std::string problem;  // why there is no link
};

// An attempt of this PC that has left a result.
struct PastAttempt {
    std::string stem;                          // of its files, in its class' folder
    std::string recording;                     // where it can be seen again; empty: nowhere
    std::string start, scene, trainee, score;  // for people
    std::string picture;                       // PNG of the bone that it left; empty: none
};

struct SessionView {
    std::string name;  // of this viewer
    topics::Viewer::Role role = topics::Viewer::OPERATOR;
    bool has_server = false;
    bool is_complete = false;  // this viewer shows the server's whole model
    double frame_rate_hz = 0;  // of this viewer
    double picture_s = 0;      // that a picture of this viewer takes; 0: not known
    double time_s = 0;         // any clock that goes on
    int64_t realtime_ns = 0;   // CLOCK_REALTIME of this PC
    const topics::SceneInfo* info = nullptr;
    const topics::Status* status = nullptr;
    const topics::ToolState* tool = nullptr;
    const topics::Lesson* lesson = nullptr;
    std::vector<topics::Viewer> others = {};
    std::vector<OfferedSession> offered = {};                     // to choose from; empty: nothing to choose
    const std::map<uint32_t, topics::Remark>* remarks = nullptr;  // by place
    std::vector<FaultEntry> faults = {};                          // of the session, the first one first
    const std::vector<PastAttempt>* past = nullptr;               // the newest one first
    const std::vector<PastAttempt>* same_scene = nullptr;         // as what is replayed, the newest one first
    bool has_launcher = false;      // bonemill can be asked for replays and invitations
    std::string recording = {};     // that is replayed, of which it can be asked for a clip; empty: not known
    Invitation invitation = {};     // the last one that was asked for
    std::string class_folder = {};  // of this PC, with the class' table, page and reports; empty: not known
};

// Returns why this viewer may not do it, a sentence for the user; empty when it may.
std::string whyNotCommand(const SessionView& session);
std::string whyNotHold(const SessionView& session);
std::string whyNotPoint(const SessionView& session);
std::string whyNotEndSession(const SessionView& session);

// The session is a replay of a recorded one.
bool isReplay(const SessionView& session);

// The session's tool is held by a mouse (device_daemon --device pointer).
bool isHeldByMouse(const SessionView& session);

// A scripted hand has done all of its script, and rests.
bool hasHandEnded(const SessionView& session);
// The mouse of viewers has come in the place of a scripted hand.
bool isTakenOver(const SessionView& session);
// Returns why this viewer may not take the tool over from a hand that has ended; empty when it may.
std::string whyNotTakeOver(const SessionView& session);

// Returns the command that this setter fills in.
template <class Value>
topics::Command commandWith(void (topics::Command::*set)(Value), std::type_identity_t<Value> value) {
    topics::Command command;
    (command.*set)(value);
    return command;
}

// It says what an action asks of the server, or why it cannot be asked. Both are empty for actions that are
// none of the server's business.
struct CommandOrReason {
    std::optional<topics::Command> command;
    std::string why_not;
};
CommandOrReason commandOf(Action action, const SessionView& session);

// What a user wants may cost something: then it is asked about first. These are the deeds that can be asked
// about, and the questions.
struct Deed {
    enum class Kind { kCommand, kNextTrainee, kQuit };
    Kind kind = Kind::kCommand;
    topics::Command command = {};  // of kCommand
};
bool isSame(const Deed& a, const Deed& b);

struct Question {
    std::string text;  // UTF-8, with what would be lost
    std::string yes;   // labels of the answers
    std::string no = tr("Stay");
    bool offers_checkpoint = false;  // a checkpoint keeps what would be lost
};

// Returns nothing when nothing is lost by the deed.
std::optional<Question> questionBefore(const Deed& deed, const SessionView& session);

// A start puts the bone back. Where no trainee loses anything by it nobody is asked, and a checkpoint keeps
// what is milled.
bool wantsCheckpointBefore(const Deed& deed, const SessionView& session);

}  // namespace bonemill
