#include "render_client/apps/render_client/sound_feed.h"

#include <algorithm>

namespace bonemill {
namespace {

constexpr double kLongest = 10;  // s of one update; what is beyond is left out

}  // namespace

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
    if (tool)
        load = {tool->effects().spin_speed(), tool->effects().burr_force_n(),
                tool->effects().cutting_power_w()};
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

}  // namespace bonemill
