// What the probes of the report have in common.
#pragma once

namespace bonemill {

constexpr double kHeaviestShare = 0.6;    // of the coupling's saturation: no probe presses harder
constexpr int kLeafCells = 16;            // along each edge of a leaf
constexpr int kUnlimitedSamples = 32768;  // what is near the burr, or touches it, is always fewer

}  // namespace bonemill
