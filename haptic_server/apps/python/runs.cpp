#include "haptic_server/apps/python/runs.h"

#include <pybind11/stl.h>

#include <algorithm>
#include <cctype>
#include <chrono>
#include <cmath>

#include "common/base/units.h"
#include "common/config/scene_geometry.h"
#include "common/config/scene_tools.h"
#include "common/device_messages/device_messages.h"
#include "haptic_server/apps/python/arrays.h"
#include "haptic_server/apps/python/inputs.h"
#include "haptic_server/lab/stepping/tick_table.h"
#include "proto/scene.pb.h"

namespace bonemill::python {
namespace {

// Between ticks, without the GIL: Ctrl+C ends them.
class Interruption {
  public:
    void look() {
        const auto now = std::chrono::steady_clock::now();
        if (now < next_) return;
        next_ = now + kBetween;
        const py::gil_scoped_acquire acquire;
        if (PyErr_CheckSignals() != 0) throw py::error_already_set();
    }

  private:
    static constexpr std::chrono::milliseconds kBetween{100};
    std::chrono::steady_clock::time_point next_ = std::chrono::steady_clock::now() + kBetween;
};

// Runs so many ticks, each by tick(n), without the GIL; Ctrl+C ends it. The caller is the run's only user.
template <class Tick>
py::dict runTicks(Run& run, size_t ticks, Tick&& tick) {
    TickTable table(run.own().recorded());
    table.reserve(ticks);
    {
        const py::gil_scoped_release release;
        Interruption interruption;
        for (size_t n = 0; n < ticks; ++n) {
            table.add(tick(n));
            interruption.look();
        }
    }
    py::dict columns;
    for (TickTable::Column& column : table.columns())
        std::visit(
            [&](auto& values) { columns[column.name.c_str()] = arrayOf(std::move(values), column.width); },
            column.values);
    return columns;
}

// All rows are looked at before the first one runs.
py::dict runHand(Run& run, const py::object& positions, const py::object& orientations,
                 const py::object& buttons, const py::object& times) {
    const std::vector<HandStep> hands = handsOf(positions, orientations, buttons, times);
    const InUse in_use(run.isUsed());
    for (size_t n = 0; n < hands.size(); ++n) {
        const std::string problem =
            n == 0 ? run.own().problemOf(hands[0]) : run.own().problemOf(hands[n], hands[n - 1].t_s);
        if (!problem.empty()) throw UserError("row " + std::to_string(n) + ": " + problem);
    }
    size_t unbelieved = 0;
    py::dict columns = runTicks(run, hands.size(), [&](size_t n) -> const TickRecord& {
        const TickRecord& record = run.own().step(hands[n]);
        unbelieved += (record.faults & kFaultBadDevicePose) != 0;
        return record;
    });
    if (unbelieved > 0 &&
        PyErr_WarnEx(
            PyExc_RuntimeWarning,
            (std::to_string(unbelieved) + " of " + std::to_string(hands.size()) +
             " rows were not believed and the pose before kept (bad_device_pose): a hand goes at most "
             "3 m/s and turns at most 60 rad/s; one row is one period")
                .c_str(),
            1) != 0)
        throw py::error_already_set();
    return columns;
}

StepResult stepHand(Run& run, const py::object& position, const py::object& orientation,
                    const py::object& buttons) {
    const HandStep hand = handOf(position, orientation, buttons);
    const InUse in_use(run.isUsed());
    return {run.own().step(hand), run.own().recorded()};
}

py::array voxelsOf(Run& run) {
    const InUse in_use(run.isUsed());
    const Eigen::Vector3i& dims = run.own().scanned().dims();
    if (!run.voxels) {
        run.voxels = py::array_t<Density, py::array::f_style>({dims.x(), dims.y(), dims.z()});
        run.voxels.attr("flags").attr("writeable") = false;
    }
    auto* const data = static_cast<Density*>(const_cast<void*>(py::array(run.voxels).data()));
    run.own().copyVoxels(run.own().takeChanged(), {data, run.own().scanned().geometry().voxelCount()});
    return run.voxels;
}

py::tuple meshOf(Run& run) {
    const InUse in_use(run.isUsed());
    RunSurface surface;
    {
        const py::gil_scoped_release release;
        surface = run.own().surface();
    }
    return py::make_tuple(rowsOf<double>(std::move(surface.vertices_W)),
                          rowsOf<uint32_t>(std::move(surface.triangles)));
}

py::tuple toolMeshOf(const py::object& self) {
    const InUse in_use(self.cast<Run&>().isUsed());
    SteppedRun& run = self.cast<Run&>().own();
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
    for (const auto& waypoint : run.own().loaded().scene.simulated_operator().waypoint()) {
        const Pose X_WT = poseOf(waypoint);
        const Eigen::Quaterniond& q = X_WT.rotation;
        const uint32_t buttons =
            (waypoint.remove() ? kButtonRemove : 0u) | (waypoint.add() ? kButtonAdd : 0u);
        list.append(py::make_tuple(waypoint.time_s(), py::array_t<double>(3, X_WT.position.data()),
                                   arrayOf(std::vector<double>{q.w(), q.x(), q.y(), q.z()}), buttons));
    }
    return list;
}

// As the scene file says it, in small letters.
std::string roleName(ZoneRole role) {
    std::string name = scene::Task::Role_Name(scene::Task::Role(role));
    std::ranges::transform(name, name.begin(), [](unsigned char c) { return char(std::tolower(c)); });
    return name;
}

py::dict progressOf(Run& run) {
    const InUse in_use(run.isUsed());
    const TaskProgress& progress = run.own().progress();
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
        text = run.own().judge().dump();
    }
    return py::module_::import("json").attr("loads")(text);
}

void chooseTool(Run& run, const py::object& tool) {
    const InUse in_use(run.isUsed());
    run.own().chooseTool(toolIndexOf(run.own().toolNames(), py::str(tool)));
}

std::shared_ptr<Simulation> makeSimulation(const std::string& file, const std::vector<std::string>& settings,
                                           const std::string& tool, bool keeps_inputs) {
    const py::gil_scoped_release release;
    const LoadedScene loaded = loadScene(file, settings);
    const size_t first = tool.empty() ? 0 : toolIndexOf(toolNamesOf(loaded.scene), tool);
    return std::make_shared<Simulation>(std::make_shared<SimulatedRun>(loaded, first, keeps_inputs));
}

// What changes as ticks run, or when a run begins anew, is read by its only user.
template <class Self = Run, class Read>
auto guarded(Read read) {
    return [read](Self& self) {
        const InUse in_use(self.isUsed());
        return read(self.own());
    };
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

// How many ticks begin before that time.
uint64_t ticksBefore(const Recording& recording, double until_s) {
    if (std::isnan(until_s)) throw UserError("until_s: expected seconds, got NaN");
    if (until_s > recording.lengthS()) return recording.ticks();
    constexpr double kHalfNs = 0.5e-9;
    const uint64_t tick = recording.tickAt(until_s);
    return recording.secondsOf(tick) < until_s - kHalfNs ? tick + 1 : tick;
}

py::dict runRecorded(Replay& self, std::optional<double> until_s, std::optional<uint64_t> until_tick) {
    if (until_s && until_tick) throw UserError("run_recorded: give until_s or until_tick, not both");
    const InUse in_use(self.isUsed());
    const Recording& recording = self.own().recording();
    const uint64_t end = until_s ? ticksBefore(recording, *until_s)
                                 : std::min(until_tick.value_or(recording.ticks()), recording.ticks());
    const uint64_t next = self.own().next();
    return runTicks(self, end > next ? end - next : 0,
                    [&](size_t) -> const TickRecord& { return self.own().stepAsRecorded(); });
}

StepResult stepRecorded(Replay& self) {
    const InUse in_use(self.isUsed());
    return {self.own().stepAsRecorded(), self.own().recorded()};
}

void defineReplay(py::module_& module) {
    py::class_<Replay, Run, std::shared_ptr<Replay>>(module, "Replay",
                                                     "A recorded session, run again; made by replay().")
        .def(py::init(&makeReplay), py::arg("recording"))
        .def("step_recorded", stepRecorded, "Runs the next tick as it was recorded.")
        .def(
            "run_recorded", runRecorded, py::arg("until_s") = py::none(), py::arg("until_tick") = py::none(),
            "Runs on as recorded, to the end, or all ticks before this one or that begin before this time (s "
            "since the\nfirst tick); returns columns as run() does.")
        .def("restart", guarded<Replay>([](RecordedRun& run) { return run.restart(); }),
             "Back before the first tick.")
        .def_property_readonly("has_left", guarded<Replay>([](RecordedRun& run) { return run.hasLeft(); }),
                               "Another hand has gone on: step() or run() was called.")
        .def_property_readonly("is_at_end", guarded<Replay>([](RecordedRun& run) { return run.isAtEnd(); }),
                               "No recorded tick is left.")
        .def_property_readonly("is_restoring",
                               guarded<Replay>([](RecordedRun& run) { return run.isRestoring(); }),
                               "An order of the session has begun to put the bone back, and is not done.");
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
            "t_s: (N,), what the ticks' time is called, increasing; a row is one period all the same.\n"
            "A row that cannot be is an Error before any runs; one that is not believed is a RuntimeWarning. "
            "Releases the GIL.")
        .def("voxels", voxelsOf,
             "Densities of all voxels, uint16, shape (x, y, z); bone from iso_density on. The same array at "
             "each call,\n"
             "brought up to date where bone was milled since the last one; it cannot be written.")
        .def("mesh", meshOf,
             "The bone's surface: vertices (N, 3) in m, W, and triangles (M, 3), counter-clockwise seen from "
             "outside.")
        .def("tool_mesh", toolMeshOf,
             "The tool's surface in its own frame T, m: views of vertices (N, 3) and triangles (M, 3).")
        .def(
            "depth", depthOf, py::arg("camera"),
            "How far what a DepthCamera sees is away, along its axis: float32, m, shape (height, width), the "
            "upper row\nfirst; far_m where nothing is. Bone by rays through its densities, and after the "
            "first "
            "tick the tool.")
        .def("progress", progressOf,
             "How far the scene's task is, mm3: zones with what is gone of each, what shall be gone and what "
             "of it is.")
        .def("judge", judgementOf,
             "Judges what was done, from the first tick or begin_attempt() on, as a session judges an "
             "attempt: "
             "gates,\nsub_scores, figures, total (its score is 0 to 1). Seconds with a large bone. The "
             "attempt "
             "ends here.")
        .def("begin_attempt", guarded([](SteppedRun& run) { run.beginAttempt(); }),
             "An attempt begins with the next tick: the hand's way before is not judged, what is gone of the "
             "bone is.")
        .def_property_readonly(
            "has_task", [](Run& run) { return run.own().setup().task != nullptr; }, "Can it be judged?")
        .def_property_readonly("ticks", guarded([](SteppedRun& run) { return run.ticks(); }),
                               "How many have run.")
        .def_property_readonly("waypoints", waypointsOf,
                               "The scripted hand of the scene: (t_s, position_m, orientation_wxyz, buttons) "
                               "of each waypoint.")
        .def_property_readonly(
            "period_s", [](Run& run) { return run.own().setup().tick.dt; }, "What a tick stands for, s.")
        .def_property_readonly(
            "state_hash", guarded([](SteppedRun& run) { return run.stateHash(); }),
            "Digest of all ticks and of the bone: the state_hash of `haptic_server simulate`. It reads all "
            "voxels.")
        .def_property_readonly(
            "tools", [](Run& run) { return run.own().toolNames(); }, "Names of the scene's tools.")
        .def_property("tool", guarded([](SteppedRun& run) { return run.toolNames()[run.tool()]; }),
                      chooseTool, "The tool of the next tick; assign a name or a number from 1.")
        .def_property_readonly("burr_radius_m", guarded([](SteppedRun& run) {
                                   return run.setup().tools[run.tool()].burr.radius;
                               }),
                               "Of the tool in use, m.")
        .def_property_readonly(
            "warnings", [](Run& run) { return run.own().setup().warnings; },
            "What the scene would better have otherwise.")
        .def_property_readonly("spacing_m", guarded([](SteppedRun& run) {
                                   return py::array_t<double>(3, run.bone().volume.spacing().data());
                               }),
                               "Between voxels, m; shape (3,).")
        .def_property_readonly("iso_density",
                               guarded([](SteppedRun& run) { return run.bone().volume.iso(); }),
                               "Density of the bone's surface.")
        .def_property_readonly("volume_pose", guarded([](SteppedRun& run) {
                                   return poseDict(run.bone().volume.geometry().X_WV);
                               }),
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
                whileFree(self, [&](SimulatedRun& run) {
                    run.restore(to, [interruption = Interruption()]() mutable { interruption.look(); });
                });
            },
            py::arg("checkpoint"),
            "Runs its ticks again, to the same bits; only those that are missing, where this run began "
            "alike.\nCtrl+C ends it half way: then reset() or restore().");
    defineReplay(module);
}

}  // namespace bonemill::python
