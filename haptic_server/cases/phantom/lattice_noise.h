// Makes numbers of chance that are the same on every machine, whatever the order of evaluation.
// Thread-safe and RT-safe.
#pragma once

#include <Eigen/Core>
#include <cstdint>

namespace bonemill {

// This is one step of SplitMix64: neighbouring words give unrelated ones.
uint64_t splitMix64(uint64_t word) noexcept;

// It is in 0 .. 1.
double unitOf(uint64_t random) noexcept;

// It is smooth noise in 0 .. 1: a number of chance at each point of a cubic lattice, linear between them.
// p and the lattice's step are in one length unit; indices beyond ±2^15 repeat.
double smoothNoise(const Eigen::Vector3d& p, double step) noexcept;

}  // namespace bonemill
