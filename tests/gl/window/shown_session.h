// A session for viewers to look at: a small body with a milled hole, and answers to their commands.
#pragma once

#include <atomic>
#include <mutex>
#include <thread>
#include <vector>

#include "haptic_server/publish/publisher.h"
#include "tests/gl/synthetic_scene.h"
#include "tests/support/dds_session.h"

namespace bonemill::test {

class ShownSession {
  public:
    static constexpr double kRadius = 0.005;  // m, of the body
    static Eigen::Vector3d center() { return Eigen::Vector3d::Constant(0.008); }

    ShownSession() : publisher_({.domain = testDomain(), .session = testSession(), .epoch = 0}) {
        info_ = makeSceneInfo("sphere", center() - half(), center() + half());
        *info_.mutable_tool() = makeToolMesh(1e-3, 5e-4, 0.02);
        info_.set_burr_radius_m(1e-3);
        info_.add_tool_names("6 mm");
        info_.add_tool_names("3 mm");
        status_ = makeStatus();
        status_.set_preset("balanced");
        publisher_.publishSceneInfo(info_);
        for (const NodeMesh& node : meshBody(65, 2.5e-4, distance)) publisher_.publishNode(node);
        thread_ = std::thread([this] { serve(); });
    }
    ~ShownSession() {
        stop_ = true;
        thread_.join();
    }

    // All that have come so far, oldest first.
    std::vector<topics::Command> commands() const {
        const std::lock_guard lock(mutex_);
        return commands_;
    }
    topics::SceneInfo info() const {
        const std::lock_guard lock(mutex_);
        return info_;
    }
    topics::Status status() const {
        const std::lock_guard lock(mutex_);
        return status_;
    }

  private:
    static Eigen::Vector3d half() { return Eigen::Vector3d::Constant(kRadius); }
    // A ball with a round hole from its front (-y) to the middle.
    static double distance(const Eigen::Vector3d& p) {
        const Eigen::Vector3d end = center() - Eigen::Vector3d(0, 0.004, 0);
        return std::max((p - center()).norm() - kRadius, 0.002 - (p - end).norm());
    }
    static TickRecord tool() {
        TickRecord record{};
        record.tick = 1000;
        record.q_WT[0] = record.q_WT_device[0] = M_SQRT1_2;  // the shaft leaves the hole towards -y and +z
        record.q_WT[1] = record.q_WT_device[1] = M_SQRT1_2;
        const Eigen::Vector3d p = center() + Eigen::Vector3d(0, -0.0045, 0.0012);
        std::copy(p.begin(), p.end(), record.p_WT);
        std::copy(p.begin(), p.end(), record.p_WT_device);
        return record;
    }
    void serve() {
        while (!stop_) {
            for (const topics::Command& command : publisher_.takeCommands()) {
                carryOut(command);
                publisher_.publishStatus(status());
                publisher_.acknowledge(command, "done");
            }
            publisher_.publishStatus(status());
            publisher_.publishToolState(tool());
            std::this_thread::sleep_for(std::chrono::milliseconds(30));
        }
    }
    void carryOut(const topics::Command& command) {
        const std::lock_guard lock(mutex_);
        commands_.push_back(command);
        if (command.has_pause_milling()) status_.set_is_milling_paused(command.pause_milling());
        if (command.has_set_accuracy()) status_.set_preset(command.set_accuracy());
        if (command.has_save_checkpoint()) status_.add_checkpoints()->set_id(++last_checkpoint_);
        if (!command.has_select_tool()) return;
        info_.set_tool_index(command.select_tool());
        info_.set_revision(info_.revision() + 1);
        publisher_.publishSceneInfo(info_);
    }

    Publisher publisher_;  // of the constructor, then of the thread
    mutable std::mutex mutex_;
    topics::SceneInfo info_;
    topics::Status status_;
    std::vector<topics::Command> commands_;
    uint32_t last_checkpoint_ = 0;
    std::atomic<bool> stop_ = false;
    std::thread thread_;
};

}  // namespace bonemill::test
