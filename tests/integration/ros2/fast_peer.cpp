#include "tests/integration/ros2/fast_peer.h"

#include <fastdds/rtps/transport/UDPv4TransportDescriptor.h>

#include <cstring>
#include <fastdds/dds/domain/DomainParticipant.hpp>
#include <fastdds/dds/domain/DomainParticipantFactory.hpp>
#include <fastdds/dds/publisher/DataWriter.hpp>
#include <fastdds/dds/publisher/Publisher.hpp>
#include <fastdds/dds/subscriber/DataReader.hpp>
#include <fastdds/dds/subscriber/SampleInfo.hpp>
#include <fastdds/dds/subscriber/Subscriber.hpp>
#include <fastdds/dds/topic/Topic.hpp>
#include <fastdds/dds/topic/TopicDataType.hpp>
#include <fastdds/dds/topic/TypeSupport.hpp>
#include <map>
#include <stdexcept>

namespace bonemill::test {
namespace {

namespace fast = eprosima::fastdds::dds;
using Bytes = std::vector<uint8_t>;

// Any message as the bytes that it is.
class RawType final : public fast::TopicDataType {
  public:
    explicit RawType(const std::string& name) {
        setName(name.c_str());
        m_typeSize = 1 << 16;
        m_isGetKeyDefined = false;
    }
    bool serialize(void* data, eprosima::fastrtps::rtps::SerializedPayload_t* payload) override {
        const Bytes& bytes = *static_cast<Bytes*>(data);
        if (bytes.size() > payload->max_size) return false;
        std::memcpy(payload->data, bytes.data(), bytes.size());
        payload->length = uint32_t(bytes.size());
        return true;
    }
    bool deserialize(eprosima::fastrtps::rtps::SerializedPayload_t* payload, void* data) override {
        static_cast<Bytes*>(data)->assign(payload->data, payload->data + payload->length);
        return true;
    }
    std::function<uint32_t()> getSerializedSizeProvider(void* data) override {
        return [data] { return uint32_t(static_cast<Bytes*>(data)->size()); };
    }
    void* createData() override { return new Bytes; }
    void deleteData(void* data) override { delete static_cast<Bytes*>(data); }
    bool getKey(void*, eprosima::fastrtps::rtps::InstanceHandle_t*, bool) override { return false; }
};

template <class Qos>
Qos withQos(Qos qos, const RosQos& wanted) {
    qos.reliability().kind =
        wanted.is_reliable ? fast::RELIABLE_RELIABILITY_QOS : fast::BEST_EFFORT_RELIABILITY_QOS;
    qos.durability().kind =
        wanted.is_transient_local ? fast::TRANSIENT_LOCAL_DURABILITY_QOS : fast::VOLATILE_DURABILITY_QOS;
    qos.history().kind = fast::KEEP_LAST_HISTORY_QOS;
    qos.history().depth = wanted.depth;
    qos.resource_limits().max_samples = 0;
    qos.endpoint().history_memory_policy = eprosima::fastrtps::rtps::PREALLOCATED_WITH_REALLOC_MEMORY_MODE;
    return qos;
}

}  // namespace

CdrBytes::CdrBytes(Bytes bytes) : bytes_(std::move(bytes)) {
    // The coding is CDR, little endian (RTPS 10.2); the other two bytes are for options, and tell how much
    // fills the end.
    is_good_ = bytes_.size() >= 4 && bytes_[0] == 0 && bytes_[1] == 1;
}

bool CdrBytes::skipTo(size_t alignment, size_t bytes) {
    const size_t from = (at_ - 4 + alignment - 1) / alignment * alignment + 4;
    is_good_ = is_good_ && from + bytes <= bytes_.size();
    if (is_good_) at_ = from;
    return is_good_;
}

template <class Number>
Number CdrBytes::number() {
    Number value{};
    if (!skipTo(sizeof(Number), sizeof(Number))) return value;
    std::memcpy(&value, &bytes_[at_], sizeof value);
    at_ += sizeof value;
    return value;
}

template double CdrBytes::number<double>();
template float CdrBytes::number<float>();
template int32_t CdrBytes::number<int32_t>();
template uint32_t CdrBytes::number<uint32_t>();
template uint8_t CdrBytes::number<uint8_t>();

std::string CdrBytes::text() {
    const uint32_t length = u32();
    if (length == 0 || !skipTo(1, length) || bytes_[at_ + length - 1] != 0) {
        is_good_ = false;
        return "";
    }
    const std::string text(reinterpret_cast<const char*>(&bytes_[at_]), length - 1);
    at_ += length;
    return text;
}

template <class Number>
CdrMaker& CdrMaker::put(Number value) {
    while ((bytes_.size() - 4) % sizeof value != 0) bytes_.push_back(0);
    bytes_.resize(bytes_.size() + sizeof value);
    std::memcpy(&bytes_[bytes_.size() - sizeof value], &value, sizeof value);
    return *this;
}

template CdrMaker& CdrMaker::put(double);
template CdrMaker& CdrMaker::put(int32_t);
template CdrMaker& CdrMaker::put(uint32_t);

CdrMaker& CdrMaker::text(const std::string& text) {
    u32(uint32_t(text.size() + 1));
    bytes_.insert(bytes_.end(), text.c_str(), text.c_str() + text.size() + 1);
    return *this;
}

struct FastNode::Inside {
    fast::DomainParticipant* participant = nullptr;
    fast::Subscriber* subscriber = nullptr;
    fast::Publisher* publisher = nullptr;
    std::map<std::string, fast::Topic*> topics;

    fast::Topic* topic(const std::string& name, const std::string& type) {
        if (topics.contains(name)) return topics[name];
        fast::TypeSupport support(new RawType(type));
        support.register_type(participant);
        fast::Topic* const topic = participant->create_topic(name, type, fast::TOPIC_QOS_DEFAULT);
        if (!topic) throw std::runtime_error("Fast DDS has no topic " + name);
        return topics[name] = topic;
    }
};

struct FastNode::Reader::Inside {
    fast::DataReader* reader = nullptr;
};

struct FastNode::Writer::Inside {
    fast::DataWriter* writer = nullptr;
};

FastNode::FastNode(uint32_t domain, bool is_localhost_only) : inside_(std::make_unique<Inside>()) {
    fast::DomainParticipantQos qos;
    qos.transport().use_builtin_transports = false;
    const auto udp = std::make_shared<eprosima::fastdds::rtps::UDPv4TransportDescriptor>();
    if (is_localhost_only) udp->interfaceWhiteList = {"127.0.0.1"};
    udp->receiveBufferSize = 4 << 20;
    qos.transport().user_transports.push_back(udp);
    inside_->participant = fast::DomainParticipantFactory::get_instance()->create_participant(domain, qos);
    if (!inside_->participant) throw std::runtime_error("Fast DDS joins no domain");
    inside_->subscriber = inside_->participant->create_subscriber(fast::SUBSCRIBER_QOS_DEFAULT);
    inside_->publisher = inside_->participant->create_publisher(fast::PUBLISHER_QOS_DEFAULT);
}

FastNode::~FastNode() {
    inside_->participant->delete_contained_entities();
    fast::DomainParticipantFactory::get_instance()->delete_participant(inside_->participant);
}

FastNode::Reader FastNode::read(const std::string& topic, const std::string& type, const RosQos& qos) {
    Reader reader;
    reader.inside_ = std::make_shared<Reader::Inside>();
    reader.inside_->reader = inside_->subscriber->create_datareader(
        inside_->topic(topic, type), withQos(fast::DATAREADER_QOS_DEFAULT, qos));
    if (!reader.inside_->reader) throw std::runtime_error("Fast DDS has no reader of " + topic);
    return reader;
}

std::vector<Bytes> FastNode::Reader::take() {
    std::vector<Bytes> taken;
    Bytes bytes;
    fast::SampleInfo info;
    while (inside_->reader->take_next_sample(&bytes, &info) == ReturnCode_t::RETCODE_OK)
        if (info.valid_data) taken.push_back(bytes);
    return taken;
}

int FastNode::Reader::matchedWriters() const {
    fast::SubscriptionMatchedStatus status;
    inside_->reader->get_subscription_matched_status(status);
    return status.current_count;
}

FastNode::Writer FastNode::writer(const std::string& topic, const std::string& type, const RosQos& qos) {
    Writer writer;
    writer.inside_ = std::make_shared<Writer::Inside>();
    writer.inside_->writer = inside_->publisher->create_datawriter(
        inside_->topic(topic, type), withQos(fast::DATAWRITER_QOS_DEFAULT, qos));
    if (!writer.inside_->writer) throw std::runtime_error("Fast DDS has no writer of " + topic);
    return writer;
}

void FastNode::Writer::write(const Bytes& bytes) {
    inside_->writer->write(const_cast<Bytes*>(&bytes));
}

int FastNode::Writer::matchedReaders() const {
    fast::PublicationMatchedStatus status;
    inside_->writer->get_publication_matched_status(status);
    return status.current_count;
}

}  // namespace bonemill::test
