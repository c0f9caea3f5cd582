// Python's side of runs: what a simulation and a replay have in common. Each belongs to one thread at a time:
// whatever looks at what can change holds InUse meanwhile.
#pragma once

#include <pybind11/numpy.h>
#include <pybind11/pybind11.h>

#include <atomic>
#include <memory>

#include "haptic_server/core/telemetry/tick_record.h"
#include "haptic_server/lab/stepping/recorded_run.h"
#include "haptic_server/lab/stepping/simulated_run.h"

namespace bonemill::python {

// One tick's record, copied, with what its scene's effects tell.
struct StepResult {
    TickRecord record;
    RecordedEffects recorded;
};

// Throws UserError where another thread is in the same run.
class InUse {
  public:
    explicit InUse(std::atomic<bool>& is_used);
    ~InUse() { is_used_ = false; }
    InUse(const InUse&) = delete;
    InUse& operator=(const InUse&) = delete;

  private:
    std::atomic<bool>& is_used_;
};

class Run {
  public:
    explicit Run(std::shared_ptr<SteppedRun> run) : run_(std::move(run)) {}
    virtual ~Run() = default;

    SteppedRun& own() noexcept { return *run_; }
    std::atomic<bool>& isUsed() noexcept { return is_used_; }
    pybind11::object voxels = {};  // the array that voxels() keeps up with the bone

  private:
    std::shared_ptr<SteppedRun> run_;
    std::atomic<bool> is_used_{false};
};

class Simulation final : public Run {
  public:
    explicit Simulation(std::shared_ptr<SimulatedRun> run) : Run(run), own_(std::move(run)) {}
    SimulatedRun& own() noexcept { return *own_; }

  private:
    std::shared_ptr<SimulatedRun> own_;
};

class Replay final : public Run {
  public:
    Replay(std::shared_ptr<const Recording> recording, std::shared_ptr<RecordedRun> run)
        : Run(run), recording_(std::move(recording)), own_(std::move(run)) {}
    RecordedRun& own() noexcept { return *own_; }

  private:
    std::shared_ptr<const Recording> recording_;
    std::shared_ptr<RecordedRun> own_;
};

// What a bonemill.DepthCamera sees of it: (height, width).
pybind11::array depthOf(Run& run, const pybind11::object& camera);

void defineResults(pybind11::module_& module);
void defineRuns(pybind11::module_& module);
void defineRecordings(pybind11::module_& module);

}  // namespace bonemill::python
