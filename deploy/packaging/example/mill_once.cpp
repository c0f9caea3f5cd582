// Presses the scene's first tool straight down into the bone: an example of
// libbonemill. It prints what was felt and removed.
//
//     mill_once SCENE X_MM Y_MM FROM_Z_MM TO_Z_MM
#include <bonemill/simulation.h>

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>

int main(int argc, char** argv) {
    if (argc != 6) {
        std::fprintf(stderr, "usage: mill_once SCENE X_MM Y_MM FROM_Z_MM TO_Z_MM\n");
        return 2;
    }
    try {
        bonemill::Simulation simulation(argv[1]);
        const double x = std::atof(argv[2]) / 1000, y = std::atof(argv[3]) / 1000;
        const double from = std::atof(argv[4]) / 1000, to = std::atof(argv[5]) / 1000;
        constexpr int kTicks = 2000;
        double most_force = 0, removed = 0;
        for (int tick = 0; tick < kTicks; ++tick) {
            bonemill::Hand hand;
            hand.position_W = {x, y, from + (to - from) * tick / kTicks};
            hand.orientation_WT = {std::sqrt(0.5), std::sqrt(0.5), 0, 0};  // the handle along +z
            hand.buttons = bonemill::kRemove;
            const bonemill::StepResult result = simulation.step(hand);
            const auto& f = result.force_W;
            most_force = std::max(most_force, std::sqrt(f[0] * f[0] + f[1] * f[1] + f[2] * f[2]));
            removed += result.removed;
        }
        std::printf("%llu ticks, at most %.3f N, %.3f mm3 removed, state hash %016llx\n",
                    static_cast<unsigned long long>(simulation.ticks()), most_force, removed * 1e9,
                    static_cast<unsigned long long>(simulation.stateHash()));
    } catch (const bonemill::Error& error) {
        std::fprintf(stderr, "mill_once: %s\n", error.what());
        return 2;
    }
}
