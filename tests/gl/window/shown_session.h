// Gives viewers a session to look at: the milled block, and answers to their commands.
#pragma once

#include <atomic>
#include <mutex>
#include <optional>
#include <thread>
#include <utility>
#include <vector>

#include "common/device_messages/device_messages.h"
#include "haptic_server/server/publish/publisher.h"
#include "tests/gl/milled_scene.h"
#include "tests/support/dds_session.h"

namespace bonemill::test {

class ShownSession {
  public:
    ShownSession() : publisher_({.domain = testDomain(), .session = testSession(), .epoch = 0}) {
        info_ = milledInfo();
        info_.add_tool_names("6 mm");
        info_.add_tool_names("3 mm");
        status_ = makeStatus();
        status_.set_preset("balanced");
        publisher_.publishSceneInfo(info_);
        for (const NodeMesh& node : milledBlock()) publisher_.publishNodes({&node, 1});
        thread_ = std::thread([this] { serve(); });
    }
    ~ShownSession() {
        stop_ = true;
        thread_.join();
    }

    void giveToolTo(const std::string& device, DeviceKind kind) {
        const std::lock_guard lock(mutex_);
        status_.mutable_device()->set_name(device);
        status_.mutable_device()->set_kind(uint32_t(kind));
    }

    // The contact law can be tuned, and is.
    void tune() {
        const std::lock_guard lock(mutex_);
        info_.mutable_tunable()->mutable_coupling()->set_damping_time_ms(2);
        info_.set_revision(info_.revision() + 1);
        status_.mutable_tuning()->mutable_coupling()->set_damping_time_ms(1.5);
        has_other_info_ = true;
    }

    void teach(const topics::Lesson& lesson) {
        const std::lock_guard lock(mutex_);
        lesson_ = lesson;
    }

    // Returns all that have come so far, oldest first.
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
    static TickRecord tool() {
        const Pose X_WT = toolInCavity();
        const Eigen::Quaterniond& q = X_WT.rotation;
        TickRecord record{};
        record.tick = 1000;
        record.f_hand_W[2] = 3;  // N
        for (double* p : {record.p_WT, record.p_WT_device})
            std::copy(X_WT.position.begin(), X_WT.position.end(), p);
        for (double* to : {record.q_WT, record.q_WT_device})
            for (const double part : {q.w(), q.x(), q.y(), q.z()}) *to++ = part;
        return record;
    }
    void serve() {
        while (!stop_) {
            for (const topics::Command& command : publisher_.takeCommands()) {
                carryOut(command);
                publisher_.publishStatus(status());
                publisher_.acknowledge(command, Answer::done());
            }
            publisher_.publishStatus(status());
            publisher_.publishToolState(tool());
            publishLesson();
            publishInfo();
            std::this_thread::sleep_for(std::chrono::milliseconds(30));
        }
    }
    void publishInfo() {
        const std::lock_guard lock(mutex_);
        if (std::exchange(has_other_info_, false)) publisher_.publishSceneInfo(info_);
    }
    void publishLesson() {
        const std::lock_guard lock(mutex_);
        if (lesson_) publisher_.publishLesson(*std::exchange(lesson_, std::nullopt));
    }
    void carryOut(const topics::Command& command) {
        const std::lock_guard lock(mutex_);
        commands_.push_back(command);
        if (command.has_pause_milling()) status_.set_is_milling_paused(command.pause_milling());
        if (command.has_set_accuracy()) status_.set_preset(command.set_accuracy());
        if (command.has_save_checkpoint()) {
            topics::Checkpoint& checkpoint = *status_.add_checkpoints();
            checkpoint.set_id(++last_checkpoint_);
            checkpoint.set_removed_mm3(status_.removed_mm3());
        }
        if (!command.has_select_tool()) return;
        info_.set_tool_index(command.select_tool());
        info_.set_revision(info_.revision() + 1);
        has_other_info_ = true;
    }

    Publisher publisher_;  // of the constructor, then of the thread
    mutable std::mutex mutex_;
    topics::SceneInfo info_;
    topics::Status status_;
    std::vector<topics::Command> commands_;
    std::optional<topics::Lesson> lesson_;  // to be published
    bool has_other_info_ = false;           // likewise
    uint32_t last_checkpoint_ = 0;
    std::atomic<bool> stop_ = false;
    std::thread thread_;
};

}  // namespace bonemill::test
