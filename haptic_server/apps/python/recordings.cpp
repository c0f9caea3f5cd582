#include <pybind11/stl.h>
#include <pybind11/stl/filesystem.h>

#include "common/text/foreign_text.h"
#include "haptic_server/apps/python/arrays.h"
#include "haptic_server/apps/python/runs.h"
#include "haptic_server/recording/rerun/replay_events.h"
#include "haptic_server/scene/trajectory/trajectory_reader.h"

namespace bonemill::python {
namespace {

// Columns of what the hand did, one row a tick.
struct HandColumns {
    std::vector<double> t_s, positions, orientations;
    std::vector<uint32_t> buttons;

    void add(double t, const double* position, const double (&wxyz)[4], uint32_t pressed) {
        t_s.push_back(t);
        positions.insert(positions.end(), position, position + 3);
        orientations.insert(orientations.end(), wxyz, wxyz + 4);
        buttons.push_back(pressed);
    }
    py::dict take() {
        py::dict dict;
        dict["t_s"] = arrayOf(std::move(t_s));
        dict["positions_m"] = arrayOf(std::move(positions), 3);
        dict["orientations_wxyz"] = arrayOf(std::move(orientations), 4);
        dict["buttons"] = arrayOf(std::move(buttons));
        return dict;
    }
};

py::dict trajectoryIn(const std::string& file) {
    HandColumns columns;
    for (const TrajectoryRow& row : readTrajectory(file)) {
        const Eigen::Quaterniond& q = row.X_WT.rotation;
        columns.add(row.t_s, row.X_WT.position.data(), {q.w(), q.x(), q.y(), q.z()}, row.buttons);
    }
    return columns.take();
}

py::dict recordedHand(const Recording& recording) {
    HandColumns columns;
    RecordedTicks ticks(recording);
    for (uint64_t tick = 0; tick < recording.ticks(); ++tick) {
        const JournalTick& is = ticks.at(tick);
        columns.add(recording.secondsOf(tick), is.input.p_WT, is.input.q_WT, is.buttons);
    }
    return columns.take();
}

py::list recordedAttemptsOf(const Recording& recording) {
    py::list list;
    for (const RecordedAttempt& attempt : recordedAttempts(recording.content())) {
        const uint64_t end = std::min(attempt.end, recording.ticks() - 1);
        py::dict entry;
        entry["trainee"] = printableLine(attempt.trainee);
        entry["begin_s"] = recording.secondsOf(std::min(attempt.begin, recording.ticks() - 1));
        entry["end_s"] = recording.secondsOf(end);
        entry["begin_tick"] = std::min(attempt.begin, recording.ticks() - 1);
        entry["end_tick"] = end;
        entry["has_ended"] = attempt.end != UINT64_MAX;
        list.append(entry);
    }
    return list;
}

py::list recordedEvents(const Recording& recording) {
    const ReplayEvents events(recording);
    py::list list;
    for (auto event = events.at(0) ? events.at(0) : events.after(0); event; event = events.after(event->tick))
        list.append(py::make_tuple(recording.secondsOf(event->tick), event->text));
    return list;
}

std::vector<std::string> toolsOf(const Recording& recording) {
    std::vector<std::string> names;
    for (const std::string& name : recording.manifest().tool_names()) names.push_back(printableLine(name));
    return names;
}

}  // namespace

void defineRecordings(py::module_& module) {
    const auto ofManifest = [](auto read) {
        return [read](const Recording& recording) { return read(recording.manifest()); };
    };
    using Manifest = const journal::Manifest&;
    py::class_<Recording, std::shared_ptr<Recording>>(
        module, "Recording", "A recorded session as its file has it; made by read_recording().")
        .def(py::init<const std::filesystem::path&>(), py::arg("path"))
        .def_property_readonly("path", [](const Recording& recording) { return recording.path().string(); })
        .def_property_readonly("ticks", &Recording::ticks)
        .def_property_readonly("length_s", &Recording::lengthS)
        .def_property_readonly("scene_name",
                               ofManifest([](Manifest m) { return printableLine(m.scene_name()); }))
        .def_property_readonly("journal_id",
                               ofManifest([](Manifest m) { return printableLine(m.journal_id()); }))
        .def_property_readonly("version",
                               ofManifest([](Manifest m) { return printableLine(m.build().version()); }))
        .def_property_readonly("start_unix_ns", ofManifest([](Manifest m) { return m.start_stamp_ns(); }))
        .def_property_readonly("tools", toolsOf)
        .def_property_readonly("problem",
                               [](const Recording& recording) { return recording.content().problem; })
        .def_property_readonly("attempts", recordedAttemptsOf)
        .def_property_readonly("events", recordedEvents)
        .def("hand", recordedHand,
             "What the hand did, a row a tick: t_s, positions_m, orientations_wxyz, buttons, for "
             "Simulation.run().");
    module.def("read_trajectory", trajectoryIn, py::arg("path"),
               "A trajectory file (CSV) as columns: t_s, positions_m, orientations_wxyz, buttons.");
}

}  // namespace bonemill::python
