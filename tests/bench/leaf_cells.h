#pragma once

namespace bonemill::bench {

/// Cells along each edge of a leaf, as in the shipped scenes.
constexpr int kLeafCells = 16;

}  // namespace bonemill::bench
