#include <pybind11/stl.h>

#include "common/base/units.h"
#include "common/rt/clock.h"
#include "haptic_server/apps/python/arrays.h"
#include "haptic_server/apps/python/runs.h"
#include "haptic_server/core/effects/effect_figures.h"
#include "haptic_server/core/telemetry/fault_names.h"

namespace bonemill::python {
namespace {

template <size_t n>
py::array vectorOf(const double (&values)[n]) {
    return py::array_t<double>(py::ssize_t(n), values);
}

py::dict figuresOf(const StepResult& result) {
    py::dict figures;
    for (const EffectFigure& figure : kEffectFigures)
        if (figure.name && figure.isToldBy(result.recorded))
            figures[figure.name] = figure.numberIn(result.record.effects);
    return figures;
}

std::vector<std::string> eventsOf(const StepResult& result) {
    static constexpr std::pair<uint32_t, const char*> kNames[] = {
        {kEventSpindleStalled, "spindle_stalled"},
        {kEventNearProtected, "near_protected"},
        {kEventProtectedTouched, "protected_touched"},
        {kEventProtectedDamaged, "protected_damaged"},
        {kEventTooHot, "too_hot"}};
    std::vector<std::string> names;
    for (const auto& [bit, name] : kNames)
        if (result.record.effects.events & bit) names.emplace_back(name);
    return names;
}

std::string textOf(const StepResult& result) {
    const Eigen::Vector3d force(result.record.f_hand_W);
    char text[160];
    std::snprintf(text, sizeof text, "<StepResult tick %llu: %.3f N, %u contacts, %.4f mm3 removed>",
                  static_cast<unsigned long long>(result.record.tick), force.norm(), result.record.contacts,
                  result.record.removed * kPerCubicMillimetre);
    return text;
}

}  // namespace

void defineResults(py::module_& module) {
    const auto number = [](auto read) {
        return [read](const StepResult& result) { return read(result.record); };
    };
    using R = const TickRecord&;
    py::class_<StepResult>(module, "StepResult", "What one tick came to.")
        .def_property_readonly("tick", number([](R r) { return r.tick; }), "Number of the tick, from 0.")
        .def_property_readonly("t_s", number([](R r) { return r.t_s; }),
                               "Time of the tick, s since the first one.")
        .def_property_readonly("force_n", number([](R r) { return vectorOf(r.f_hand_W); }),
                               "Force on the hand, N, frame W; shape (3,).")
        .def_property_readonly("torque_nm", number([](R r) { return vectorOf(r.t_hand_W); }),
                               "Torque on the hand about the tool point that it holds, N m, W; shape (3,).")
        .def_property_readonly("tool_position_m", number([](R r) { return vectorOf(r.p_WT); }),
                               "The simulated tool after the tick, m, W; shape (3,).")
        .def_property_readonly("tool_orientation_wxyz", number([](R r) { return vectorOf(r.q_WT); }),
                               "Its unit quaternion w, x, y, z, T to W; shape (4,).")
        .def_property_readonly("hand_position_m", number([](R r) { return vectorOf(r.p_WT_device); }),
                               "Where the hand holds the tool, as accepted, m, W; shape (3,).")
        .def_property_readonly("hand_orientation_wxyz", number([](R r) { return vectorOf(r.q_WT_device); }),
                               "Its unit quaternion w, x, y, z, T to W; shape (4,).")
        .def_property_readonly("contacts", number([](R r) { return r.contacts; }), "Samples in contact.")
        .def_property_readonly("penetration_m", number([](R r) { return r.max_penetration; }),
                               "Deepest contact, m.")
        .def_property_readonly("removed_mm3", number([](R r) { return r.removed * kPerCubicMillimetre; }),
                               "Bone that fell below the iso-value in this tick, mm3.")
        .def_property_readonly("added_mm3", number([](R r) { return r.added * kPerCubicMillimetre; }),
                               "Bone that rose to the iso-value in this tick, mm3.")
        .def_property_readonly("removed_voxels", number([](R r) { return r.removed_voxels; }),
                               "Voxels that fell below the iso-value in this tick.")
        .def_property_readonly("added_voxels", number([](R r) { return r.added_voxels; }),
                               "Voxels that rose to the iso-value in this tick.")
        .def_property_readonly("tool", number([](R r) { return r.tool; }),
                               "The tool's place in the scene's list, from 0.")
        .def_property_readonly("buttons", number([](R r) { return r.buttons; }),
                               "Pressed in this tick: 1 removes, 2 adds.")
        .def_property_readonly("tick_us", number([](R r) { return microsecondsOfNs(double(r.compute_ns)); }),
                               "Measured duration of the tick, us; equal runs differ in it.")
        .def_property_readonly("faults", number([](R r) { return faultList(r.faults); }),
                               "Names of what was wrong in this tick; most ticks have none.")
        .def_property_readonly("events", eventsOf,
                               "What the trainee should know: spindle_stalled, near_protected, "
                               "protected_touched, protected_damaged, too_hot.")
        .def_property_readonly("effects", figuresOf,
                               "Figures of the scene's effects by name, units in the names; NaN where one "
                               "has no meaning. See figures().")
        .def("__repr__", textOf);
    module.def("fault_names", faultList, py::arg("faults"),
               "Names of the bits in run()'s column faults, of one tick.");
    module.def(
        "figures",
        [] {
            py::dict dict;
            for (const EffectFigure& figure : kEffectFigures)
                if (figure.name) dict[figure.name] = py::make_tuple(figure.unit, figure.description);
            return dict;
        },
        "Every figure that effects tell, by name: its unit and what it says.");
}

}  // namespace bonemill::python
