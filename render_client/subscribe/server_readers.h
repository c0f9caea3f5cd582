// The readers of what servers write, which can be made anew: new readers get the newest sample of every key
// once more.
#pragma once

#include <chrono>
#include <optional>

#include "common/dds/wait_set.h"
#include "render_client/subscribe/wire.h"

namespace bonemill {

class ServerReaders {
  public:
    // Joins `also`, another reader, to the wait. Throws UserError.
    ServerReaders(const Wire& wire, int32_t also)
        : nodes(wire),
          scene_info(wire),
          structures(wire),
          tool_state(wire),
          status(wire),
          lesson(wire),
          remarks(wire),
          remote_(wire.remote) {
        if (remote_) return;
        wait_set_.emplace(*wire.participant);
        for (const int32_t reader :
             {nodes.handle(), scene_info.handle(), structures.handle(), tool_state.handle(), status.handle(),
              lesson.handle(), remarks.handle(), also})
            wait_set_->add(reader);
    }

    // Returns true when something can be taken, false when `timeout` passed before.
    bool wait(std::chrono::nanoseconds timeout) const {
        return remote_ ? remote_->wait(timeout) : wait_set_->wait(timeout);
    }

    Inlet<dds::NodeMeshSample> nodes;
    Inlet<dds::SceneInfoSample> scene_info;
    Inlet<dds::StructureMeshSample> structures;
    Inlet<dds::ToolStateSample> tool_state;
    Inlet<dds::StatusSample> status;
    Inlet<dds::LessonSample> lesson;
    Inlet<dds::RemarkSample> remarks;

  private:
    RemoteSession* remote_;
    std::optional<dds::WaitSet> wait_set_;  // the last member: it waits for the others
};

}  // namespace bonemill
