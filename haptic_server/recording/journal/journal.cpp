#include "haptic_server/recording/journal/journal.h"

#include <google/protobuf/descriptor.pb.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <utility>

#include "common/rt/clock.h"

namespace bonemill {
namespace {

constexpr int64_t kChunkNs = 200 * kNsPerMillisecond;
constexpr int64_t kKeyNs = 30 * kNsPerSecond;
// A KEY is worth its bytes when the states since the last one have come to this part of it.
constexpr double kKeyShare = 0.25;
constexpr double kPosesPerSecond = 25;
// So long keys the ticks of a message wait at most; a chunk comes earlier at the usual rates.
constexpr size_t kTicksPerMessage = kMaxTicksPerInputs;

int64_t realMinusMonotonicNs() {
    const auto real = std::chrono::system_clock::now().time_since_epoch();
    return std::chrono::duration_cast<std::chrono::nanoseconds>(real).count() - monotonicNowNs();
}

uint64_t ticksPer(double seconds, double rate_hz) {
    return std::max<uint64_t>(1, uint64_t(std::llround(seconds * rate_hz)));
}

void setVector(const double (&v)[3], foxglove::Vector3* out) {
    out->set_x(v[0]), out->set_y(v[1]), out->set_z(v[2]);
}

foxglove::PoseInFrame poseMessage(uint64_t stamp_ns, const double (&p)[3], const double (&q)[4]) {
    foxglove::PoseInFrame message;
    message.mutable_timestamp()->set_seconds(int64_t(stamp_ns / kNsPerSecond));
    message.mutable_timestamp()->set_nanos(int32_t(stamp_ns % kNsPerSecond));
    message.set_frame_id("W");
    setVector(p, message.mutable_pose()->mutable_position());
    foxglove::Quaternion* const rotation = message.mutable_pose()->mutable_orientation();
    rotation->set_w(q[0]), rotation->set_x(q[1]), rotation->set_y(q[2]), rotation->set_z(q[3]);
    return message;
}

size_t bytesOf(const std::vector<journal::Bone>& messages) {
    size_t bytes = 0;
    for (const journal::Bone& message : messages) bytes += message.ByteSizeLong();
    return bytes;
}

}  // namespace

Journal::Journal(const JournalConfig& config, const DensitiesAsScanned& scanned)
    : config_(config),
      real_minus_mono_ns_(realMinusMonotonicNs()),
      ticks_per_second_(ticksPer(1, config.rate_hz)),
      ticks_per_pose_(ticksPer(1 / kPosesPerSecond, config.rate_hz)),
      file_(config.path),
      writer_(kJournalProfile, "bonemill " + config.manifest.build().version()),
      hash_(config.recorded),
      bones_(scanned) {
    const int64_t now_ns = monotonicNowNs();
    config_.manifest.set_format(kJournalFormat);
    config_.manifest.set_start_stamp_ns(int64_t(stampOf(now_ns)));
    for (const JournalTopicName& topic : kJournalTopics) addTopic(topic, writer_);
    write(JournalTopic::kManifest, now_ns, config_.manifest);
    closeChunk();
}

Journal::~Journal() = default;

uint64_t Journal::stampOf(int64_t mono_ns) const noexcept {
    return uint64_t(mono_ns + real_minus_mono_ns_);
}

void Journal::post(Post post) {
    post.mono_ns = monotonicNowNs();
    const std::lock_guard lock(mutex_);
    posts_.push_back(std::move(post));
}

void Journal::put(JournalTopic topic, const google::protobuf::MessageLite& message) {
    post({.topic = topic, .mono_ns = 0, .message = message.SerializeAsString(), .bone = nullptr});
}

void Journal::putBone(std::shared_ptr<const BoneSnapshot> state, uint64_t bone_order) {
    post({.topic = JournalTopic::kBone,
          .mono_ns = 0,
          .message = {},
          .bone = std::move(state),
          .bone_order = bone_order});
}

void Journal::putCheckpoint(std::shared_ptr<const BoneSnapshot> state, uint32_t checkpoint,
                            double session_s) {
    post({.topic = JournalTopic::kBone,
          .mono_ns = 0,
          .message = {},
          .bone = std::move(state),
          .bone_order = 0,
          .checkpoint = checkpoint,
          .session_s = session_s});
}

std::string Journal::problem() const {
    std::string problem = file_.problem();
    if (!problem.empty()) return problem;
    const std::lock_guard lock(mutex_);
    return gap_;
}

void Journal::write(JournalTopic topic, int64_t mono_ns, const google::protobuf::MessageLite& message) {
    buffer_.clear();
    message.AppendToString(&buffer_);
    write(topic, mono_ns, buffer_);
}

void Journal::write(JournalTopic topic, int64_t mono_ns, std::string_view message) {
    chain_.add(topic, stampOf(mono_ns), message);
    writer_.addMessage(uint16_t(topic), stampOf(mono_ns), message);
}

void Journal::writeLink(int64_t mono_ns) {
    journal::Link link;
    link.set_sha256(chain_.close());
    writer_.addMessage(uint16_t(JournalTopic::kChain), stampOf(mono_ns), link.SerializeAsString());
    newest_link_->set(hexOf(chain_.link()));
}

void Journal::add(const TickRecord& record) {
    if (!has_ticked_) first_start_ns_ = record.start_ns;
    if (record.tick != ticks_ && (has_ticked_ || record.tick != 0)) noteGap(record.tick);
    has_ticked_ = true;
    hash_.add(record);
    if (ticks_waiting_.size() == kTicksPerMessage) flushTicks();
    ticks_waiting_.push_back(journalTickOf(record, first_start_ns_, hash_.check()));
    if (config_.with_results) results_.add(record);
    if (record.tick % ticks_per_pose_ == 0) writePoses(record);
    ticks_.store(record.tick + 1, std::memory_order_relaxed);
    if ((record.tick + 1) % ticks_per_second_ != 0) return;
    flushTicks();
    journal::StateHash hash;
    hash.set_ticks(record.tick + 1);
    for (const uint64_t part : hash_.parts()) hash.add_parts(part);
    write(JournalTopic::kStateHash, record.start_ns, hash);
    writeLink(record.start_ns);
}

void Journal::writePoses(const TickRecord& record) {
    const uint64_t stamp_ns = stampOf(record.start_ns);
    write(JournalTopic::kTool, record.start_ns, poseMessage(stamp_ns, record.p_WT, record.q_WT));
    write(JournalTopic::kHand, record.start_ns,
          poseMessage(stamp_ns, record.p_WT_device, record.q_WT_device));
    journal::WrenchInFrame wrench;
    wrench.mutable_timestamp()->set_seconds(int64_t(stamp_ns / kNsPerSecond));
    wrench.mutable_timestamp()->set_nanos(int32_t(stamp_ns % kNsPerSecond));
    wrench.set_frame_id("W");
    setVector(record.f_hand_W, wrench.mutable_force_n());
    setVector(record.t_hand_W, wrench.mutable_torque_nm());
    write(JournalTopic::kWrench, record.start_ns, wrench);
}

void Journal::noteGap(uint64_t next_tick) {
    flushTicks();
    const uint64_t missing = next_tick - ticks_;
    const std::string why = std::to_string(missing) + " ticks came faster than they could be recorded";
    journal::Event event;
    event.set_tick(ticks_);
    event.mutable_incomplete()->set_why(why);
    write(JournalTopic::kEvent, monotonicNowNs(), event);
    const std::lock_guard lock(mutex_);
    if (gap_.empty()) gap_ = why;
}

void Journal::flushTicks() {
    if (!results_.isEmpty())
        write(JournalTopic::kResults, first_start_ns_ + ticks_waiting_.front().start_ns, results_.take());
    if (ticks_waiting_.empty()) return;
    journal::Inputs inputs;
    encodeInputs(ticks_waiting_, inputs);
    write(JournalTopic::kInputs, first_start_ns_ + ticks_waiting_.front().start_ns, inputs);
    ticks_waiting_.clear();
}

bool Journal::isKeyDue(int64_t mono_ns) const noexcept {
    if (!has_key_) return true;
    return mono_ns - last_key_ns_ >= kKeyNs && double(since_key_bytes_) >= kKeyShare * double(key_bytes_) &&
           since_key_bytes_ > 0;
}

void Journal::writeBone(const Post& post) {
    const bool is_key = isKeyDue(post.mono_ns) && post.checkpoint == 0;
    if (!has_key_ && !is_key)
        writeBone({.topic = post.topic,
                   .mono_ns = post.mono_ns,
                   .message = {},
                   .bone = std::make_shared<const BoneSnapshot>()});
    std::vector<journal::Bone> messages =
        bones_.add(*post.bone, is_key                 ? journal::Bone::KEY
                               : post.checkpoint != 0 ? journal::Bone::OTHER
                                                      : journal::Bone::CURRENT);
    const size_t bytes = bytesOf(messages);
    if (is_key) {
        has_key_ = true;
        last_key_ns_ = post.mono_ns;
        key_bytes_ = bytes;
        since_key_bytes_ = 0;
    } else {
        since_key_bytes_ += bytes;
    }
    for (journal::Bone& message : messages) {
        message.set_bone_order(post.bone_order);
        if (!message.goes_on()) {
            message.set_checkpoint(post.checkpoint);
            message.set_checkpoint_session_s(post.session_s);
        }
        write(JournalTopic::kBone, post.mono_ns, message);
    }
}

void Journal::closeChunk() {
    writer_.closeChunk();
    file_.append(writer_.take());
    chunk_began_ns_ = monotonicNowNs();
}

void Journal::round() {
    std::vector<Post> posts;
    {
        const std::lock_guard lock(mutex_);
        posts.swap(posts_);
    }
    bool is_bone = false;
    for (const Post& post : posts) {
        if (post.bone) {
            if (!std::exchange(is_bone, true)) flushTicks();
            writeBone(post);
        } else {
            write(post.topic, post.mono_ns, post.message);
        }
    }
    if (!is_bone && monotonicNowNs() - chunk_began_ns_ < kChunkNs) return;
    flushTicks();
    closeChunk();
}

void Journal::flush() {
    round();
    closeChunk();
    file_.flush();
}

void Journal::finish() {
    round();
    flushTicks();
    journal::Event event;
    event.set_tick(ticks_);
    event.mutable_end()->set_ticks(ticks_);
    write(JournalTopic::kEvent, monotonicNowNs(), event);
    writeLink(monotonicNowNs());
    newest_link_->end();
    writer_.finish();
    file_.append(writer_.take());
    file_.finish();
}

}  // namespace bonemill
