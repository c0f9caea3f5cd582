#include "common/dds/topic_traits.h"

#include <dds/dds.h>

namespace bonemill::dds {
namespace {

constexpr dds_duration_t kMaxBlocking = DDS_SECS(1), kMaxCommandBlocking = DDS_MSECS(50);
// It bounds what a flood of commands can take of the server's memory.
constexpr int kMaxQueuedCommands = 1024;
// A viewer finds so many tool states when it has drawn: at 100 per second those of a third of a second.
constexpr int kQueuedToolStates = 32;
// Of the messages of some ten ticks each: a third of a second.
constexpr int kQueuedTicks = 32;

Qos reliableQos(dds_duration_t most_blocking = kMaxBlocking) {
    Qos qos = makeQos();
    dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, most_blocking);
    return qos;
}

// Who is there gets the newest sample of every key; who comes later asks for it. A writer that leaves
// disposes nothing: clients keep what they have.
Qos answerQos() {
    Qos qos = reliableQos();
    dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, 1);
    dds_qset_writer_data_lifecycle(qos.get(), false);
    return qos;
}

// A late joiner must have this state: the newest sample per key, and only that. Such a writer never waits for
// a reader.
Qos stateQos() {
    Qos qos = answerQos();
    dds_qset_durability(qos.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
    dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, 1, DDS_LENGTH_UNLIMITED,
                                DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
    return qos;
}

// Only the newest sample counts, but for what is counted since the sample before. A reader knows at most
// kMaxStreamKeys keys whose writers live, and drops samples of others. That is for best effort only: a
// reliable writer's sample would be tried again without end, and hold up all other readers.
template <int depth>
Qos streamQos() {
    Qos qos = makeQos();
    dds_qset_reliability(qos.get(), DDS_RELIABILITY_BEST_EFFORT, 0);
    dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, depth);
    dds_qset_resource_limits(qos.get(), DDS_LENGTH_UNLIMITED, kMaxStreamKeys, DDS_LENGTH_UNLIMITED);
    return qos;
}

// None may be lost, but the writer waits for nobody: what is older than the depth makes way.
Qos ticksQos() {
    Qos qos = reliableQos();
    dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, kQueuedTicks);
    return qos;
}

// Beyond what a reader holds the writer waits, but no longer than a window may stand still.
Qos commandQos() {
    Qos qos = reliableQos(kMaxCommandBlocking);
    dds_qset_history(qos.get(), DDS_HISTORY_KEEP_ALL, 0);
    dds_qset_resource_limits(qos.get(), kMaxQueuedCommands, DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
    return qos;
}

struct Topic {
    const char* name;
    const dds_topic_descriptor_t* type;
    Qos (*qos)();
    size_t most_keys = 0;
};

template <class Sample>
constexpr Topic kTopic{};
template <>
constexpr Topic kTopic<NodeMeshSample>{"bonemill_node_mesh", &bonemill_dds_NodeMeshSample_desc, stateQos};
template <>
constexpr Topic kTopic<SceneInfoSample>{"bonemill_scene_info", &bonemill_dds_SceneInfoSample_desc, stateQos};
template <>
constexpr Topic kTopic<StructureMeshSample>{"bonemill_structure_mesh", &bonemill_dds_StructureMeshSample_desc,
                                            stateQos};
template <>
constexpr Topic kTopic<ToolStateSample>{"bonemill_tool_state", &bonemill_dds_ToolStateSample_desc,
                                        streamQos<kQueuedToolStates>, kMaxStreamKeys / 2};
template <>
constexpr Topic kTopic<TicksSample>{"bonemill_ticks", &bonemill_dds_TicksSample_desc, ticksQos};
template <>
constexpr Topic kTopic<StatusSample>{"bonemill_status", &bonemill_dds_StatusSample_desc, stateQos};
template <>
constexpr Topic kTopic<LessonSample>{"bonemill_lesson", &bonemill_dds_LessonSample_desc, stateQos};
template <>
constexpr Topic kTopic<ScenePictureSample>{"bonemill_scene_picture", &bonemill_dds_ScenePictureSample_desc,
                                           stateQos};
template <>
constexpr Topic kTopic<RemarkSample>{"bonemill_remark", &bonemill_dds_RemarkSample_desc, stateQos};
template <>
constexpr Topic kTopic<ViewerSample>{"bonemill_viewer", &bonemill_dds_ViewerSample_desc, streamQos<1>,
                                     kMaxStreamKeys / 2};
template <>
constexpr Topic kTopic<HandPointerSample>{"bonemill_hand_pointer", &bonemill_dds_HandPointerSample_desc,
                                          streamQos<1>, kMaxStreamKeys / 2};
template <>
constexpr Topic kTopic<CommandSample>{"bonemill_command", &bonemill_dds_CommandSample_desc, commandQos,
                                      kMaxCommandKeys};
template <>
constexpr Topic kTopic<DensityBrickSample>{"bonemill_density_brick", &bonemill_dds_DensityBrickSample_desc,
                                           answerQos};
template <>
constexpr Topic kTopic<DensityWishSample>{"bonemill_density_wish", &bonemill_dds_DensityWishSample_desc,
                                          streamQos<1>, kMaxStreamKeys / 2};

}  // namespace

void DeleteQos::operator()(dds_qos* qos) const noexcept {
    dds_delete_qos(qos);
}

Qos makeQos() {
    return Qos(dds_create_qos());
}

template <class Sample>
TopicDescription describeTopic() {
    const Topic& topic = kTopic<Sample>;
    return {topic.name, topic.type, topic.qos(), topic.most_keys};
}

template TopicDescription describeTopic<NodeMeshSample>();
template TopicDescription describeTopic<SceneInfoSample>();
template TopicDescription describeTopic<StructureMeshSample>();
template TopicDescription describeTopic<ToolStateSample>();
template TopicDescription describeTopic<TicksSample>();
template TopicDescription describeTopic<StatusSample>();
template TopicDescription describeTopic<LessonSample>();
template TopicDescription describeTopic<ScenePictureSample>();
template TopicDescription describeTopic<RemarkSample>();
template TopicDescription describeTopic<ViewerSample>();
template TopicDescription describeTopic<HandPointerSample>();
template TopicDescription describeTopic<CommandSample>();
template TopicDescription describeTopic<DensityBrickSample>();
template TopicDescription describeTopic<DensityWishSample>();

}  // namespace bonemill::dds
