#include "render_client/viewer_options/preferences.h"

#include <spdlog/spdlog.h>

#include <cmath>
#include <fstream>
#include <iterator>
#include <nlohmann/json.hpp>
#include <utility>

#include "common/base/user_error.h"
#include "common/files/config_folder.h"
#include "common/files/whole_file.h"

namespace bonemill {
namespace {

using Json = nlohmann::json;

constexpr size_t kMostBytes = 1 << 16, kMostFolds = 64, kLongestName = 64;
constexpr int kFarthest = 1 << 16;                                        // screen coordinates
constexpr int kSmallestWindow = 64, kLargestWindow = 8192;                // the same
constexpr const char* kQualities[] = {"full", "quick"};                   // by Quality
constexpr const char* kCameras[] = {"orbit", "endoscope", "microscope"};  // by CameraMode

// Reads members of one object; each is left alone where it is not there. Throws UserError.
class Reader {
  public:
    explicit Reader(const Json& json) : json_(json) {
        if (!json.is_object()) throw UserError("it is no JSON object");
    }

    void flag(const char* name, bool& value) const {
        if (const Json* const found = find(name)) value = flagOf(name, *found);
    }
    void number(const char* name, double low, double high, double& value) const {
        const Json* const found = find(name);
        if (!found) return;
        if (!found->is_number()) throw wrong(name);
        const auto read = found->get<double>();
        if (!(read >= low && read <= high)) throw wrong(name);
        value = read;
    }
    // Returns the place of the word among `words`.
    template <size_t kCount>
    std::optional<size_t> word(const char* name, const char* const (&words)[kCount]) const {
        const Json* const found = find(name);
        if (!found) return std::nullopt;
        for (size_t n = 0; n < kCount; ++n)
            if (*found == words[n]) return n;
        throw wrong(name);
    }
    std::optional<WindowPlace> place(const char* name) const {
        const Json* const found = find(name);
        if (!found) return std::nullopt;
        const Reader reader(*found);
        const auto whole = [&](const char* part, int low, int high) {
            double value = low - 1.0;
            reader.number(part, low, high, value);
            if (value < low) throw wrong(part);  // it is not there
            return int(std::lround(value));
        };
        return WindowPlace{whole("x", -kFarthest, kFarthest), whole("y", -kFarthest, kFarthest),
                           whole("width", kSmallestWindow, kLargestWindow),
                           whole("height", kSmallestWindow, kLargestWindow)};
    }
    std::map<std::string, bool> flags(const char* name) const {
        std::map<std::string, bool> read;
        const Json* const found = find(name);
        if (!found) return read;
        if (!found->is_object() || found->size() > kMostFolds) throw wrong(name);
        for (const auto& [part, value] : found->items())
            if (part.size() <= kLongestName) read[part] = flagOf(name, value);
        return read;
    }

  private:
    static UserError wrong(const std::string& name) {
        return UserError("'" + name + "' has no value that it can have");
    }
    static bool flagOf(const char* name, const Json& json) {
        if (!json.is_boolean()) throw wrong(name);
        return json.get<bool>();
    }
    const Json* find(const char* name) const {
        const auto found = json_.find(name);
        return found == json_.end() ? nullptr : &*found;
    }

    const Json& json_;
};

// Throws UserError.
std::string readText(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    if (!stream) throw UserError("it cannot be read");
    std::string text(kMostBytes + 1, '\0');
    stream.read(text.data(), std::streamsize(text.size()));
    text.resize(size_t(stream.gcount()));
    if (text.size() > kMostBytes) throw UserError("it is too long");
    return text;
}

template <class Value>
Value changed(const Value& kept, const Value& start, const Value& now) {
    return now == start ? kept : now;
}

}  // namespace

std::filesystem::path preferenceFile() {
    return configFolder() / "viewer.json";
}

std::string textOf(const Preferences& preferences) {
    Json json = {{"camera", kCameras[size_t(preferences.camera)]},
                 {"text_scale", preferences.text_scale},
                 {"colours_for_colour_blind", preferences.is_for_colour_blind},
                 {"panel_is_open", preferences.is_panel_open},
                 {"panel_parts_open", Json(preferences.folds)}};
    if (preferences.quality) json["quality"] = kQualities[size_t(*preferences.quality)];
    if (const auto& place = preferences.place)
        json["window"] = {
            {"x", place->x}, {"y", place->y}, {"width", place->width}, {"height", place->height}};
    return json.dump(2, ' ', false, Json::error_handler_t::replace) + "\n";
}

Preferences preferencesOf(const std::string& text) {
    const Json json = Json::parse(text, nullptr, false);
    if (json.is_discarded()) throw UserError("it is no JSON");
    const Reader reader(json);
    Preferences read;
    read.place = reader.place("window");
    if (const auto quality = reader.word("quality", kQualities)) read.quality = Quality(*quality);
    if (const auto camera = reader.word("camera", kCameras)) read.camera = CameraMode(*camera);
    reader.number("text_scale", ViewSettings::kMinText, ViewSettings::kMaxText, read.text_scale);
    reader.flag("colours_for_colour_blind", read.is_for_colour_blind);
    reader.flag("panel_is_open", read.is_panel_open);
    read.folds = reader.flags("panel_parts_open");
    return read;
}

Preferences toKeep(const Preferences& kept, const Preferences& start, const Preferences& now) {
    return {.place = changed(kept.place, start.place, now.place),
            .quality = changed(kept.quality, start.quality, now.quality),
            .camera = changed(kept.camera, start.camera, now.camera),
            .text_scale = changed(kept.text_scale, start.text_scale, now.text_scale),
            .is_for_colour_blind =
                changed(kept.is_for_colour_blind, start.is_for_colour_blind, now.is_for_colour_blind),
            .is_panel_open = changed(kept.is_panel_open, start.is_panel_open, now.is_panel_open),
            .folds = changed(kept.folds, start.folds, now.folds)};
}

void startAs(const Preferences& kept, ClientOptions& options) {
    if (kept.place && !options.said.size) {
        options.width = kept.place->width;
        options.height = kept.place->height;
    }
    if (kept.quality && !options.said.quality) {
        options.settings.quality = *kept.quality;
        options.chooses_quality = false;
    }
    if (!options.said.camera) options.settings.camera = kept.camera;
    options.settings.is_for_colour_blind = kept.is_for_colour_blind;
    if (!options.said.text_scale) options.settings.text_scale = kept.text_scale;
}

PreferenceKeeper::PreferenceKeeper(std::filesystem::path file) : file_(std::move(file)) {
    std::error_code none;
    if (!std::filesystem::exists(file_, none)) return;
    try {
        kept_ = wanted_ = preferencesOf(readText(file_));
    } catch (const UserError& error) {
        spdlog::warn("{}: {}; the window starts as at the first time", file_.string(), error.what());
    }
}

void PreferenceKeeper::keep(const Preferences& preferences, Clock::time_point now) {
    if (std::exchange(wanted_, preferences) != preferences) changed_ = now;
    if (now - changed_ >= kQuiet) finish();
}

void PreferenceKeeper::finish() {
    if (has_failed_ || wanted_ == kept_) return;
    try {
        writePrivateFile(file_, textOf(wanted_));
        kept_ = wanted_;
    } catch (const UserError& error) {
        has_failed_ = true;
        spdlog::warn("{}; what you set in the window is not remembered", error.what());
    }
}

}  // namespace bonemill
