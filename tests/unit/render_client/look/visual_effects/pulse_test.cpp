#include "render_client/look/visual_effects/pulse.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "render_client/look/visual_effects/visual_effects.h"

namespace bonemill {
namespace {

constexpr uint32_t kDura = 2;

topics::SceneInfo infoWithDura() {
    topics::SceneInfo info;
    for (const char* name : {"bone", "dura", "nerve"}) info.add_materials()->set_name(name);
    info.mutable_viewer_effects()->mutable_pulse()->add_material("dura");
    return info;
}

TEST(Pulse, TheDuraRisesSeventyTimesAMinuteAndNothingElseDoes) {
    const topics::SceneInfo info = infoWithDura();
    VisualEffects effects(info.viewer_effects(), 1e-3, info.materials());
    ASSERT_NE(effects.pulse(), nullptr);
    int beats = 0;
    float highest = 0;
    bool is_high = false;
    for (int picture = 0; picture < 60 * 30; ++picture) {  // a minute
        effects.advance(1.0 / 30);
        const float rise = effects.pulse()->riseOf(kDura);
        EXPECT_GE(rise, 0);
        highest = std::max(highest, rise);
        if (rise > 200e-6f && !std::exchange(is_high, true)) ++beats;
        if (rise < 50e-6f) is_high = false;
        for (const uint32_t other : {0, 1, 3, 200}) EXPECT_EQ(effects.pulse()->riseOf(other), 0);
    }
    EXPECT_EQ(beats, 70);
    EXPECT_FLOAT_EQ(highest, 250e-6f);
}

TEST(Pulse, TheWaveIsSmoothAndGoesUpFasterThanDown) {
    double top = 0, at_top = 0;
    for (double beat = 0; beat < 1; beat += 1e-3) {
        EXPECT_LT(std::abs(Pulse::waveAt(beat + 1e-3) - Pulse::waveAt(beat)), 0.012) << beat;
        if (Pulse::waveAt(beat) > top) top = Pulse::waveAt(beat), at_top = beat;
    }
    EXPECT_NEAR(top, 1, 1e-3);
    EXPECT_LT(at_top, 0.2);
    EXPECT_NEAR(Pulse::waveAt(0), Pulse::waveAt(1), 1e-3);
}

TEST(Pulse, AnUnlistedOneIsNotMade) {
    topics::SceneInfo info = infoWithDura();
    info.mutable_viewer_effects()->clear_pulse();
    info.mutable_viewer_effects()->mutable_burr_spin();
    EXPECT_EQ(VisualEffects(info.viewer_effects(), 1e-3, info.materials()).pulse(), nullptr);
}

}  // namespace
}  // namespace bonemill
