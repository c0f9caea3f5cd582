// What a window of render_client remembers of its user from one start to the next, in one small file. Nothing
// is remembered of a scene: cut-planes are off at each start. It is for any one thread; not RT-safe.
#pragma once

#include <chrono>
#include <filesystem>
#include <map>
#include <optional>
#include <string>

#include "render_client/hand/controls/window_event.h"
#include "render_client/look/camera/view_settings.h"
#include "render_client/viewer_options/viewer_options.h"

namespace bonemill {

struct Preferences {
    std::optional<WindowPlace> place;  // of the window; nothing: none was seen yet
    std::optional<Quality> quality;    // nothing: by the measured speed
    CameraMode camera = CameraMode::kOrbit;
    double text_scale = 1;
    bool is_for_colour_blind = false;  // the palette
    bool is_panel_open = false;
    std::map<std::string, bool> folds;  // by the name of the panel's part: true where it is open
    bool operator==(const Preferences&) const = default;
};

// Returns $XDG_CONFIG_HOME/bonemill/viewer.json, or the same in ~/.config.
std::filesystem::path preferenceFile();

// The file's text is JSON. What it does not name is as at the first start; names that are not known mean
// nothing. The reader throws UserError, with all that is wrong, for a text that is none or a value out of its
// range.
std::string textOf(const Preferences& preferences);
Preferences preferencesOf(const std::string& text);

// Returns `now` where the user has changed it since the start, and else what was kept: what the command line
// asked for was for one start.
Preferences toKeep(const Preferences& kept, const Preferences& start, const Preferences& now);

// Starts a window as it is remembered, but for what the command line says.
void startAs(const Preferences& kept, ClientOptions& options);

// Reads the file, and writes it when something has changed and stays so for a moment: whole or not at all. A
// file that makes no sense, or cannot be read or written, is told of in the log, once; the viewer goes on
// without.
class PreferenceKeeper {
  public:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::seconds kQuiet{2};

    explicit PreferenceKeeper(std::filesystem::path file);

    const Preferences& kept() const { return kept_; }
    // What is to be kept from now on.
    void keep(const Preferences& preferences, Clock::time_point now);
    // Writes at once what has not been written yet.
    void finish();

  private:
    std::filesystem::path file_;
    Preferences kept_;    // in the file
    Preferences wanted_;  // to come into it
    Clock::time_point changed_;
    bool has_failed_ = false;
};

}  // namespace bonemill
