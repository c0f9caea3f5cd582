// The table of the Z-width in docs/explanation/stability.md stays true: `balanced` at 1000 Hz, drag as it
// comes.
#include <gtest/gtest.h>

#include "tests/stability/pressed.h"

namespace bonemill::test {
namespace {

// The largest stable k_t of the table, N/m, in the order of pressPlaces() and pressHands().
constexpr double kMaxStable[2][2] = {{18.1e3, 9.3e3}, {16.3e3, 9.1e3}};
constexpr double kBelow = 0.95, kBeyond = 1.1;

struct PressedRun {
    PressedRun(const PressPlace& place, const PressHand& hand, double stiffness)
        : scene(place.bone(), place.tool(), allVariants()[2], 1e-3,
                [=](FixedTickConfig& config) { couplingStiffness(config) = stiffness; }),
          pressed(scene, place, hand.plant) {}
    Scene scene;
    Pressed pressed;
};

TEST(ZwidthBand, EndsWhereTheTableSays) {
    for (size_t place = 0; place < 2; ++place)
        for (size_t hand = 0; hand < 2; ++hand) {
            const PressPlace& at = pressPlaces()[place];
            const PressHand& by = pressHands()[hand];
            const double most = kMaxStable[place][hand];
            EXPECT_TRUE(PressedRun(at, by, kBelow * most).pressed.isStable()) << at.name << " " << by.name;
            EXPECT_FALSE(PressedRun(at, by, kBeyond * most).pressed.isStable()) << at.name << " " << by.name;
        }
}

TEST(ZwidthBand, TheWallIsAsStiffAsTheCoupling) {
    for (const PressPlace& place : pressPlaces())
        for (const PressHand& hand : pressHands()) {
            PressedRun run(place, hand, 3000);
            EXPECT_TRUE(run.pressed.isStable()) << place.name << " " << hand.name;
            const double wall = run.pressed.rendered();
            EXPECT_GT(wall, 0.9 * 3000) << place.name << " " << hand.name;
            EXPECT_LT(wall, 1.02 * 3000) << place.name << " " << hand.name;
        }
}

}  // namespace
}  // namespace bonemill::test
