// Prints, for each event of tests/stability/jolts.h, each preset and each contact law, the largest jolt in N
// per tick, and in a second table how long the force takes to recover, in ms. A figure has an `x` behind it
// when the tool did not stay on its side of the bone.
//
//   jolts_bench [EVENT...]
#include <cstdio>
#include <cstring>

#include "common/base/units.h"
#include "common/process/run_program.h"
#include "tests/stability/jolts.h"

namespace bonemill::test {
namespace {

struct Row {
    const JoltEvent& event;
    std::vector<JoltFigures> figures;  // of joltVariants(); not finite where it was not measured
};

Row measure(const JoltEvent& event) {
    Row row{event, {}};
    for (const Variant& variant : joltVariants()) {
        const bool is_other = variant.isBaseline() || variant.isOtherLaw();
        const bool is_measured = !(event.needs_gradient && is_other);
        row.figures.push_back(is_measured ? event.run(variant) : JoltFigures{.is_finite = false});
    }
    return row;
}

template <class Figure>
void print(const char* title, const char* format, const std::vector<Row>& rows, Figure&& figure_of) {
    std::printf("\n| %s |", title);
    for (const Variant& variant : joltVariants()) std::printf(" %s |", variant.name.c_str());
    std::printf("\n|---|");
    for (size_t n = 0; n < joltVariants().size(); ++n) std::printf("--:|");
    std::printf("\n");
    for (const Row& row : rows) {
        std::printf("| %s |", row.event.name);
        for (const JoltFigures& figures : row.figures) {
            std::printf(" ");
            if (figures.is_finite) std::printf(format, figure_of(figures));
            if (figures.is_finite && !figures.on_side) std::printf("x");
            std::printf(" |");
        }
        std::printf("\n");
    }
}

}  // namespace
}  // namespace bonemill::test

int main(int argc, char** argv) {
    using namespace bonemill;
    using namespace bonemill::test;
    return runProgram([&] {
        std::vector<Row> rows;
        for (const JoltEvent& event : joltEvents()) {
            bool is_asked_for = argc < 2;
            for (int n = 1; n < argc; ++n) is_asked_for |= joltEvent(argv[n]).name == event.name;
            if (is_asked_for) rows.push_back(measure(event));
        }
        print("jolt, N per tick", "%.2f", rows, [](const JoltFigures& f) { return f.jolt; });
        print("recovery, ms", "%.0f", rows,
              [](const JoltFigures& f) { return f.recovery * kPerMillisecond; });
        return 0;
    });
}
