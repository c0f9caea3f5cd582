// `haptic_server simulate` drives the very tick of a live session by a file, without real time or processes.
#pragma once

#include <string>

#include "haptic_server/record/bone_files.h"

namespace bonemill {

struct SimulateOptions {
    std::string scene;
    std::string trajectory;
    std::string tool;   // name or number from 1; empty: the first
    std::string trace;  // empty: none
    SavePaths save;
};

// Runs all rows and returns the JSON object with totals and `state_hash`
// (docs/simulate.md). Throws UserError.
std::string simulate(const SimulateOptions& options);

}  // namespace bonemill
