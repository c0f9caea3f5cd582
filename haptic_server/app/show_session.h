// The publisher thread's work: scene, tool, status and node meshes to the clients, their commands to the
// tick.
#pragma once

#include <atomic>

#include "haptic_server/app/accuracy_figures.h"
#include "haptic_server/app/mesh_outbox.h"
#include "haptic_server/app/recorder.h"
#include "haptic_server/app/scene_setup.h"
#include "haptic_server/publish/publisher.h"

namespace bonemill {

class ShowSession {
  public:
    // Publishes the scene at once; bone_box is the bone's box in V. References must outlive this object.
    ShowSession(Publisher& publisher, const scene::Scene& scene, const Simulation& simulation,
                const AccuracyFigures& figures, MeshOutbox& outbox, const Recorder& recorder,
                VolumeReset& reset, AccuracySwitch& accuracy, std::atomic<bool>& stop_requested);

    // One round, about 60 times per second; publisher thread only.
    void round();

  private:
    void publishStatus();
    std::string carryOut(const topics::Command& command);
    std::string setAccuracy(const std::string& name);

    Publisher& publisher_;
    std::string scene_name_;
    MeshOutbox& outbox_;
    const Recorder& recorder_;
    VolumeReset& reset_;
    AccuracySwitch& accuracy_;
    AccuracyFigures figures_;
    bool is_switchable_;
    std::atomic<bool>& stop_requested_;
    int64_t last_status_ns_ = 0;
};

}  // namespace bonemill
