// `haptic_bench guests` measures a session that mills with guests behind a gateway, near or on a bad line.
#pragma once

#include <CLI/CLI.hpp>

namespace bonemill::bench {

void addGuestsCommand(CLI::App& app);

}  // namespace bonemill::bench
