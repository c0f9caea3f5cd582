// Measures and asserts nothing. Each sub-command prints a table; docs/measurements.md says which ones
// to quote.
#include <CLI/CLI.hpp>
#include <cstdio>

#include "common/base/user_error.h"
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
    try {
        app.parse(argc, argv);
    } catch (const CLI::ParseError& error) {
        const bool is_help = error.get_exit_code() == 0;
        app.exit(error);
        return is_help ? 0 : 2;
    } catch (const UserError& error) {
        std::fprintf(stderr, "haptic_bench: %s\n", error.what());
        return 2;
    }
    return 0;
}
