// Lists the topics: name, type descriptor and quality of service of each envelope of proto/topics.idl.
#pragma once

#include <topics.h>

#include <cstddef>
#include <memory>

struct dds_qos;

namespace bonemill::dds {

// A quality of service of Cyclone DDS.
struct DeleteQos {
    void operator()(dds_qos* qos) const noexcept;
};
using Qos = std::unique_ptr<dds_qos, DeleteQos>;
// Returns one that says nothing yet.
Qos makeQos();

using NodeMeshSample = bonemill_dds_NodeMeshSample;
using SceneInfoSample = bonemill_dds_SceneInfoSample;
using StructureMeshSample = bonemill_dds_StructureMeshSample;
using ToolStateSample = bonemill_dds_ToolStateSample;
using TicksSample = bonemill_dds_TicksSample;
using StatusSample = bonemill_dds_StatusSample;
using LessonSample = bonemill_dds_LessonSample;
using ScenePictureSample = bonemill_dds_ScenePictureSample;
using RemarkSample = bonemill_dds_RemarkSample;
using ViewerSample = bonemill_dds_ViewerSample;
using HandPointerSample = bonemill_dds_HandPointerSample;
using CommandSample = bonemill_dds_CommandSample;
using DensityBrickSample = bonemill_dds_DensityBrickSample;
using DensityWishSample = bonemill_dds_DensityWishSample;

struct TopicDescription {
    const char* name;  // of static storage
    const dds_topic_descriptor_t* type;
    Qos qos;
    // A reader that has heard of N keys forgets them all (Reader::take()); 0: it never does.
    size_t most_keys = 0;
};

// How many senders of a stream a reader knows at once: far more than there are viewers, and a bound for the
// memory that invented ones can take. It forgets them when half of that is used, so that there is room for
// others.
inline constexpr int kMaxStreamKeys = 1024;
// The same bound for senders of commands: an honest client repeats a command that gets lost.
inline constexpr int kMaxCommandKeys = 16384;
inline constexpr size_t kLongestCommand = 4096;  // bytes of payload; readers drop longer ones

// There is one for each of the samples above.
template <class Sample>
TopicDescription describeTopic();

}  // namespace bonemill::dds
