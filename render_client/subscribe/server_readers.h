// The readers of what servers write, which can be made anew: new readers get the newest sample of every key
// once more.
#pragma once

#include "common/dds/endpoint.h"
#include "common/dds/wait_set.h"

namespace bonemill {

struct ServerReaders {
    // Joins `also`, another reader, to the wait. Throws UserError.
    ServerReaders(const dds::Participant& participant, int32_t also)
        : nodes(participant),
          scene_info(participant),
          structures(participant),
          tool_state(participant),
          status(participant),
          lesson(participant),
          wait_set(participant) {
        for (const int32_t reader : {nodes.handle(), scene_info.handle(), structures.handle(),
                                     tool_state.handle(), status.handle(), lesson.handle(), also})
            wait_set.add(reader);
    }

    dds::Reader<dds::NodeMeshSample> nodes;
    dds::Reader<dds::SceneInfoSample> scene_info;
    dds::Reader<dds::StructureMeshSample> structures;
    dds::Reader<dds::ToolStateSample> tool_state;
    dds::Reader<dds::StatusSample> status;
    dds::Reader<dds::LessonSample> lesson;
    dds::WaitSet wait_set;  // the last member: it waits for the others
};

}  // namespace bonemill
