#include "common/dds/topic_traits.h"

namespace bonemill::dds {
namespace {

using namespace std::chrono_literals;

constexpr auto kMaxBlocking = 1s;
// It bounds what a flood of commands can take of the server's memory.
constexpr int kMaxQueuedCommands = 1024;
// A viewer finds so many tool states when it has drawn: at 100 per second those of a third of a second.
constexpr int kQueuedToolStates = 32;

// A late joiner must have this state: the newest sample per key. Such a writer never waits for a reader.
Qos stateQos() {
    Qos qos;
    qos.reliable(kMaxBlocking).transientLocal().keepLast(1).disposeOnRequestOnly();
    return qos;
}

// Only the newest sample counts, but for what is counted since the sample before.
Qos streamQos(int depth) {
    Qos qos;
    qos.bestEffort().keepLast(depth).atMostKeys(kMaxStreamKeys);
    return qos;
}

// Who is there gets the newest sample of every key; who comes later asks for it.
Qos answerQos() {
    Qos qos;
    qos.reliable(kMaxBlocking).keepLast(1).disposeOnRequestOnly();
    return qos;
}

Qos commandQos() {
    Qos qos;
    qos.reliable(kMaxBlocking).keepAll(kMaxQueuedCommands);
    return qos;
}

}  // namespace

template <>
TopicDescription describeTopic<NodeMeshSample>() {
    return {"bonemill_node_mesh", &bonemill_dds_NodeMeshSample_desc, stateQos()};
}

template <>
TopicDescription describeTopic<SceneInfoSample>() {
    return {"bonemill_scene_info", &bonemill_dds_SceneInfoSample_desc, stateQos()};
}

template <>
TopicDescription describeTopic<StructureMeshSample>() {
    return {"bonemill_structure_mesh", &bonemill_dds_StructureMeshSample_desc, stateQos()};
}

template <>
TopicDescription describeTopic<ToolStateSample>() {
    return {"bonemill_tool_state", &bonemill_dds_ToolStateSample_desc, streamQos(kQueuedToolStates),
            kMaxStreamKeys / 2};
}

template <>
TopicDescription describeTopic<StatusSample>() {
    return {"bonemill_status", &bonemill_dds_StatusSample_desc, stateQos()};
}

template <>
TopicDescription describeTopic<LessonSample>() {
    return {"bonemill_lesson", &bonemill_dds_LessonSample_desc, stateQos()};
}

template <>
TopicDescription describeTopic<ScenePictureSample>() {
    return {"bonemill_scene_picture", &bonemill_dds_ScenePictureSample_desc, stateQos()};
}

template <>
TopicDescription describeTopic<RemarkSample>() {
    return {"bonemill_remark", &bonemill_dds_RemarkSample_desc, stateQos()};
}

template <>
TopicDescription describeTopic<ViewerSample>() {
    return {"bonemill_viewer", &bonemill_dds_ViewerSample_desc, streamQos(1), kMaxStreamKeys / 2};
}

template <>
TopicDescription describeTopic<HandPointerSample>() {
    return {"bonemill_hand_pointer", &bonemill_dds_HandPointerSample_desc, streamQos(1), kMaxStreamKeys / 2};
}

template <>
TopicDescription describeTopic<CommandSample>() {
    return {"bonemill_command", &bonemill_dds_CommandSample_desc, commandQos(), kMaxCommandKeys};
}

template <>
TopicDescription describeTopic<DensityBrickSample>() {
    return {"bonemill_density_brick", &bonemill_dds_DensityBrickSample_desc, answerQos()};
}

template <>
TopicDescription describeTopic<DensityWishSample>() {
    return {"bonemill_density_wish", &bonemill_dds_DensityWishSample_desc, streamQos(1), kMaxStreamKeys / 2};
}

}  // namespace bonemill::dds
