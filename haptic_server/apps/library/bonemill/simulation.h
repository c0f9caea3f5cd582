// Haptic bone milling for C++ programs: the very tick of a live session, one call a tick.
//
//     bonemill::Simulation simulation("tooth_cavity.textproto");
//     bonemill::Hand hand{{0, 0, 0.012}};
//     hand.buttons = bonemill::kRemove;
//     const bonemill::StepResult result = simulation.step(hand);
//
// Lengths are m, forces N, torques N·m, volumes m³. W is the scan's frame, T the tool's; quaternions are w,
// x, y, z and turn T into W. What is wrong with the input is thrown as bonemill::Error, with one line that
// says what, where and what to do. A simulation belongs to one thread at a time; it is not for a real-time
// thread: it asks the clock, and it keeps what was done for checkpoints.
//
// Link the target bonemill::bonemill of find_package(bonemill); before 1.0 each minor version is a soname of
// its own. What it logs goes to spdlog's default logger, which is yours. It registers its messages with the
// process' libprotobuf: it does not go into one process with Python's module bonemill.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <stdexcept>
#include <string>
#include <utility>
#include <vector>

#define BONEMILL_EXPORT __attribute__((visibility("default")))

namespace bonemill {

using Vector3 = std::array<double, 3>;
using Quaternion = std::array<double, 4>;

class BONEMILL_EXPORT Error : public std::runtime_error {
  public:
    using std::runtime_error::runtime_error;
};

enum Buttons : uint32_t { kRemove = 1, kAdd = 2 };

// Where the hand holds the tool for one tick.
struct Hand {
    Vector3 position_W{};
    Quaternion orientation_WT{1, 0, 0, 0};
    uint32_t buttons = 0;
};

struct StepResult {
    uint64_t tick = 0;
    double t_s = 0;
    Vector3 force_W{}, torque_W{};  // on the hand; the torque about the tool point that it holds
    Vector3 tool_position_W{};      // of the simulated tool, after the tick
    Quaternion tool_orientation_WT{1, 0, 0, 0};
    double penetration = 0;         // the deepest contact
    double removed = 0, added = 0;  // in this tick
    uint32_t removed_voxels = 0, added_voxels = 0;
    uint32_t contacts = 0;
    uint32_t faults = 0;  // bits; names: faultNames()
    uint32_t events = 0;  // 1 spindle stalled, 2 near a structure, 4 touched, 8 damaged, 16 bone too hot
};

struct SimulationOptions {
    std::vector<std::string> settings{};  // PATH=VALUE each, as `haptic_server simulate --set` has them
    std::string tool{};                   // name or number from 1; empty: the first
    bool keeps_inputs = true;             // without, there are no checkpoints, and no 72 bytes a tick
};

// The bone's surface.
struct Mesh {
    std::vector<Vector3> vertices_W;
    std::vector<std::array<uint32_t, 3>> triangles;  // counter-clockwise seen from outside
};

// All voxels, x fastest.
struct Voxels {
    std::array<int, 3> dims{};
    Vector3 spacing{};
    Vector3 position_WV{};  // of voxel (0, 0, 0)
    Quaternion orientation_WV{1, 0, 0, 0};
    uint16_t iso_density = 0;  // bone from there on
    std::vector<uint16_t> densities;
};

// What a simulation has done so far, as inputs.
class BONEMILL_EXPORT Checkpoint {
  public:
    Checkpoint();
    ~Checkpoint();
    Checkpoint(const Checkpoint&);
    Checkpoint& operator=(const Checkpoint&);
    uint64_t ticks() const;

  private:
    friend class Simulation;
    struct State;
    std::shared_ptr<const State> state_;
};

class BONEMILL_EXPORT Simulation {
  public:
    // Reads the scene and its volume: a second or some.
    explicit Simulation(const std::string& scene_file, const SimulationOptions& options = {});
    ~Simulation();
    Simulation(Simulation&&) noexcept;
    Simulation& operator=(Simulation&&) noexcept;

    StepResult step(const Hand& hand);
    uint64_t ticks() const;
    double period() const;  // s, that a tick stands for

    std::vector<std::string> tools() const;
    void chooseTool(const std::string& name);  // or number from 1; from the next tick on

    // What the scene's effects told of the last tick: names with units, and values; NaN has no meaning there.
    std::vector<std::pair<std::string, double>> figures() const;
    static std::vector<std::string> faultNames(uint32_t faults);

    // Digest of all ticks and of the bone: what `haptic_server simulate` calls state_hash. Reads all voxels.
    uint64_t stateHash() const;
    Mesh mesh() const;
    Voxels voxels() const;
    // Judges the run as a session judges an attempt, where the scene has a task; JSON. The attempt ends here.
    std::string judge();

    void reset();  // the bone as scanned, no tick run
    Checkpoint checkpoint() const;
    // To the same bits: runs its ticks again; only those that are missing, if this run began alike and was
    // not judged. A checkpoint of another scene or other settings is an Error.
    void restore(const Checkpoint& checkpoint);

  private:
    struct State;
    std::unique_ptr<State> state_;
};

}  // namespace bonemill
