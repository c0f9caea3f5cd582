// Bricks of densities like those of a CT, for tests: soft tissue, bone and noise in whole HU.
#pragma once

#include <cmath>
#include <cstdint>
#include <random>
#include <vector>

namespace bonemill::test {

inline constexpr uint16_t kCtWindow = 2000;  // HU

inline std::vector<uint16_t> ctBrick(int edge, std::mt19937& random) {
    std::normal_distribution<double> noise(0, 12);
    const double slope = std::uniform_real_distribution<double>(-60, 60)(random);
    std::vector<uint16_t> densities;
    for (int z = 0; z < edge; ++z)
        for (int y = 0; y < edge; ++y)
            for (int x = 0; x < edge; ++x) {
                const double hu = std::round(700 + slope * (x + y - z) + noise(random));
                const double share = std::fmin(std::fmax(hu / kCtWindow, 0), 1);
                densities.push_back(uint16_t(std::lround(share * 65535)));
            }
    return densities;
}

// Some of it is milled away, and some voxels lie on the burr's surface.
inline std::vector<uint16_t> milledBrick(std::vector<uint16_t> densities, std::mt19937& random) {
    const size_t from = random() % densities.size(), to = from + random() % (densities.size() - from);
    for (size_t n = from; n < to; ++n) densities[n] = 0;
    for (int i = 0; i < 40; ++i) densities[random() % densities.size()] = uint16_t(random());
    return densities;
}

}  // namespace bonemill::test
