// The runs of the Z-width: a tool is pressed against bone, and the loop either comes to rest or does not
// (docs/explanation/stability.md; tests/bench/zwidth_bench.cpp searches for where it ends).
#pragma once

#include <vector>

#include "tests/stability/drive.h"

namespace bonemill::test {

struct PressPlace {
    const char* name;
    VoxelVolume (*bone)();
    TestTool (*tool)();
    Pose start;
    Wrench push;
};
const std::vector<PressPlace>& pressPlaces();

struct PressHand {
    const char* name;
    HandPlant plant;
};
const std::vector<PressHand>& pressHands();

// Tells whether the tool is at rest against the bone.
struct Pressed {
    Pressed(Scene& scene, const PressPlace& place, const HandPlant& hand);
    bool isStable();
    // Call it after isStable(). It returns the static stiffness at the hand, N/m.
    double rendered();

    const PressPlace& place;
    ClosedLoop loop;
};

}  // namespace bonemill::test
