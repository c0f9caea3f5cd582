// What the head-up display says, without how it is drawn. Pure functions, any thread.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "proto/topics.pb.h"

namespace bonemill {

// How the viewer stands with its server.
enum class Connection {
    kNoServer,    // none found yet
    kReceiving,   // the model is still arriving
    kLive,        // the model is complete
    kServerLost,  // there was one
};

enum class HudTone { kPlain, kGood, kWarning, kAlarm };

struct HudRow {
    std::string label;
    std::string value;  // UTF-8, unit included
    HudTone tone = HudTone::kPlain;
};

// What the user should notice now, such as how a command ended.
struct HudNotice {
    std::string text;
    HudTone tone = HudTone::kPlain;
};

struct Hud {
    std::string title;
    std::string state;
    HudTone state_tone = HudTone::kPlain;
    std::vector<HudRow> rows;
    std::vector<HudRow> watchers;  // empty: no list
    std::vector<HudRow> help;      // keys and what they do; empty: no help page
    std::optional<HudNotice> notice;
    std::optional<HudNotice> alert;  // with a border around the picture
};

// A name beside a point of the picture, pixels from the upper left.
struct HudLabel {
    float x = 0;
    float y = 0;
    std::string text;
};

struct HudInput {
    std::optional<topics::SceneInfo> info;
    std::optional<topics::Status> status;
    std::optional<topics::ToolState> tool;
    Connection connection = Connection::kNoServer;
    size_t node_count = 0;     // nodes the viewer holds
    double frame_rate_hz = 0;  // of this viewer; 0: not known
    std::vector<topics::Viewer> watchers;
    bool show_watchers = true;
    std::vector<HudRow> help;
    bool show_help = false;
    std::optional<HudNotice> notice;
    uint32_t events = 0;     // EffectState.Event bits that the trainee is to see now
    uint32_t structure = 0;  // EffectState.event_id of those of protected structures
};

Hud makeHud(const HudInput& input);
// Also for a picture without figures.
std::optional<HudNotice> alertOf(const HudInput& input);

// A round length (1, 2 or 5 times a power of ten, m) that spans at most max_pixels, and its name.
struct ScaleBar {
    double length = 0;
    std::string label;
};
ScaleBar makeScaleBar(double metres_per_pixel, double max_pixels);

}  // namespace bonemill
