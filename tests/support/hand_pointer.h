// Stands for a viewer whose mouse holds the tool: its messages, and a writer of them.
#pragma once

#include <string>

#include "common/dds/endpoint.h"
#include "common/geometry/pose.h"
#include "proto/topics.pb.h"
#include "tests/support/dds_session.h"

namespace bonemill::test {

inline topics::HandPointer handPointer(uint64_t sender, uint32_t sequence, const Pose& X_WT,
                                       uint32_t buttons = 0) {
    topics::HandPointer message;
    message.set_epoch(1);
    message.set_sender(sender);
    message.set_role(topics::Viewer::OPERATOR);
    message.set_sequence(sequence);
    message.mutable_p_wt_m()->Assign(X_WT.position.begin(), X_WT.position.end());
    const Eigen::Quaterniond& q = X_WT.rotation;
    for (const double part : {q.w(), q.x(), q.y(), q.z()}) message.add_q_wt(part);
    message.set_buttons(buttons);
    message.set_is_holding(true);
    return message;
}

class PointingViewer {
  public:
    explicit PointingViewer(uint64_t sender)
        : sender_(sender), participant_(testDomain()), writer_(participant_) {}

    int readers() const { return writer_.matchedReaders(); }
    void want(const Pose& X_WT, uint32_t buttons = 0, uint32_t placements = 0) {
        topics::HandPointer message = handPointer(sender_, ++sequence_, X_WT, buttons);
        message.set_placements(placements);
        send(message.SerializeAsString());
    }
    void letGo() {
        topics::HandPointer message = handPointer(sender_, ++sequence_, Pose{});
        message.set_is_holding(false);
        send(message.SerializeAsString());
    }
    void send(const std::string& bytes) {
        dds::HandPointerSample sample{};
        sample.session = testSession();
        sample.sender = sender_;
        dds::setPayload(sample, bytes);
        writer_.write(sample);
    }

  private:
    uint64_t sender_;
    uint32_t sequence_ = 0;
    dds::Participant participant_;
    dds::Writer<dds::HandPointerSample> writer_;
};

}  // namespace bonemill::test
