// What Python says of the hand, its shapes and kinds checked. Only with the GIL held. All throw UserError.
#pragma once

#include <pybind11/pybind11.h>

#include <vector>

#include "haptic_server/lab/stepping/stepped_run.h"

namespace bonemill::python {

// One tick's hand; orientation may be None.
HandStep handOf(const pybind11::object& position, const pybind11::object& orientation,
                const pybind11::object& buttons);

// One hand a row. Orientations, buttons and times may be None; buttons may be one number for all.
std::vector<HandStep> handsOf(const pybind11::object& positions, const pybind11::object& orientations,
                              const pybind11::object& buttons, const pybind11::object& times);

}  // namespace bonemill::python
