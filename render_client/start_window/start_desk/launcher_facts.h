// What bonemill says of this PC, of scenes and of sessions, in the lines that it prints for programs
// (--tab-separated; `bonemill COMMAND --help` says what is in them). Lines that make no sense are passed
// over.
//
// Plain values, for any thread; reading scenes is for start-up and lists only.
#pragma once

#include <string>
#include <vector>

namespace bonemill {

// A scene that can be started, as `bonemill list` tells, with what its own text says.
struct SceneCard {
    bool is_own = false;  // one of the user's cases
    std::string name;     // "tooth_corridor"
    std::string file;
    std::string picture;                  // a PNG; empty: none
    std::vector<std::string> made_first;  // phantoms, by the start itself
    std::string lacks;                    // files that nobody here can make; empty: none
    std::string title, task;
    double expected_minutes = 0;  // 0: nobody knows
    std::string problem;          // of the scene's text; empty: none
};

struct RunningSession {
    std::string number, scene, device, since;
};

struct Recording {
    std::string file, when;
};

struct ListFacts {
    std::vector<SceneCard> scenes;
    std::vector<RunningSession> running;
    std::vector<Recording> recordings;
    std::vector<std::string> interfaces;  // of this PC to others, the likeliest first
};
ListFacts listFactsOf(const std::string& lines);

// A session on another PC.
struct FoundSession {
    std::string number, scene, since, host, profile, interface;
};
std::vector<FoundSession> foundSessionsOf(const std::string& lines);

// One thing that the doctor has looked at.
struct Finding {
    std::string part;  // "Real time"
    bool is_ok = false;
    bool is_needed = false;  // and missing
    std::string text;
    std::vector<std::string> commands;  // that mend it
};

// Something that could be the hand.
struct FoundHand {
    std::string kind;  // "gamepad"
    bool is_ready = false;
    std::string text;     // what it is, or why it is not ready
    std::string word;     // of --device; empty: it is no hand, or not ready
    std::string command;  // to make it ready; empty: typing does not help
};

struct DoctorFacts {
    std::vector<Finding> findings;
    std::vector<FoundHand> hands;  // the best comes first
};
DoctorFacts doctorFactsOf(const std::string& lines);

}  // namespace bonemill
