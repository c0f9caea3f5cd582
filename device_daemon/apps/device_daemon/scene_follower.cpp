#include "device_daemon/apps/device_daemon/scene_follower.h"

#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <limits>
#include <utility>

#include "common/base/user_error.h"
#include "common/config/scene_file.h"
#include "common/rt/clock.h"

namespace bonemill {
namespace {

constexpr int64_t kLookEveryNs = 50 * kNsPerMillisecond;

}  // namespace

HandChoice handFor(const SceneNotice& notice, const DaemonOptions& options) noexcept {
    return options.device == kScriptedHand ? HandChoice(notice.hand) : HandChoice::kOwn;
}

FollowedScene followedSceneOf(const std::string& file) {
    const LoadedScene loaded = loadScene(file);
    try {
        return {.file = file,
                .hash = sceneHashOf(loaded.scene),
                .revision = 0,
                .epoch = 0,
                .hand = HandChoice::kOwn,
                .setup = deviceSetupOf(loaded.scene)};
    } catch (const UserError& error) {
        throw UserError(file + ": " + error.what());
    }
}

SceneFollower::SceneFollower(std::optional<FollowedScene> own, const DaemonOptions& options,
                             const DeviceLink& link, const StopSignals& stop_signals)
    : own_(std::move(own)), options_(options), link_(link), stop_signals_(stop_signals) {}

std::optional<FollowedScene> SceneFollower::next() {
    const bool is_first = !std::exchange(has_begun_, true);
    const double give_up_s = options_.wait_seconds.value_or(std::numeric_limits<double>::infinity());
    const int64_t start_ns = monotonicNowNs();
    if (is_first && !own_) spdlog::info("session {}: waiting for haptic_server's scene", options_.session);
    for (;;) {
        if (std::optional<FollowedScene> scene = takeAnnounced()) return scene;
        if (is_first && own_) return own_;
        if (stop_signals_.await(kLookEveryNs)) return std::nullopt;
        if (is_first && secondsOfNs(monotonicNowNs() - start_ns) > give_up_s)
            throw UserError(fmt::format(
                "no haptic_server has announced its scene within {} s: start it with the same --session ({})",
                give_up_s, options_.session));
    }
}

std::optional<FollowedScene> SceneFollower::takeAnnounced() {
    SceneNotice notice;
    if (!link_.readScene(notice)) return std::nullopt;
    if (own_ && notice.hash == own_->hash) {
        FollowedScene scene = *own_;
        scene.revision = notice.revision;
        scene.epoch = notice.epoch;
        scene.hand = handFor(notice, options_);
        return scene;
    }
    try {
        FollowedScene scene = followedSceneOf(notice.path);
        if (scene.hash != notice.hash)
            throw UserError(
                std::string(notice.path) +
                ": has changed since haptic_server read it; choose the scene again, or start the server "
                "anew");
        scene.revision = notice.revision;
        scene.epoch = notice.epoch;
        scene.hand = handFor(notice, options_);
        spdlog::info("the scene is haptic_server's, {}", scene.file);
        return scene;
    } catch (const UserError& error) {
        if (told_ != error.what()) spdlog::error("{}", error.what());
        told_ = error.what();
        return std::nullopt;
    }
}

}  // namespace bonemill
