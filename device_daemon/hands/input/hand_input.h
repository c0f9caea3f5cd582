// What a SpaceMouse or gamepad says of the hand on it, the same for both; the reading thread gives it to the
// loop.
//
// Deflections are along x, y, z and about x, y, z of the user's axes U, x right, y up and z towards the user
// in the picture: 0 at rest, -1 and 1 as far as it goes. It is a plain value that may travel through a
// Seqlock.
#pragma once

#include <array>
#include <cstdint>

namespace bonemill {

struct HandInput {
    std::array<float, 6> deflections;
    uint32_t buttons;   // Button bits
    uint32_t is_fine;   // 1: the hand wants to go slowly
    uint32_t is_there;  // 0: nothing is plugged in, and the rest is 0
};

}  // namespace bonemill
