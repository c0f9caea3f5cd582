// Discrete events, under a hand that rests on the bone or moves slowly: what they make of the force. The
// bench `jolts_bench` prints all of them for every preset and law (docs/explanation/safety.md, Jolts);
// tests/unit/haptic_server/core/tick has bounds for those that matter.
//
// A *jolt* is what the force on the hand changes by in a tick beyond what the hand's own motion explains:
//   |ΔF| - k_q |Δx| - τ k_t |Δv|
// with the true motion of the hand, which a false sample is none of, the quick stiffness k_q of the coupling
// and its drag τ k_t. Units are SI, poses in W.
#pragma once

#include <string>
#include <vector>

#include "tests/stability/variant.h"

namespace bonemill::test {

struct JoltFigures {
    double jolt = 0;      // N per tick, the largest
    bool on_side = true;  // the tool never went where the bone should have kept it from
    // s from the event, or from when the hand came to rest after it, until the force stays within 0.1 N of
    // what it is in the end.
    double recovery = 0;
    bool is_finite = true;
};

struct JoltEvent {
    const char* name;
    JoltFigures (*run)(const Variant& variant);
    bool needs_gradient = false;  // only the gradient law knows it
};
const std::vector<JoltEvent>& joltEvents();
const JoltEvent& joltEvent(const std::string& name);

// The three gradient presets, then the thesis' law and those of other schools.
std::vector<Variant> joltVariants();

}  // namespace bonemill::test
