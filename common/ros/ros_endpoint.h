// Writers and readers of ROS 2 topics. Each belongs to one thread; none is for the tick. Constructors throw
// UserError.
#pragma once

#include <string>

#include "common/dds/endpoint.h"
#include "common/ros/ros_messages.h"

namespace bonemill::ros2 {

// What rviz2 and rosbag2 ask for by themselves matches all of these.
enum class Delivery {
    kStream,  // reliable, volatile, keep last kStreamDepth
    kKept,    // reliable, transient local, keep last kKeptDepth: for who asks, the newest are kept
    kHeard,   // of readers: best effort, volatile, which matches every writer
};
inline constexpr int kStreamDepth = 200;  // a fifth of a second of ticks, for a network that loses some
inline constexpr int kKeptDepth = 8;
inline constexpr int kHeardDepth = 16;

// Describes the topic that ROS 2 calls /`name`; its text is kept for good, as Cyclone wants it.
dds::TopicDescription describeRosTopic(const std::string& name, const dds_topic_descriptor_t* type,
                                       Delivery delivery);

template <class Message>
class Writer : public dds::AnyWriter {
  public:
    Writer(const dds::Participant& participant, const std::string& name,
           Delivery delivery = Delivery::kStream)
        : AnyWriter(participant, describeRosTopic(name, typeOf<Message>(), delivery)) {}

    // Waits for no reader: one that is further behind than the depth loses the oldest. False: DDS refuses it.
    bool write(const Message& message) { return AnyWriter::write(&message); }
};

template <class Message>
class Reader : public dds::AnyReader {
  public:
    Reader(const dds::Participant& participant, const std::string& name, Delivery delivery = Delivery::kHeard)
        : AnyReader(participant, describeRosTopic(name, typeOf<Message>(), delivery)) {}

    // Calls take_message(const Message&, const dds::SampleInfo&) for what has come, at most kBatch of it.
    template <class Handler>
    void take(Handler&& take_message) {
        const Batch batch(handle(), kBatch);
        for (size_t i = 0; i < batch.size(); ++i)
            if (batch.info(i).has_data)
                take_message(*static_cast<const Message*>(batch.sample(i)), batch.info(i));
    }
};

}  // namespace bonemill::ros2
