#include "haptic_server/apps/library/bonemill/simulation.h"

#include "common/base/user_error.h"
#include "common/config/scene_tools.h"
#include "haptic_server/core/effects/effect_figures.h"
#include "haptic_server/core/telemetry/fault_names.h"
#include "haptic_server/lab/stepping/simulated_run.h"

namespace bonemill {
namespace {

// What is wrong with the input leaves the library as its own exception.
template <class Call>
auto translated(Call&& call) {
    try {
        return call();
    } catch (const UserError& error) {
        throw Error(error.what());
    }
}

Vector3 arrayOf(const Eigen::Vector3d& v) {
    return {v.x(), v.y(), v.z()};
}
Quaternion arrayOf(const Eigen::Quaterniond& q) {
    return {q.w(), q.x(), q.y(), q.z()};
}

HandStep handStepOf(const Hand& hand) {
    const Quaternion& q = hand.orientation_WT;
    return {{Eigen::Vector3d(hand.position_W.data()), Eigen::Quaterniond(q[0], q[1], q[2], q[3])},
            hand.buttons};
}

StepResult resultOf(const TickRecord& record) {
    StepResult result;
    result.tick = record.tick;
    result.t_s = record.t_s;
    result.force_W = std::to_array(record.f_hand_W);
    result.torque_W = std::to_array(record.t_hand_W);
    result.tool_position_W = std::to_array(record.p_WT);
    result.tool_orientation_WT = std::to_array(record.q_WT);
    result.penetration = record.max_penetration;
    result.removed = record.removed;
    result.added = record.added;
    result.removed_voxels = record.removed_voxels;
    result.added_voxels = record.added_voxels;
    result.contacts = record.contacts;
    result.faults = record.faults;
    result.events = record.effects.events;
    return result;
}

SimulatedRun runOf(const std::string& scene_file, const SimulationOptions& options) {
    const LoadedScene loaded = loadScene(scene_file, options.settings);
    const size_t tool = options.tool.empty() ? 0 : toolIndexOf(toolNamesOf(loaded.scene), options.tool);
    return SimulatedRun(loaded, tool, options.keeps_inputs);
}

}  // namespace

struct Checkpoint::State {
    RunCheckpoint checkpoint;
};

Checkpoint::Checkpoint() = default;
Checkpoint::~Checkpoint() = default;
Checkpoint::Checkpoint(const Checkpoint&) = default;
Checkpoint& Checkpoint::operator=(const Checkpoint&) = default;
uint64_t Checkpoint::ticks() const {
    return state_ ? state_->checkpoint.ticks() : 0;
}

struct Simulation::State {
    SimulatedRun run;
};

Simulation::Simulation(const std::string& scene_file, const SimulationOptions& options)
    : state_(translated([&] { return std::unique_ptr<State>(new State{runOf(scene_file, options)}); })) {}
Simulation::~Simulation() = default;
Simulation::Simulation(Simulation&&) noexcept = default;
Simulation& Simulation::operator=(Simulation&&) noexcept = default;

StepResult Simulation::step(const Hand& hand) {
    return translated([&] { return resultOf(state_->run.step(handStepOf(hand))); });
}

uint64_t Simulation::ticks() const {
    return state_->run.ticks();
}
double Simulation::period() const {
    return std::as_const(state_->run).setup().tick.dt;
}

std::vector<std::string> Simulation::tools() const {
    return state_->run.toolNames();
}

void Simulation::chooseTool(const std::string& name) {
    translated([&] { state_->run.chooseTool(toolIndexOf(state_->run.toolNames(), name)); });
}

std::vector<std::pair<std::string, double>> Simulation::figures() const {
    std::vector<std::pair<std::string, double>> figures;
    for (const EffectFigure& figure : kEffectFigures)
        if (figure.name && figure.isToldBy(state_->run.recorded()))
            figures.emplace_back(figure.name, figure.numberIn(state_->run.record().effects));
    return figures;
}

std::vector<std::string> Simulation::faultNames(uint32_t faults) {
    return faultList(faults);
}

uint64_t Simulation::stateHash() const {
    return state_->run.stateHash();
}

Mesh Simulation::mesh() const {
    RunSurface surface = state_->run.surface();
    Mesh mesh;
    mesh.triangles = std::move(surface.triangles);
    mesh.vertices_W.reserve(surface.vertices_W.size());
    for (const Eigen::Vector3d& p_W : surface.vertices_W) mesh.vertices_W.push_back(arrayOf(p_W));
    return mesh;
}

Voxels Simulation::voxels() const {
    const VoxelVolume& volume = state_->run.bone().volume;
    const VolumeGeometry& geometry = volume.geometry();
    Voxels voxels;
    voxels.dims = {geometry.dims.x(), geometry.dims.y(), geometry.dims.z()};
    voxels.spacing = arrayOf(geometry.spacing);
    voxels.position_WV = arrayOf(geometry.X_WV.position);
    voxels.orientation_WV = arrayOf(geometry.X_WV.rotation);
    voxels.iso_density = volume.iso();
    voxels.densities.resize(geometry.voxelCount());
    state_->run.copyVoxels({Eigen::Vector3i::Zero(), geometry.dims - Eigen::Vector3i::Ones()},
                           voxels.densities);
    return voxels;
}

std::string Simulation::judge() {
    return translated([&] { return state_->run.judge().dump(); });
}

void Simulation::reset() {
    state_->run.reset();
}

Checkpoint Simulation::checkpoint() const {
    Checkpoint checkpoint;
    checkpoint.state_ = translated([&] {
        return std::make_shared<const Checkpoint::State>(Checkpoint::State{state_->run.checkpoint()});
    });
    return checkpoint;
}

void Simulation::restore(const Checkpoint& checkpoint) {
    if (!checkpoint.state_) return reset();
    translated([&] { state_->run.restore(checkpoint.state_->checkpoint); });
}

}  // namespace bonemill
