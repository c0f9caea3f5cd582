// These are the factors between SI, in which the code computes, and the units that people read and write.
//
// A constant named after a unit is that unit in SI: 3 * kMillimetre is a length in m. One that begins with
// kPer is its inverse, and a quantity times it is a number of such units: length * kPerMillimetre is a number
// of mm. Both stand here because one is exact where the other is rounded.
#pragma once

#include <cstdint>
#include <numbers>

namespace bonemill {

inline constexpr double kMilli = 1e-3, kPerMilli = 1e3;
inline constexpr double kMicro = 1e-6, kPerMicro = 1e6;
inline constexpr double kMega = 1e6;

// m
inline constexpr double kMillimetre = kMilli, kPerMillimetre = kPerMilli;
inline constexpr double kMicrometre = kMicro, kPerMicrometre = kPerMicro;

// m³
inline constexpr double kCubicMillimetre = 1e-9, kPerCubicMillimetre = 1e9;
inline constexpr double kMillilitre = 1e-6, kPerCubicCentimetre = 1e6;

// s
inline constexpr double kMillisecond = kMilli, kPerMillisecond = kPerMilli;
inline constexpr double kMicrosecond = kMicro, kPerMicrosecond = kPerMicro;
inline constexpr double kMinute = 60;

// Times of the monotonic clock are whole ns.
inline constexpr int64_t kNsPerSecond = 1'000'000'000;
inline constexpr int64_t kNsPerMillisecond = 1'000'000;
inline constexpr int64_t kNsPerMicrosecond = 1'000;

// rad and rad/s
inline constexpr double kTurn = 2 * std::numbers::pi;
inline constexpr double kDegree = std::numbers::pi / 180;
inline constexpr double kRpm = kTurn / kMinute;

}  // namespace bonemill
