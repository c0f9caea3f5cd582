// `haptic_server simulate` drives the very tick of a live session by a file, without real time or processes.
#pragma once

#include <string>
#include <vector>

#include "haptic_server/recording/statistics/bone_files.h"

namespace bonemill {

struct SimulateOptions {
    std::string scene;
    std::string trajectory;
    std::vector<std::string> settings{};  // of the scene, PATH=VALUE (setField())
    std::string tool;                     // name or number from 1; empty: the first
    std::string trace;                    // empty: none
    std::string deviation{};  // picture of what was cut too far and not far enough (.png); empty: none
    SavePaths save;
    std::string assess{};  // folder for results and report, as beside a class table; empty: none
    std::string pseudonym = "simulated";  // whose they are
};

struct SimulateResult {
    std::string json;                   // object with totals and `state_hash` (docs/reference/simulate.md)
    std::vector<std::string> problems;  // one message for each file that is not there or not whole
};

// One field takes several values in turn.
struct Sweep {
    std::string field;
    std::vector<std::string> values;
};

// Reads PATH=VALUE,VALUE,... Throws UserError.
Sweep readSweep(const std::string& text);

// Simulates the scene with each value. Returns a table for people, and as its last line a JSON array of what
// simulate() tells of each, with `value`. Throws UserError as simulate(), and where a file is asked for: each
// run would write over the one before.
std::string simulateSweep(const SimulateOptions& options, const Sweep& sweep);

// Runs all rows, then writes the files. Throws UserError when the input is wrong.
SimulateResult simulate(const SimulateOptions& options);

}  // namespace bonemill
