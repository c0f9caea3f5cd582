// The publisher thread's work: scene, tool, status and node meshes to the clients, their commands to the
// tick.
#pragma once

#include <atomic>

#include "haptic_server/app/accuracy_figures.h"
#include "haptic_server/app/recorder.h"
#include "haptic_server/app/scene_setup.h"
#include "haptic_server/mesh/mesh_outbox.h"
#include "haptic_server/publish/byte_budget.h"
#include "haptic_server/publish/publisher.h"

namespace bonemill {

class ShowSession {
  public:
    // Publishes the scene at once. Node meshes take bytes_per_s at most. References must outlive this object.
    ShowSession(Publisher& publisher, const scene::Scene& scene, const Simulation& simulation,
                const AccuracyFigures& figures, MeshOutbox& outbox, const Recorder& recorder,
                VolumeReset& reset, AccuracySwitch& accuracy, double bytes_per_s,
                std::atomic<bool>& stop_requested);

    // One round, about 100 times per second; publisher thread only.
    void round();

  private:
    bool publishNodes();
    void publishStatus();
    std::string carryOut(const topics::Command& command);
    std::string setAccuracy(const std::string& name);

    Publisher& publisher_;
    std::string scene_name_;
    MeshOutbox& outbox_;
    ByteBudget budget_;
    Pose X_VW_;
    bool is_whole_ = false;  // all of the bone has been published
    const Recorder& recorder_;
    VolumeReset& reset_;
    AccuracySwitch& accuracy_;
    AccuracyFigures figures_;
    bool is_switchable_;
    std::atomic<bool>& stop_requested_;
    int64_t last_status_ns_ = 0;
};

}  // namespace bonemill
