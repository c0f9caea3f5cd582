// These are the lines of the head-up display, from top to bottom: what each says, and when it is there.
// First come the figures that matter to the task; which lines they have depends on the scene alone, so that
// they stand still. The rest is folded. Another line is a function of hud_lines.cpp, or of effect_lines.cpp
// when it tells of an effect. The functions are pure; any thread may call them.
#pragma once

#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "proto/topics.pb.h"
#include "render_client/look/hud/hud.h"

namespace bonemill {

struct ServerSought {
    uint32_t session = 1;
    uint32_t domain = 0;
    std::string profile;          // as the user knows it: one-pc, lab, ...
    std::string interface;        // empty: none was chosen
    bool is_on_lan = false;       // the server may run on another PC
    bool is_any_session = false;  // the number does not count
    std::string gateway = {};     // not empty: it is the gateway that looks for the server
    HudLock lock = HudLock::kNone;
};

// Says which server a viewer waits for, and what to try.
HudPage waitingPage(const ServerSought& sought);

// It says how the viewer stands with its server.
enum class Connection {
    kNoServer,     // none found yet
    kReceiving,    // the model is still arriving
    kLive,         // the model is complete
    kServerLost,   // there was one, which has fallen silent
    kServerEnded,  // there was one, which has left in order
};

struct HudInput {
    std::optional<topics::SceneInfo> info;
    std::optional<topics::Status> status;
    std::optional<topics::ToolState> tool;
    Connection connection = Connection::kNoServer;
    std::vector<std::string> modes;           // Hud::modes
    std::optional<std::string> other_server;  // what a second server of the session calls its scene
    size_t node_count = 0;                    // nodes the viewer holds
    double frame_rate_hz = 0;                 // of this viewer; 0: not known
    std::vector<topics::Viewer> watchers;
    bool show_watchers = false;
    bool show_details = false;  // instead of the watchers
    // The display is drawn into each eye's picture: figures would lie before the bone, and take half of it.
    // There is only what was asked for, and what must not be overseen.
    bool is_in_eyes = false;
    std::vector<HelpGroup> help;
    std::optional<ServerSought> sought;
    bool show_help = false;
    std::optional<HudLegend> legend;
    std::optional<HudHint> hint;
    std::optional<HudNotice> notice;
    std::vector<HudNotice> messages;  // FaultList::said()
    size_t fault_count = 0;           // in the list of faults
    uint32_t events = 0;              // EffectState.Event bits that the trainee is to see now
    uint32_t structure = 0;           // EffectState.event_id of those of protected structures
};

Hud makeHud(const HudInput& input);
// The alert is also shown over a picture without figures.
std::optional<HudNotice> alertOf(const HudInput& input);

}  // namespace bonemill
