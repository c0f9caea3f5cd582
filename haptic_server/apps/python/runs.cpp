#include "haptic_server/apps/python/runs.h"

#include <pybind11/stl.h>

#include <mutex>

#include "common/base/units.h"
#include "common/config/scene_geometry.h"
#include "common/config/scene_tools.h"
#include "common/device_messages/device_messages.h"
#include "haptic_server/apps/python/arrays.h"
#include "haptic_server/lab/stepping/tick_table.h"

namespace bonemill::python {
namespace {

constexpr size_t kTicksBetweenSignals = 1000;

HandStep handOf(const double* position, const double* orientation, uint32_t buttons) {
    HandStep hand;
    hand.X_WT.position = Eigen::Vector3d(position);
    if (orientation)
        hand.X_WT.rotation =
            Eigen::Quaterniond(orientation[0], orientation[1], orientation[2], orientation[3]);
    hand.buttons = buttons;
    return hand;
}

// Runs so many ticks, each by tick(n), without the GIL; Ctrl+C ends it.
template <class Tick>
py::dict runTicks(Run& run, size_t ticks, Tick&& tick) {
    const InUse in_use(run.isUsed());
    TickTable table(run.run().recorded());
    table.reserve(ticks);
    {
        const py::gil_scoped_release release;
        for (size_t n = 0; n < ticks; ++n) {
            table.add(tick(n));
            if (n % kTicksBetweenSignals != kTicksBetweenSignals - 1) continue;
            const py::gil_scoped_acquire acquire;
            if (PyErr_CheckSignals() != 0) throw py::error_already_set();
        }
    }
    py::dict columns;
    for (TickTable::Column& column : table.columns())
        std::visit(
            [&](auto& values) { columns[column.name.c_str()] = arrayOf(std::move(values), column.width); },
            column.values);
    return columns;
}

using Buttons = py::array_t<uint32_t, py::array::c_style | py::array::forcecast>;

// One number a row; null: none are given.
template <class Array>
auto rowsOfOne(const std::optional<Array>& array, py::ssize_t rows, const char* what) {
    if (!array) return decltype(array->data()){nullptr};
    if (array->ndim() != 1 || array->shape(0) != rows)
        throw UserError(std::string(what) + ": expected an array of shape (" + std::to_string(rows) +
                        ",), got " + shapeText(*array));
    return array->data();
}

py::dict runHand(Run& run, const Numbers& positions, const std::optional<Numbers>& orientations,
                 const std::optional<Buttons>& buttons, const std::optional<Numbers>& times) {
    const double* const p = rowsIn(positions, -1, 3, "positions_m");
    const py::ssize_t rows = positions.shape(0);
    const double* const q = orientations ? rowsIn(*orientations, rows, 4, "orientations_wxyz") : nullptr;
    const bool is_one = buttons && buttons->ndim() == 0;
    const uint32_t* const b = is_one ? buttons->data() : rowsOfOne(buttons, rows, "buttons");
    const double* const t = rowsOfOne(times, rows, "t_s");
    return runTicks(run, size_t(rows), [&](size_t n) -> const TickRecord& {
        HandStep hand = handOf(p + 3 * n, q ? q + 4 * n : nullptr, !b ? 0 : b[is_one ? 0 : n]);
        if (t) hand.t_s = t[n];
        return run.run().step(hand);
    });
}

StepResult stepHand(Run& run, const Numbers& position, const std::optional<Numbers>& orientation,
                    uint32_t buttons) {
    const InUse in_use(run.isUsed());
    const double* const q = orientation ? vectorIn(*orientation, 4, "orientation_wxyz") : nullptr;
    const HandStep hand = handOf(vectorIn(position, 3, "position_m"), q, buttons);
    return {run.run().step(hand), run.run().recorded()};
}

py::array voxelsOf(Run& run) {
    const InUse in_use(run.isUsed());
    const Eigen::Vector3i& dims = run.run().scanned().dims();
    const IndexBox changed = run.run().takeChanged();
    if (!run.voxels) {
        run.voxels = py::array_t<Density, py::array::f_style>({dims.x(), dims.y(), dims.z()});
        run.voxels.attr("flags").attr("writeable") = false;
    }
    auto* const data = static_cast<Density*>(const_cast<void*>(py::array(run.voxels).data()));
    run.run().copyVoxels(changed, {data, run.run().scanned().geometry().voxelCount()});
    return run.voxels;
}

py::tuple meshOf(Run& run) {
    const InUse in_use(run.isUsed());
    RunSurface surface;
    {
        const py::gil_scoped_release release;
        surface = run.run().surface();
    }
    return py::make_tuple(rowsOf<double>(std::move(surface.vertices_W)),
                          rowsOf<uint32_t>(std::move(surface.triangles)));
}

py::tuple toolMeshOf(py::object self) {
    SteppedRun& run = self.cast<Run&>().run();
    const TriangleSurface& surface = run.setup().tools[run.tool()].surface;
    const auto vertices = py::ssize_t(surface.positions.size()),
               triangles = py::ssize_t(surface.indices.size() / 3);
    constexpr auto kFloat = py::ssize_t(sizeof(float)), kIndex = py::ssize_t(sizeof(uint32_t));
    return py::make_tuple(viewOf(reinterpret_cast<const float*>(surface.positions.data()), {vertices, 3},
                                 {3 * kFloat, kFloat}, self),
                          viewOf(surface.indices.data(), {triangles, 3}, {3 * kIndex, kIndex}, self));
}

py::dict poseDict(const Pose& pose) {
    const Eigen::Quaterniond& q = pose.rotation;
    py::dict dict;
    dict["position_m"] = py::array_t<double>(3, pose.position.data());
    dict["orientation_wxyz"] = arrayOf(std::vector<double>{q.w(), q.x(), q.y(), q.z()});
    return dict;
}

// The scripted hand of the scene: (t_s, position, orientation, buttons) of each waypoint.
py::list waypointsOf(Run& run) {
    py::list list;
    for (const auto& waypoint : run.run().loaded().scene.simulated_operator().waypoint()) {
        const Pose X_WT = poseOf(waypoint);
        const Eigen::Quaterniond& q = X_WT.rotation;
        const uint32_t buttons =
            (waypoint.remove() ? kButtonRemove : 0u) | (waypoint.add() ? kButtonAdd : 0u);
        list.append(py::make_tuple(waypoint.time_s(), py::array_t<double>(3, X_WT.position.data()),
                                   arrayOf(std::vector<double>{q.w(), q.x(), q.y(), q.z()}), buttons));
    }
    return list;
}

const char* roleName(ZoneRole role) {
    switch (role) {
        case ZoneRole::kTarget:
            return "target";
        case ZoneRole::kLeewaySides:
            return "leeway_sides";
        case ZoneRole::kLeewayBottom:
            return "leeway_bottom";
        case ZoneRole::kContainerSides:
            return "container_sides";
        case ZoneRole::kContainerBottom:
            return "container_bottom";
        case ZoneRole::kProtected:
            return "protected";
        case ZoneRole::kContext:
            return "context";
    }
    return "context";
}

py::dict progressOf(Run& run) {
    const InUse in_use(run.isUsed());
    const TaskProgress& progress = run.run().progress();
    py::list zones;
    for (const ZoneProgress& zone : progress.zones) {
        py::dict entry;
        entry["name"] = zone.name;
        entry["role"] = roleName(zone.role);
        entry["bone_mm3"] = zone.bone * kPerCubicMillimetre;
        entry["removed_mm3"] = zone.removed * kPerCubicMillimetre;
        zones.append(entry);
    }
    py::dict dict;
    dict["zones"] = zones;
    dict["target_centre_m"] = py::array_t<double>(3, progress.p_ideal_W.data());
    dict["ideal_mm3"] = progress.ideal * kPerCubicMillimetre;
    dict["ideal_removed_mm3"] = progress.ideal_removed * kPerCubicMillimetre;
    dict["removed_mm3"] = progress.removed * kPerCubicMillimetre;
    return dict;
}

py::object judgementOf(Run& run) {
    const InUse in_use(run.isUsed());
    std::string text;
    {
        const py::gil_scoped_release release;
        text = run.run().judge().dump();
    }
    return py::module_::import("json").attr("loads")(text);
}

void chooseTool(Run& run, const std::string& name) {
    const InUse in_use(run.isUsed());
    run.run().chooseTool(toolIndexOf(run.run().toolNames(), name));
}

std::shared_ptr<Simulation> makeSimulation(const std::string& file, const std::vector<std::string>& settings,
                                           const std::string& tool, bool keeps_inputs) {
    const py::gil_scoped_release release;
    const LoadedScene loaded = loadScene(file, settings);
    const size_t first = tool.empty() ? 0 : toolIndexOf(toolNamesOf(loaded.scene), tool);
    return std::make_shared<Simulation>(std::make_shared<SimulatedRun>(loaded, first, keeps_inputs));
}

template <class Call>
auto whileFree(Simulation& simulation, Call&& call) {
    const InUse in_use(simulation.isUsed());
    const py::gil_scoped_release release;
    return call(simulation.own());
}

std::shared_ptr<Replay> makeReplay(std::shared_ptr<const Recording> recording) {
    const py::gil_scoped_release release;
    auto run = std::make_shared<RecordedRun>(*recording);
    return std::make_shared<Replay>(std::move(recording), std::move(run));
}

// Up to this time, or to the recording's end.
py::dict runRecorded(Replay& self, std::optional<double> until_s) {
    const Recording& recording = self.own().recording();
    uint64_t end = recording.ticks();
    if (until_s) end = *until_s > recording.lengthS() ? end : recording.tickAt(*until_s);
    const uint64_t next = self.own().next();
    return runTicks(self, end > next ? end - next : 0,
                    [&](size_t) -> const TickRecord& { return self.own().stepAsRecorded(); });
}

StepResult stepRecorded(Replay& self) {
    const InUse in_use(self.isUsed());
    return {self.own().stepAsRecorded(), self.run().recorded()};
}

void defineReplay(py::module_& module) {
    py::class_<Replay, Run, std::shared_ptr<Replay>>(module, "Replay",
                                                     "A recorded session, run again; made by replay().")
        .def(py::init(&makeReplay), py::arg("recording"))
        .def("step_recorded", stepRecorded, "Runs the next tick as it was recorded.")
        .def("run_recorded", runRecorded, py::arg("until_s") = py::none(),
             "Runs on as recorded, to the end or to this time (s since the first tick); returns columns as "
             "run() does.")
        .def(
            "restart",
            [](Replay& self) {
                const InUse in_use(self.isUsed());
                self.own().restart();
            },
            "Back before the first tick.")
        .def_property_readonly(
            "has_left", [](Replay& self) { return self.own().hasLeft(); },
            "Another hand has gone on: step() or run() was called.")
        .def_property_readonly(
            "is_at_end", [](Replay& self) { return self.own().isAtEnd(); }, "No recorded tick is left.");
}

}  // namespace

InUse::InUse(std::atomic<bool>& is_used) : is_used_(is_used) {
    if (is_used_.exchange(true))
        throw UserError("another thread is in this run: a run belongs to one thread at a time");
}

void defineRuns(py::module_& module) {
    py::class_<Run, std::shared_ptr<Run>>(module, "Run",
                                          "A scene that is milled tick by tick: a simulation, or a replay.")
        .def("step", stepHand, py::arg("position_m"), py::arg("orientation_wxyz") = py::none(),
             py::arg("buttons") = 0,
             "Runs one tick with the hand there and returns what it came to.\n"
             "position_m: (3,), m, frame W. orientation_wxyz: (4,), T to W, by default as W. buttons: 1 "
             "removes, 2 adds.")
        .def(
            "run", runHand, py::arg("positions_m"), py::arg("orientations_wxyz") = py::none(),
            py::arg("buttons") = py::none(), py::arg("t_s") = py::none(),
            "Runs a tick for each row and returns their columns by name, each an array with one row a tick.\n"
            "positions_m: (N, 3), m, W. orientations_wxyz: (N, 4). buttons: one number, or (N,).\n"
            "t_s: (N,), a period apart by default. Releases the GIL.")
        .def("voxels", voxelsOf,
             "Densities of all voxels, uint16, shape (x, y, z); bone from iso_density on. The same array at "
             "each call,\n"
             "brought up to date where bone was milled since the last one; it cannot be written.")
        .def("mesh", meshOf,
             "The bone's surface: vertices (N, 3) in m, W, and triangles (M, 3), counter-clockwise seen from "
             "outside.")
        .def("tool_mesh", toolMeshOf,
             "The tool's surface in its own frame T, m: views of vertices (N, 3) and triangles (M, 3).")
        .def("progress", progressOf,
             "How far the scene's task is, mm3: zones with what is gone of each, what shall be gone and what "
             "of it is.")
        .def("judge", judgementOf,
             "Judges the run as a session judges an attempt: gates, sub_scores, figures, total. Seconds with "
             "a large bone.\n"
             "The attempt ends here; later ticks are not judged.")
        .def_property_readonly(
            "has_task", [](Run& run) { return run.run().setup().task != nullptr; }, "Can it be judged?")
        .def_property_readonly(
            "ticks", [](Run& run) { return run.run().ticks(); }, "How many have run.")
        .def_property_readonly("waypoints", waypointsOf,
                               "The scripted hand of the scene: (t_s, position_m, orientation_wxyz, buttons) "
                               "of each waypoint.")
        .def_property_readonly(
            "period_s", [](Run& run) { return run.run().setup().tick.dt; }, "What a tick stands for, s.")
        .def_property_readonly(
            "state_hash", [](Run& run) { return run.run().stateHash(); },
            "Digest of all ticks and of the bone: the state_hash of `haptic_server simulate`. It reads all "
            "voxels.")
        .def_property_readonly(
            "tools", [](Run& run) { return run.run().toolNames(); }, "Names of the scene's tools.")
        .def_property(
            "tool", [](Run& run) { return run.run().toolNames()[run.run().tool()]; }, chooseTool,
            "The tool of the next tick; assign a name or a number from 1.")
        .def_property_readonly(
            "burr_radius_m", [](Run& run) { return run.run().setup().tools[run.run().tool()].burr.radius; },
            "Of the tool in use, m.")
        .def_property_readonly(
            "warnings", [](Run& run) { return run.run().setup().warnings; },
            "What the scene would better have otherwise.")
        .def_property_readonly(
            "spacing_m",
            [](Run& run) { return py::array_t<double>(3, run.run().bone().volume.spacing().data()); },
            "Between voxels, m; shape (3,).")
        .def_property_readonly(
            "iso_density", [](Run& run) { return run.run().bone().volume.iso(); },
            "Density of the bone's surface.")
        .def_property_readonly(
            "volume_pose", [](Run& run) { return poseDict(run.run().bone().volume.geometry().X_WV); },
            "Frame V in W: voxel (i, j, k) lies at spacing_m * (i, j, k) in V.");
    py::class_<RunCheckpoint>(module, "Checkpoint", "What a simulation has done so far.")
        .def_property_readonly("ticks", &RunCheckpoint::ticks, "How many it runs.");
    py::class_<Simulation, Run, std::shared_ptr<Simulation>>(
        module, "Simulation", "A run from the scanned bone on; made by Scene.simulation().")
        .def(py::init(&makeSimulation), py::arg("scene"), py::arg("settings") = std::vector<std::string>{},
             py::arg("tool") = "", py::arg("keep_inputs") = true)
        .def(
            "reset", [](Simulation& self) { whileFree(self, [](SimulatedRun& run) { run.reset(); }); },
            "The bone as scanned, no tick run.")
        .def(
            "checkpoint",
            [](Simulation& self) {
                return whileFree(self, [](SimulatedRun& run) { return run.checkpoint(); });
            },
            "What was done so far, as inputs: 72 bytes a tick.")
        .def(
            "restore",
            [](Simulation& self, const RunCheckpoint& to) {
                whileFree(self, [&](SimulatedRun& run) { run.restore(to); });
            },
            py::arg("checkpoint"),
            "Runs its ticks again, to the same bits; only those that are missing, where this run began "
            "alike.");
    defineReplay(module);
}

}  // namespace bonemill::python
