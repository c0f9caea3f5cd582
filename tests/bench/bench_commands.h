// The sub-commands of haptic_bench; each adds itself to the command line.
#pragma once

#include <CLI/CLI.hpp>

namespace bonemill::bench {

// Whole ticks over a flat half-filled block.
void addTickCommand(CLI::App& app);
// The whole surface beside VTK's flying edges, and single leaves after a cut.
void addMeshCommand(CLI::App& app);
// Ticks of every contact law.
void addLawsCommand(CLI::App& app);
// The way from a file to the first tick, and the memory that it takes.
void addLoadCommand(CLI::App& app);
// The tick in real time beside a bare timer, which shows how late the machine itself is.
void addLoopCommand(CLI::App& app);
// From the tick that cuts until the mesher has handed the cut's meshes to the publisher.
void addRemeshCommand(CLI::App& app);
// How the tick grows with the volume and with the burr.
void addScaleCommand(CLI::App& app);
// Ticks of every preset.
void addPresetsCommand(CLI::App& app);
// Bytes on the wire, and a session that mills with 1, 10 and 30 viewers.
void addStreamCommand(CLI::App& app);
// A session that mills with guests behind a gateway, near or on a bad line.
void addGuestsCommand(CLI::App& app);
// What each effect adds to a tick that mills a block.
void addEffectsCommand(CLI::App& app);
// Scenes with many effects and a wide burr, in multiples of what the tooth's corridor takes in the same run.
void addHeavyCommand(CLI::App& app);
// How a scan's densities are coded for viewers: bytes and processor time.
void addDensitiesCommand(CLI::App& app);

}  // namespace bonemill::bench
