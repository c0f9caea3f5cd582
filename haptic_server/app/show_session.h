// The publisher thread's work: scene, tool, status and node meshes to the clients, their commands to the
// tick.
#pragma once

#include <atomic>

#include "haptic_server/app/mesh_outbox.h"
#include "haptic_server/app/recorder.h"
#include "haptic_server/app/scene_setup.h"
#include "haptic_server/publish/publisher.h"

namespace bonemill {

class ShowSession {
  public:
    // Publishes the scene at once; bone_box is the bone's box in V. References must outlive this object.
    ShowSession(Publisher& publisher, const scene::Scene& scene, const Simulation& simulation,
                MeshOutbox& outbox, const Recorder& recorder, VolumeReset& reset,
                std::atomic<bool>& stop_requested);

    // One round, about 60 times per second; publisher thread only.
    void round();

  private:
    void publishStatus();
    std::string carryOut(const topics::Command& command);

    Publisher& publisher_;
    std::string scene_name_;
    MeshOutbox& outbox_;
    const Recorder& recorder_;
    VolumeReset& reset_;
    std::atomic<bool>& stop_requested_;
    int64_t last_status_ns_ = 0;
};

}  // namespace bonemill
