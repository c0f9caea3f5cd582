#include "tests/support/recorded_session.h"

#include <algorithm>
#include <cmath>
#include <cstring>
#include <fstream>
#include <sstream>

#include "common/config/scene_file.h"
#include "common/rt/clock.h"
#include "haptic_server/core/bone/checkpoints.h"
#include "haptic_server/core/tick/haptic_tick.h"
#include "haptic_server/recording/journal/build_facts.h"
#include "haptic_server/recording/journal/journal.h"
#include "haptic_server/recording/statistics/state_hash.h"
#include "haptic_server/scans/nrrd/nrrd_writer.h"
#include "haptic_server/scene/setup/scene_materials.h"
#include "haptic_server/scene/setup/scene_setup.h"
#include "tests/support/test_bodies.h"

namespace bonemill::test {
namespace {

constexpr int kVoxels = 64;
constexpr double kSpacing = 0.25e-3, kTop = 10e-3;  // m
constexpr int64_t kPeriodNs = 1'000'000;

void writeScene(const std::filesystem::path& folder, const RecordedSessionOptions& options) {
    const Eigen::Vector3d top(0, 0, options.top);
    writeNrrd(folder / "slab.nrrd",
              bodyVolume(cubeGeometry(kVoxels, kSpacing), halfSpace(top, Eigen::Vector3d::UnitZ())));
    std::ofstream(folder / "slab.textproto")
        << "name: \"slab\" volume { path: \"slab.nrrd\" window_low: 0 window_high: 65535 iso_value: 32768 }\n"
           "tool { name: \"ball\" shape { sphere { center_mm { x: 0 y: 0 z: 0 } radius_mm: 1 } } }\n"
           "tool { name: \"small\" shape { sphere { center_mm { x: 0 y: 0 z: 0 } radius_mm: 0.6 } } }\n"
           "effects { time_removal {} }\n"
        << options.scene_text << '\n';
}

DeviceCapabilities testDevice() {
    DeviceCapabilities device{};
    std::strcpy(device.name, "test hand");
    device.kind = uint32_t(DeviceKind::kBridge);
    device.abilities = kAbilityForce | kAbilityOrientation;
    device.max_force = 5;
    device.workspace_radius = 0.1;
    return device;
}

// To and fro along x, at first 0.4 mm deep, over minutes to and fro along y and deeper, with an orientation
// that is no unit quaternion to the last bit.
Pose poseAt(double t) {
    const double x = 4e-3 + 4e-3 * (1 - std::cos(2 * M_PI * t / 2.3));
    const double y = 8e-3 + 4e-3 * std::sin(2 * M_PI * t / 61) + 0.3e-3 * std::sin(3 * t);
    const double z = kTop + 1e-3 + 0.6e-3 * std::max(0.0, 1 - t / 0.2) - 0.4e-3 - 1e-3 * t / 600;
    Pose pose{{x, y, z}, {0.70710678, 0.70710678, 0.01 * std::sin(t), 0}};
    const double norm = pose.rotation.norm();
    pose.rotation.coeffs() /= norm;
    return pose;
}

// As the device link would: time jitters, and orders come between ticks.
class LiveIo final : public TickIo {
  public:
    bool read(DeviceInput& input) noexcept override {
        input = {};
        tick_ = next_++;
        const double t = double(tick_) * 1e-3;
        const bool is_silent = has_orders && tick_ >= kTickOfSilence && tick_ < kTickOfSilence + 60;
        input.is_repeated = is_silent || tick_ % 97 == 96;
        if (!input.is_repeated) newest_ = poseAt(t);
        if (!input.is_repeated) newest_.position.y() += shift;
        input.X_WT_device = newest_;
        input.buttons = kButtonRemove;
        input.other_device = tick_ == 0 ? &device_ : nullptr;
        input.is_stale = is_silent && tick_ > kTickOfSilence + 20;
        input.stale_factor = input.is_stale ? 0.5 : 1;
        input.start_ns = int64_t(tick_) * kPeriodNs + int64_t((tick_ * 7919) % 20'011);
        input.t_s = secondsOfNs(input.start_ns);  // the first tick starts at 0
        return true;
    }
    int64_t write(const Wrench&) noexcept override { return int64_t(tick_) * kPeriodNs; }
    int64_t now() noexcept override { return int64_t(tick_) * kPeriodNs; }

    bool has_orders = true;
    double shift = 0;

  private:
    uint64_t tick_ = 0, next_ = 0;
    Pose newest_ = poseAt(0);
    DeviceCapabilities device_ = testDevice();
};

std::string textOf(const std::filesystem::path& path) {
    std::ostringstream text;
    text << std::ifstream(path).rdbuf();
    return text.str();
}

journal::Manifest manifestOf(const LoadedScene& loaded, const SceneSetup& simulation) {
    journal::Manifest manifest;
    manifest.set_journal_id("0123456789abcdef0123456789abcdef");
    manifest.set_session(1);
    manifest.set_scene_path(loaded.file.string());
    manifest.set_scene_text(textOf(loaded.file));
    manifest.set_scene_name(loaded.scene.name());
    manifest.set_scene_hash(sceneHashOf(loaded.scene));
    manifest.set_rate_hz(loaded.scene.loop().rate_hz());
    for (const SceneTool& tool : simulation.tools) manifest.add_tool_names(tool.name);
    for (journal::File& file : hashedFiles(filesOf(loaded))) *manifest.add_files() = std::move(file);
    return manifest;
}

}  // namespace

RecordedSession recordSession(const std::filesystem::path& folder, const RecordedSessionOptions& options) {
    writeScene(folder, options);
    RecordedSession session{.journal = folder / options.file,
                            .scene = folder / "slab.textproto",
                            .missing_voxels = {},
                            .x_m = {},
                            .y_m = {}};
    const LoadedScene loaded = loadScene(session.scene);
    SceneSetup simulation = setUpScene(loaded);
    BoneModel& bone = *simulation.bone;
    BoneHistory history(bone);
    Checkpoints checkpoints(history, bone);
    ToolSwitch tools(simulation.spoTools());
    AccuracySwitch accuracy(simulation.accuracy);
    HapticTick tick(simulation.tick, {bone, &history}, {tools, accuracy});
    const RecordedEffects recorded = recordedEffectsOf(loaded.scene.effects());
    Journal journal({.path = session.journal,
                     .manifest = manifestOf(loaded, simulation),
                     .recorded = recorded,
                     .rate_hz = loaded.scene.loop().rate_hz()},
                    {history.scanned(), bone.lattice});
    const auto putBack = [&](uint32_t checkpoint) {
        checkpoints.restore(checkpoint);
        journal::PutBack order;
        order.set_bone_order(history.newestOrder());
        order.set_checkpoint(checkpoint);
        journal.put(JournalTopic::kPutBack, order);
    };
    const auto tell = [&](uint64_t at, const topics::Command& command) {
        journal::Order order;
        order.set_tick(at);
        *order.mutable_command() = command;
        order.set_result("done");
        journal.put(JournalTopic::kOrder, order);
    };
    const auto bone_every = uint64_t(std::llround(options.bone_every_s * 1000));
    StateHash hash;
    LiveIo io;
    io.has_orders = options.has_orders;
    io.shift = options.shift;
    size_t attempts_begun = 0;
    const auto beginAttempt = [&](uint64_t at) {
        journal::Event event;
        event.set_tick(at);
        if (attempts_begun > 0) {
            topics::Attempt& ended = *event.mutable_attempt_ended();
            ended.set_number(uint32_t(attempts_begun));
            ended.set_time_s(double(at - options.attempts[attempts_begun - 1]) * 1e-3);
            journal.put(JournalTopic::kEvent, event);
        }
        event.set_attempt_began("P" + std::to_string(++attempts_begun));
        event.set_bone_order(history.newestOrder());
        journal.put(JournalTopic::kEvent, event);
    };
    for (uint64_t n = 0; n < options.ticks; ++n) {
        if (std::ranges::count(options.attempts, n) > 0) beginAttempt(n);
        if (options.has_orders) {
            topics::Command command;
            if (n == kTickOfOtherTool) tools.choose(1), command.set_select_tool(1), tell(n, command);
            if (n == kTickOfReset) putBack(0), command.set_reset_volume(true), tell(n, command);
            if (n == kTickOfPause || n == kTickOfPause + 100) {
                history.pauseMilling(n == kTickOfPause);
                command.set_pause_milling(n == kTickOfPause);
                tell(n, command);
            }
            if (n == kTickOfCheckpoint) {
                checkpoints.save(double(n) * 1e-3);
                journal.putCheckpoint(checkpoints.kept().back().snapshot, checkpoints.kept().back().id, 1);
                command.set_save_checkpoint(true), tell(n, command);
            }
            if (n == kTickOfRestore)
                putBack(checkpoints.kept().back().id), command.set_restore_checkpoint(1), tell(n, command);
        }
        if (n % bone_every == 0 && !history.isRestoring()) {
            journal.putBone(history.snapshot(bone), history.finishedOrder());
            journal.round();
        }
        const TickRecord& record = *tick.tick(io);
        journal.add(record);
        hash.addRecord(record, recorded);
        session.missing_voxels.push_back(history.missingVoxels());
        session.x_m.push_back(record.p_WT[0]);
        session.y_m.push_back(record.p_WT[1]);
    }
    hash.addVolume(bone.volume);
    session.state_hash = hash.value();
    if (options.has_end) {
        journal::Event end;
        end.set_tick(options.ticks);
        end.mutable_end()->set_ticks(options.ticks);
        journal.put(JournalTopic::kEvent, end);
    }
    journal.finish();
    return session;
}

}  // namespace bonemill::test
