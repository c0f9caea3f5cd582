// Reads what a live session has recorded, and says how quiet its loop was at rest under load.
//
// Frames and units are those of the trace (docs/reference/simulate.md). It is for tests, in one thread.
#pragma once

#include <Eigen/Core>
#include <nlohmann/json.hpp>
#include <optional>
#include <string>
#include <vector>

namespace bonemill::test {

struct LiveRow {
    double t;                // s since the server's first tick
    Eigen::Vector3d p_tool;  // W, m
    Eigen::Vector3d p_hand;  // W, m, as the encoders say
    Eigen::Vector3d force;   // W, N, on the hand
    double penetration;      // m, the deepest
    uint32_t faults;
};
std::vector<LiveRow> liveRowsOf(const std::string& trace);

// Returns when the device was engaged first, and when that ended, s of the rows' time; `end` if it never did.
struct Engagement {
    double begin, end;
};
std::optional<Engagement> firstEngagementOf(const nlohmann::json& report, double end);
// Returns the causes of all stops in the server's report, each as often as it came.
std::vector<std::string> causesOf(const nlohmann::json& report);

// Returns which share of the ticks of this time came later than kLate after the one before.
inline constexpr double kLate = 3e-3;  // s
double lateShareOf(const std::vector<LiveRow>& rows, const Engagement& time);

// These are figures of a time at rest, in windows of kWindow: of each window the RMS about its own mean, and
// of all windows the median. A loop that oscillates does so in all of them, while a pause of a process, which
// pushes the handle, spoils the windows that it falls into.
inline constexpr double kWindow = 0.1;  // s
struct RestFigures {
    size_t windows = 0;
    double force_rms = 0;                              // N
    double hand_rms = 0;                               // m
    double penetration = 0;                            // m, the largest in a window
    Eigen::Vector3d force = Eigen::Vector3d::Zero();   // N, W, mean
    Eigen::Vector3d p_tool = Eigen::Vector3d::Zero();  // m, W, mean
};
RestFigures restFiguresOf(const std::vector<LiveRow>& rows, double from, double until);

}  // namespace bonemill::test
