#include "render_client/apps/render_client/scene_feed.h"

#include <spdlog/spdlog.h>

#include <algorithm>
#include <csignal>
#include <stdexcept>

#include "render_client/viewer_options/viewer_options.h"

namespace bonemill {
namespace {

volatile std::sig_atomic_t stop_requested = 0;

constexpr double kLongest = 10;  // s of one update; what is beyond is left out

}  // namespace

void catchStopSignals() {
    struct sigaction action {};
    action.sa_handler = [](int) { stop_requested = 1; };
    sigaction(SIGINT, &action, nullptr);
    sigaction(SIGTERM, &action, nullptr);
}

bool stopRequested() noexcept {
    return stop_requested != 0;
}

SoundFeed::SoundFeed(const SoundOutputs& outputs) : outputs_(outputs) {
    if (!outputs.wav.empty()) wav_.emplace(outputs.wav, MillingSynth::kSampleRate);
}

void SoundFeed::follow(const scene::Effects& wish) {
    const std::string text = wish.has_milling_sound() ? "1" + wish.milling_sound().SerializeAsString() : "";
    if (text == wish_text_) return;
    wish_text_ = text;
    player_.reset();
    wav_synth_.reset();
    if (!wish.has_milling_sound()) return;
    if (outputs_.is_played) player_ = std::make_unique<SoundPlayer>(wish.milling_sound());
    if (wav_) wav_synth_ = std::make_unique<MillingSynth>(wish.milling_sound());
}

void SoundFeed::update(const std::optional<topics::SceneInfo>& info,
                       const std::optional<topics::ToolState>& tool, bool is_heard, double seconds) {
    if (info) follow(info->viewer_effects());
    SoundLoad load;
    if (tool) {
        const auto& effects = tool->effects();
        load = {effects.spin_speed(), effects.burr_force_n(), effects.cutting_power_w()};
        if (effects.has_protected_distance_m()) load.wall = effects.protected_distance_m();
    }
    if (player_) player_->setLoad(load, is_heard);
    if (wav_synth_) wav_synth_->setLoad(load, is_heard);
    if (wav_) writeWav(seconds);
}

void SoundFeed::writeWav(double seconds) {
    due_ += std::clamp(seconds, 0.0, kLongest) * MillingSynth::kSampleRate;
    block_.assign(size_t(due_), 0);
    due_ -= double(block_.size());
    if (wav_synth_) wav_synth_->render(block_);
    wav_->write(block_);
}

void SoundFeed::finish() {
    if (wav_) wav_->finish();
}

void SceneFeed::update() {
    const SceneModel::Changes changes = subscriber_.poll();
    if (changes.is_cleared) nodes_.clear();
    for (const SceneModel::Change& change : changes.nodes)
        if (nodes_.set(change.mesh) && cuts_) cuts_->willShow(change.cut_stamp_ns, CutToScreen::nowNs());
    showSceneInfo();
    subscriber_.followDensities(scene_.densities());
    showStructures();
    showRemarks();
    if (subscriber_.toolState()) scene_.setToolState(*subscriber_.toolState());
    if (subscriber_.status()) scene_.setStatus(*subscriber_.status());
    advanceEffects();
    updateConnection();
    if (takes_part_) announce();
}

void SceneFeed::showSceneInfo() {
    const auto& info = subscriber_.sceneInfo();
    if (!info || std::pair(info->epoch(), info->revision()) == shown_info_) return;
    shown_info_ = {info->epoch(), info->revision()};
    try {
        scene_.setSceneInfo(*info);
    } catch (const std::invalid_argument& error) {
        spdlog::warn("the server sent a scene that cannot be shown: {}", error.what());
    }
}

void SceneFeed::showStructures() {
    const uint64_t changes = subscriber_.structureChanges();
    const uint64_t shown = std::exchange(shown_structures_, changes);
    if (shown == changes) return;
    if (std::exchange(structures_epoch_, subscriber_.epoch()) != subscriber_.epoch())
        scene_.clearStructures();
    for (const auto& [id, structure] : subscriber_.structures())
        if (structure.change > shown) scene_.setStructure(structure.mesh, structure.warning_distance);
}

void SceneFeed::showRemarks() {
    const uint64_t changes = subscriber_.remarkChanges();
    if (std::exchange(shown_remarks_, changes) != changes) scene_.setRemarks(subscriber_.remarks());
}

void SceneFeed::advanceEffects() {
    const auto now = std::chrono::steady_clock::now();
    const std::chrono::duration<double> passed = now - std::exchange(advanced_, now);
    scene_.advance(passed.count());
    if (!sound_) return;
    // A server that is gone leaves the last state behind.
    const auto& state = subscriber_.toolState();
    sound_->update(subscriber_.sceneInfo(), subscriber_.hasServer() ? state : std::nullopt,
                   scene_.settings().shows(ViewerEffect::kMillingSound), passed.count());
}

void SceneFeed::announce() {
    scene_.setWatchers(subscriber_.viewers());
    if (announce_clock_.isDue(std::chrono::steady_clock::now(), false)) subscriber_.announce(0, std::nullopt);
}

// Tool states are not kept for late clients: a loop that has ticked will send one soon.
bool SceneFeed::isComplete() const {
    const bool has_ticked = subscriber_.status() && subscriber_.status()->ticks() > 0;
    return subscriber_.hasServer() && hasWholeModel() && scene_.hasSceneInfo() &&
           (!has_ticked || subscriber_.toolState());
}

// While the bone is being milled the model is always a node or two behind its newest status: what was
// complete once is called live from then on.
void SceneFeed::updateConnection() {
    const bool has_server = subscriber_.hasServer();
    scene_.setOtherServer(subscriber_.otherServer());
    if (has_server && hasWholeModel()) complete_epoch_ = subscriber_.epoch();
    had_server_ = had_server_ || has_server;
    scene_.setConnection(!has_server && subscriber_.hasEnded() ? Connection::kServerEnded
                         : !has_server && had_server_          ? Connection::kServerLost
                         : !has_server                         ? Connection::kNoServer
                         : complete_epoch_ != 0 && complete_epoch_ == subscriber_.epoch()
                             ? Connection::kLive
                             : Connection::kReceiving);
}

void waitUntilComplete(SceneFeed& feed, const SubscriberOptions& options, std::chrono::seconds timeout) {
    const auto end = std::chrono::steady_clock::now() + timeout;
    feed.updateUntil(end, [&] { return feed.isComplete() || stopRequested(); });
    if (feed.isComplete() || stopRequested()) return;
    throw std::runtime_error("the model was not complete after " + std::to_string(timeout.count()) +
                             " s: " + serverQuestion(options));
}

void waitForScan(SceneFeed& feed, RenderScene& scene, std::chrono::seconds timeout) {
    feed.updateUntil(std::chrono::steady_clock::now() + timeout,
                     [&] { return scene.densities().hasAllWanted() || stopRequested(); });
}

}  // namespace bonemill
