#include "common/dds/endpoint.h"

#include <dds/dds.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <atomic>
#include <memory>
#include <utility>

namespace bonemill::dds {
namespace {

// Writers are for what this program may say; with DDS Security its permissions tell. What they do not name
// stays unsaid, and a viewer that only looks is none the worse for it.
bool isForbidden(int32_t result) {
    return result == DDS_RETCODE_NOT_ALLOWED_BY_SECURITY;
}

Entity createTopic(int32_t participant, const TopicDescription& description) {
    return requireEntity(dds_create_topic(participant, description.type, description.name, nullptr, nullptr),
                         std::string("topic ") + description.name);
}

// A hostile peer that makes endpoints without end must not fill the log.
void logMismatch(const char* peer, const void* topic, const char* own, uint32_t policy) {
    static std::atomic<uint64_t> named = 0;
    if (named.fetch_add(1, std::memory_order_relaxed) >= kMaxNamedMismatches) return;
    spdlog::warn(
        "DDS: a {} of {} does not match this program's {} (QoS policy {}): another version of bonemill?",
        peer, static_cast<const char*>(topic), own, policy);
}

void logOffered(dds_entity_t, const dds_offered_incompatible_qos_status_t status, void* topic) {
    logMismatch("reader", topic, "writer", status.last_policy_id);
}

void logRequested(dds_entity_t, const dds_requested_incompatible_qos_status_t status, void* topic) {
    logMismatch("writer", topic, "reader", status.last_policy_id);
}

struct DeleteListener {
    void operator()(dds_listener_t* listener) const { dds_delete_listener(listener); }
};

// Without it, programs of different versions ignore each other in silence. It is called on Cyclone's threads.
std::unique_ptr<dds_listener_t, DeleteListener> mismatchListener(const char* topic) {
    std::unique_ptr<dds_listener_t, DeleteListener> listener(dds_create_listener(const_cast<char*>(topic)));
    dds_lset_offered_incompatible_qos(listener.get(), logOffered);
    dds_lset_requested_incompatible_qos(listener.get(), logRequested);
    return listener;
}

Entity createReader(int32_t participant, const Entity& topic, const TopicDescription& description) {
    return requireEntity(dds_create_reader(participant, topic.handle(), description.qos.get(),
                                           mismatchListener(description.name).get()),
                         std::string("reader of ") + description.name);
}

struct FreeEndpoint {
    void operator()(dds_builtintopic_endpoint_t* endpoint) const { dds_builtintopic_free_endpoint(endpoint); }
};

// Null if the writer is not matched.
std::unique_ptr<dds_builtintopic_endpoint_t, FreeEndpoint> endpointOf(const Entity& reader, uint64_t writer) {
    return std::unique_ptr<dds_builtintopic_endpoint_t, FreeEndpoint>(
        dds_get_matched_publication_data(reader.handle(), writer));
}

}  // namespace

AnyWriter::AnyWriter(const Participant& participant, const TopicDescription& description)
    : name_(description.name) {
    const int32_t topic =
        dds_create_topic(participant.handle(), description.type, description.name, nullptr, nullptr);
    if (isForbidden(topic)) return;
    topic_ = requireEntity(topic, "topic " + name_);
    const int32_t writer = dds_create_writer(participant.handle(), topic, description.qos.get(),
                                             mismatchListener(description.name).get());
    if (!isForbidden(writer)) writer_ = requireEntity(writer, "writer of " + name_);
}

bool AnyWriter::write(const void* sample) {
    return isAllowed() && check(dds_write(writer_.handle(), sample), "write");
}

bool AnyWriter::dispose(const void* sample) {
    return isAllowed() && check(dds_dispose(writer_.handle(), sample), "dispose");
}

bool AnyWriter::check(int32_t result, const char* action) {
    if (result == DDS_RETCODE_OK) return true;
    if (!has_failed_) spdlog::error("DDS: cannot {} {}: {}", action, name_, dds_strretcode(result));
    has_failed_ = true;
    return false;
}

int AnyWriter::matchedReaders() const {
    dds_publication_matched_status_t status{};
    if (!isAllowed()) return 0;
    dds_get_publication_matched_status(writer_.handle(), &status);
    return static_cast<int>(status.current_count);
}

uint32_t AnyWriter::readersSoFar() const {
    dds_publication_matched_status_t status{};
    if (isAllowed()) dds_get_publication_matched_status(writer_.handle(), &status);
    return status.total_count;
}

AnyReader::AnyReader(const Participant& participant, const TopicDescription& description)
    : participant_(participant.handle()),
      topic_(createTopic(participant_, description)),
      reader_(createReader(participant_, topic_, description)) {}

void AnyReader::beginAnew(const TopicDescription& description) {
    Entity next = createReader(participant_, topic_, description);
    std::swap(reader_, next);
}

int AnyReader::matchedWriters() const {
    dds_subscription_matched_status_t status{};
    dds_get_subscription_matched_status(reader_.handle(), &status);
    return static_cast<int>(status.current_count);
}

bool AnyReader::isMatched(uint64_t writer) const {
    std::array<dds_instance_handle_t, kBatch> writers;
    const int32_t count = dds_get_matched_publications(reader_.handle(), writers.data(), writers.size());
    if (count > int32_t(writers.size())) return participantOf(writer) != 0;  // too many to look through
    return std::find(writers.begin(), writers.begin() + std::max(count, 0), writer) !=
           writers.begin() + std::max(count, 0);
}

uint64_t AnyReader::participantOf(uint64_t writer) const {
    const auto endpoint = endpointOf(reader_, writer);
    if (!endpoint) return 0;
    const auto& guid = endpoint->participant_key.v;
    const std::string_view bytes(reinterpret_cast<const char*>(guid), sizeof guid);
    return std::max<uint64_t>(std::hash<std::string_view>()(bytes), 1);
}

std::optional<GuidPrefix> AnyReader::ownerOf(uint64_t writer) const {
    const auto endpoint = endpointOf(reader_, writer);
    if (!endpoint) return std::nullopt;
    GuidPrefix prefix;
    std::copy_n(std::begin(endpoint->participant_key.v), prefix.size(), prefix.begin());
    return prefix;
}

// Cyclone tells it of each participant, in the properties of its QoS.
std::string AnyReader::hostOf(uint64_t writer) const {
    const auto endpoint = endpointOf(reader_, writer);
    if (!endpoint) return "";
    const int32_t participant = dds_get_participant(reader_.handle());
    const Entity people(
        requireEntity(dds_create_reader(participant, DDS_BUILTIN_TOPIC_DCPSPARTICIPANT, nullptr, nullptr),
                      "reader of participants"));
    void* sample = nullptr;
    dds_sample_info_t info;
    std::string host;
    if (dds_read_instance(people.handle(), &sample, &info, 1, 1, endpoint->participant_instance_handle) > 0) {
        char* name = nullptr;
        if (info.valid_data && dds_qget_prop(static_cast<const dds_builtintopic_participant_t*>(sample)->qos,
                                             "__Hostname", &name))
            host = name;
        dds_free(name);
        dds_return_loan(people.handle(), &sample, 1);
    }
    return host;
}

AnyReader::Batch::Batch(int32_t reader, size_t max_samples) : reader_(reader) {
    const size_t wanted = std::min(max_samples, kBatch);
    std::array<dds_sample_info_t, kBatch> infos;
    const int32_t taken =
        dds_take(reader_, samples_.data(), infos.data(), wanted, static_cast<uint32_t>(wanted));
    size_ = static_cast<size_t>(std::max(taken, 0));
    for (size_t i = 0; i < size_; ++i) {
        infos_[i] = {infos[i].valid_data, infos[i].instance_state == DDS_NOT_ALIVE_DISPOSED_INSTANCE_STATE,
                     infos[i].publication_handle, infos[i].view_state == DDS_NEW_VIEW_STATE};
    }
}

AnyReader::Batch::~Batch() {
    if (size_ > 0) dds_return_loan(reader_, samples_.data(), static_cast<int32_t>(size_));
}

WaitSet::WaitSet(const Participant& participant)
    : set_(requireEntity(dds_create_waitset(participant.handle()), "DDS wait set")) {}

void WaitSet::add(std::function<int32_t()> handle) {
    watched_.push_back({std::move(handle), 0, Entity()});
    watch(watched_.back());
}

// The condition of a reader that is gone went with it.
void WaitSet::watch(Watched& watched) {
    const int32_t reader = watched.handle();
    if (reader == watched.reader) return;
    watched.reader = reader;
    watched.condition = Entity();
    if (reader == 0) return;
    watched.condition = requireEntity(dds_create_readcondition(reader, DDS_ANY_STATE), "DDS read condition");
    dds_waitset_attach(set_.handle(), watched.condition.handle(), watched.condition.handle());
}

bool WaitSet::wait(std::chrono::nanoseconds timeout) {
    for (Watched& watched : watched_) watch(watched);
    return dds_waitset_wait(set_.handle(), nullptr, 0, timeout.count()) > 0;
}

}  // namespace bonemill::dds
