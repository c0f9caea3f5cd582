// Measures and asserts nothing. Each sub-command prints a table; docs/measurements.md says which ones
// to quote.
#include <CLI/CLI.hpp>

#include "common/cli/command_line.h"
#include "common/process/run_program.h"
#include "tests/bench/bench_commands.h"

int main(int argc, char** argv) {
    using namespace bonemill;
    CLI::App app("benchmarks of the haptic server");
    app.require_subcommand(1);
    bench::addTickCommand(app);
    bench::addMeshCommand(app);
    bench::addLawsCommand(app);
    bench::addLoadCommand(app);
    bench::addLoopCommand(app);
    bench::addRemeshCommand(app);
    bench::addScaleCommand(app);
    bench::addPresetsCommand(app);
    bench::addStreamCommand(app);
    bench::addGuestsCommand(app);
    bench::addEffectsCommand(app);
    bench::addHeavyCommand(app);
    bench::addDensitiesCommand(app);
    return runProgram([&] {
        parseCommandLine(app, argc, argv, "haptic_bench");
        return 0;
    });
}
