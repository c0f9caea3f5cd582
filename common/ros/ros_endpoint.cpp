#include "common/ros/ros_endpoint.h"

#include <dds/dds.h>

#include <mutex>
#include <set>

namespace bonemill::ros2 {
namespace {

constexpr dds_duration_t kMaxBlocking = DDS_MSECS(5);

// Cyclone's listeners hold on to a topic's name.
const char* kept(const std::string& name) {
    static std::mutex mutex;
    static std::set<std::string> names;
    const std::lock_guard lock(mutex);
    return names.insert(name).first->c_str();
}

dds::Qos qosOf(Delivery delivery) {
    dds::Qos qos = dds::makeQos();
    if (delivery == Delivery::kHeard) {
        dds_qset_reliability(qos.get(), DDS_RELIABILITY_BEST_EFFORT, 0);
        dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, kHeardDepth);
        return qos;
    }
    const int depth = delivery == Delivery::kKept ? kKeptDepth : kStreamDepth;
    dds_qset_reliability(qos.get(), DDS_RELIABILITY_RELIABLE, kMaxBlocking);
    dds_qset_history(qos.get(), DDS_HISTORY_KEEP_LAST, depth);
    if (delivery == Delivery::kStream) return qos;
    dds_qset_durability(qos.get(), DDS_DURABILITY_TRANSIENT_LOCAL);
    dds_qset_durability_service(qos.get(), 0, DDS_HISTORY_KEEP_LAST, depth, DDS_LENGTH_UNLIMITED,
                                DDS_LENGTH_UNLIMITED, DDS_LENGTH_UNLIMITED);
    return qos;
}

}  // namespace

dds::TopicDescription describeRosTopic(const std::string& name, const dds_topic_descriptor_t* type,
                                       Delivery delivery) {
    return {kept("rt/" + name), type, qosOf(delivery)};
}

}  // namespace bonemill::ros2
