// `haptic_server simulate` drives the very tick of a live session by a file, without real time or processes.
#pragma once

#include <string>
#include <vector>

#include "haptic_server/recording/statistics/bone_files.h"

namespace bonemill {

struct SimulateOptions {
    std::string scene;
    std::string trajectory;
    std::string tool;         // name or number from 1; empty: the first
    std::string trace;        // empty: none
    std::string deviation{};  // picture of what was cut too far and not far enough (.png); empty: none
    SavePaths save;
    std::string assess{};  // folder for results and report, as beside a class table; empty: none
    std::string pseudonym = "simulated";  // whose they are
};

struct SimulateResult {
    std::string json;                   // object with totals and `state_hash` (docs/research/simulate.md)
    std::vector<std::string> problems;  // one message for each file that is not there or not whole
};

// Runs all rows, then writes the files. Throws UserError when the input is wrong.
SimulateResult simulate(const SimulateOptions& options);

}  // namespace bonemill
