#pragma once

namespace bonemill::bench {

/// A leaf has so many cells along each edge, as in the shipped scenes.
constexpr int kLeafCells = 16;

}  // namespace bonemill::bench
