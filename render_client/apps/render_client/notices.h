// What the user of a window is told in words: over the picture, and in the log. It belongs to the render
// thread.
#pragma once

#include <spdlog/spdlog.h>

#include <chrono>
#include <cstdint>
#include <map>
#include <string>
#include <utility>
#include <vector>

#include "common/commands/command_text.h"
#include "render_client/link/subscribe/scene_subscriber.h"
#include "render_client/look/hud/figure_text.h"
#include "render_client/look/render_scene/render_scene.h"

namespace bonemill {

// Shows over the picture, for a while, what the user should notice.
class Notices {
  public:
    explicit Notices(RenderScene& scene) : scene_(scene) {}

    void show(HudNotice notice) {
        spdlog::log(notice.tone == HudTone::kGood ? spdlog::level::info : spdlog::level::warn, "{}",
                    notice.text);
        scene_.setNotice(std::move(notice));
        end_ = Clock::now() + kNoticeTime;
    }
    void showOutcomes(SceneSubscriber& subscriber) {
        const std::string trainee = subscriber.lesson() ? subscriber.lesson()->trainee() : "";
        for (const CommandOutcome& outcome : subscriber.takeOutcomes())
            outcome.isDone() ? show({doneText(outcome.command, trainee), HudTone::kGood})
                             : show({outcomeText(outcome), HudTone::kWarning});
    }
    void removeOld() {
        if (Clock::now() >= end_) scene_.setNotice(std::nullopt);
    }

  private:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::seconds kNoticeTime{6};

    RenderScene& scene_;
    Clock::time_point end_;
};

// Logs who comes and goes.
class Attendance {
  public:
    void update(const std::vector<topics::Viewer>& others) {
        std::map<uint64_t, std::string> here;
        for (const topics::Viewer& other : others) {
            here[other.sender()] = other.name();
            if (!here_.contains(other.sender()))
                spdlog::info("{} ({}) is watching", other.name(), roleName(other.role()));
        }
        for (const auto& [sender, name] : here_)
            if (!here.contains(sender)) spdlog::info("{} is no longer watching", name);
        here_ = std::move(here);
    }

  private:
    std::map<uint64_t, std::string> here_;  // names by sender
};

}  // namespace bonemill
