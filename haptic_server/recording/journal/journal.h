// A session's journal: what its threads tell of it goes into an MCAP file that only grows
// (docs/reference/recording.md). A kill loses the last 250 ms at most, the loss of power about a second.
// Nothing waits for the disk: where it is full or too slow, or ticks are lost on the way, the journal says
// from which tick on it is incomplete, and the session goes on.
#pragma once

#include <atomic>
#include <cstdint>
#include <memory>
#include <mutex>
#include <string>
#include <vector>

#include "common/mcap/mcap_writer.h"
#include "haptic_server/core/bone/bone_snapshot.h"
#include "haptic_server/recording/journal/bone_states.h"
#include "haptic_server/recording/journal/input_columns.h"
#include "haptic_server/recording/journal/journal_chain.h"
#include "haptic_server/recording/journal/journal_file.h"
#include "haptic_server/recording/journal/journal_topics.h"
#include "haptic_server/recording/journal/newest_link.h"
#include "haptic_server/recording/statistics/state_hash.h"

namespace bonemill {

struct JournalConfig {
    std::filesystem::path path;
    journal::Manifest manifest;  // of which start_stamp_ns and format are filled in
    RecordedEffects recorded;
    double rate_hz = 1000;
    bool with_results = false;
};

class Journal {
  public:
    // Makes the file. `scanned` must outlive it. Throws UserError.
    Journal(const JournalConfig& config, const DensitiesAsScanned& scanned);
    ~Journal();
    Journal(const Journal&) = delete;
    Journal& operator=(const Journal&) = delete;

    // Any normal thread: this message belongs to the topic. It is in the file 250 ms later.
    void put(JournalTopic topic, const google::protobuf::MessageLite& message);
    // Any normal thread: the bone is, or was, so; of a checkpoint with its number and when it was saved. The
    // densities that differ from the state before are written, and are in the file at once.
    void putBone(std::shared_ptr<const BoneSnapshot> state, uint64_t bone_order);
    void putCheckpoint(std::shared_ptr<const BoneSnapshot> state, uint32_t checkpoint, double session_s);
    // Any thread: why the journal lacks something, for people; empty as long as it does not.
    std::string problem() const;
    // Any thread: so many ticks have come.
    uint64_t ticks() const noexcept { return ticks_.load(std::memory_order_relaxed); }
    const std::filesystem::path& path() const noexcept { return file_.path(); }

    // The recorder thread: the next tick's record; in between, some 200 times per second, round() writes what
    // is due. At the end finish() writes the rest; nothing may come after.
    void add(const TickRecord& record);
    void round();
    void finish();
    // After that: what the chain ends with, as hexadecimal digits (journal_chain.h).
    std::string lastLink() const { return hexOf(chain_.link()); }
    // Any thread: what the chain ends with so far.
    std::shared_ptr<const NewestLink> newestLink() const { return newest_link_; }
    // Before the recorder thread runs: writes what was put, and waits until it is in the file.
    void flush();

  private:
    struct Post {  // what another thread put
        JournalTopic topic;
        int64_t mono_ns;
        std::string message;
        std::shared_ptr<const BoneSnapshot> bone;
        uint64_t bone_order = 0;
        uint32_t checkpoint = 0;
        double session_s = 0;
    };
    void post(Post post);
    void write(JournalTopic topic, int64_t mono_ns, const google::protobuf::MessageLite& message);
    void write(JournalTopic topic, int64_t mono_ns, std::string_view message);
    void writeLink(int64_t mono_ns);
    void writeBone(const Post& post);
    bool isKeyDue(int64_t mono_ns) const noexcept;
    void writePoses(const TickRecord& record);
    void noteGap(uint64_t next_tick);
    void flushTicks();
    void closeChunk();
    uint64_t stampOf(int64_t mono_ns) const noexcept;

    JournalConfig config_;
    int64_t real_minus_mono_ns_;
    uint64_t ticks_per_second_, ticks_per_pose_;
    JournalFile file_;
    mcap::Writer writer_;
    std::string buffer_;
    JournalChain chain_;
    const std::shared_ptr<NewestLink> newest_link_ = std::make_shared<NewestLink>();
    TickHash hash_;
    BoneStateWriter bones_;
    ResultColumns results_;
    std::vector<JournalTick> ticks_waiting_;
    int64_t first_start_ns_ = 0;
    bool has_ticked_ = false;
    int64_t chunk_began_ns_ = 0;
    int64_t last_key_ns_ = 0;
    size_t key_bytes_ = 0, since_key_bytes_ = 0;
    bool has_key_ = false;
    std::atomic<uint64_t> ticks_{0};
    mutable std::mutex mutex_;  // guards what is below
    std::vector<Post> posts_;
    std::string gap_;
};

}  // namespace bonemill
