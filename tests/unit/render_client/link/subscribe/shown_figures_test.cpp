// Figures of effects that a viewer knows nothing else of.
#include <gtest/gtest.h>

#include <limits>

#include "render_client/link/subscribe/payloads.h"

namespace bonemill {
namespace {

topics::ToolState stateWithFigures(int count, double value) {
    topics::ToolState state;
    state.set_epoch(1);
    for (auto* vector : {state.mutable_p_wt_m(), state.mutable_p_wt_device_m(), state.mutable_force_n(),
                         state.mutable_torque_nm()})
        vector->Resize(3, 0.5);
    for (auto* quaternion : {state.mutable_q_wt(), state.mutable_q_wt_device()}) quaternion->Resize(4, 0.5);
    for (int n = 0; n < count; ++n) {
        topics::ShownFigure& figure = *state.mutable_effects()->add_figures();
        figure.set_words("Wax\ned");
        figure.set_value(value);
    }
    return state;
}

std::optional<topics::ToolState> parsed(const topics::ToolState& state) {
    const std::string text = state.SerializeAsString();
    return parseToolState({reinterpret_cast<const uint8_t*>(text.data()), text.size()});
}

TEST(ShownFigures, TheirWordsAreCleanedAndTheirNumbersChecked) {
    const auto state = parsed(stateWithFigures(1, 12));
    ASSERT_TRUE(state);
    EXPECT_EQ(state->effects().figures(0).words(), "Waxed");
    EXPECT_TRUE(parsed(stateWithFigures(16, 12)));
    EXPECT_FALSE(parsed(stateWithFigures(17, 12)));
    EXPECT_FALSE(parsed(stateWithFigures(1, std::numeric_limits<double>::quiet_NaN())));
}

TEST(ShownFigures, AStateWithoutEffectsStaysOne) {
    const auto state = parsed(stateWithFigures(0, 0));
    ASSERT_TRUE(state);
    EXPECT_FALSE(state->has_effects());
}

}  // namespace
}  // namespace bonemill
