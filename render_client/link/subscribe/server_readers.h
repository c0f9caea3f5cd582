// The readers of what servers write, which can be made anew: new readers get the newest sample of every key
// once more.
#pragma once

#include <chrono>
#include <optional>

#include "common/dds/endpoint.h"
#include "render_client/link/subscribe/wire.h"

namespace bonemill {

class ServerReaders {
  public:
    // Joins `also`, another reader, to the wait; it must outlive this object. Throws UserError.
    ServerReaders(const Wire& wire, const Inlet<dds::ViewerSample>& also)
        : nodes(wire),
          scene_info(wire),
          structures(wire),
          tool_state(wire),
          status(wire),
          lesson(wire),
          pictures(wire),
          remarks(wire),
          remote_(wire.remote) {
        if (remote_) return;
        wait_set_.emplace(*wire.participant);
        const auto watch = [this](const auto& reader) {
            wait_set_->add([&reader] { return reader.handle(); });
        };
        watch(nodes), watch(scene_info), watch(structures), watch(tool_state), watch(status), watch(lesson);
        watch(pictures), watch(remarks);
        watch(also);
    }

    // Returns true when something can be taken, false when `timeout` passed before.
    bool wait(std::chrono::nanoseconds timeout) {
        return remote_ ? remote_->wait(timeout) : wait_set_->wait(timeout);
    }

    Inlet<dds::NodeMeshSample> nodes;
    Inlet<dds::SceneInfoSample> scene_info;
    Inlet<dds::StructureMeshSample> structures;
    Inlet<dds::ToolStateSample> tool_state;
    Inlet<dds::StatusSample> status;
    Inlet<dds::LessonSample> lesson;
    Inlet<dds::ScenePictureSample> pictures;
    Inlet<dds::RemarkSample> remarks;

  private:
    RemoteSession* remote_;
    std::optional<dds::WaitSet> wait_set_;  // the last member: it waits for the others
};

}  // namespace bonemill
