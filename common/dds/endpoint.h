// Typed writer and reader of one topic belong to one thread per object; they are not for the tick.
// Constructors throw UserError. Peers that do not match because of their QoS or type are logged.
#pragma once

#include <array>
#include <chrono>
#include <cstddef>
#include <cstdint>
#include <functional>
#include <optional>
#include <span>
#include <string>
#include <vector>

#include "common/dds/participant.h"
#include "common/dds/topic_traits.h"

namespace bonemill::dds {

// How many peers that do not match a process logs.
inline constexpr uint64_t kMaxNamedMismatches = 20;

struct SampleInfo {
    bool has_data = false;     // false: only the key fields of the sample are set
    bool is_disposed = false;  // the key is gone on purpose; a writer that merely left does not dispose
    uint64_t writer = 0;       // who wrote or disposed
    bool is_new_key = false;   // it is the first sample of its key
};

class AnyWriter {
  public:
    AnyWriter(const Participant& participant, const TopicDescription& description);

    // It is false when DDS refused; the first refusal is logged, but not that this program may not write
    // there (isAllowed()).
    bool write(const void* sample);
    // Only the key fields of the sample count. The instance stays registered, so that a reader that was away
    // learns it.
    bool dispose(const void* sample);
    int matchedReaders() const;
    // Counts all that ever were: with a larger number somebody has come since.
    uint32_t readersSoFar() const;
    // It is false when this program's identity (--secure) may not write there: then nothing is ever written.
    bool isAllowed() const noexcept { return writer_.handle() > 0; }

  private:
    bool check(int32_t result, const char* action);

    Entity topic_;
    Entity writer_;
    std::string name_;
    bool has_failed_ = false;
};

class AnyReader {
  public:
    static constexpr size_t kBatch = 64;
    // Samples are on loan from Cyclone and given back on destruction.
    class Batch {
      public:
        Batch(int32_t reader, size_t max_samples);
        Batch(const Batch&) = delete;
        Batch& operator=(const Batch&) = delete;
        ~Batch();

        size_t size() const noexcept { return size_; }
        const void* sample(size_t i) const noexcept { return samples_[i]; }
        const SampleInfo& info(size_t i) const noexcept { return infos_[i]; }

      private:
        int32_t reader_;
        size_t size_ = 0;
        std::array<void*, kBatch> samples_{};
        std::array<SampleInfo, kBatch> infos_{};
    };

    AnyReader(const Participant& participant, const TopicDescription& description);

    // It becomes a new reader of the same topic, with another handle: all that it had heard is forgotten,
    // what waits to be taken, too. Throws UserError, and stays what it was.
    void beginAnew(const TopicDescription& description);
    int32_t handle() const noexcept { return reader_.handle(); }
    int matchedWriters() const;
    // Takes a SampleInfo::writer; it is matched until it leaves, or is silent for longer than the lease.
    bool isMatched(uint64_t writer) const;
    // Returns the name of the PC that a matched writer runs on; empty if it is not told.
    std::string hostOf(uint64_t writer) const;
    // Returns a number that all writers of a participant share and those of no other one do, also when it is
    // matched anew; 0 if the writer is not matched.
    uint64_t participantOf(uint64_t writer) const;
    // Returns what the GUID of a matched writer's participant begins with. With --secure it proves who that
    // is.
    std::optional<GuidPrefix> ownerOf(uint64_t writer) const;

  private:
    int32_t participant_;
    Entity topic_;
    Entity reader_;
};

template <class Sample>
class Writer : public AnyWriter {
  public:
    explicit Writer(const Participant& participant) : AnyWriter(participant, describeTopic<Sample>()) {}

    bool write(const Sample& sample) { return AnyWriter::write(&sample); }
    bool dispose(const Sample& sample) { return AnyWriter::dispose(&sample); }
};

template <class Sample>
class Reader : public AnyReader {
  public:
    explicit Reader(const Participant& participant) : Reader(participant, describeTopic<Sample>()) {}

    // Calls take_sample(const Sample&, const SampleInfo&) for at most `max_samples` new samples; returns how
    // many. The sample lives only during the call.
    //
    // Cyclone keeps every key that a writer ever used for as long as that writer lives. A reader that has
    // heard of too many (TopicDescription::most_keys) begins anew, its handle changes, and strangers who fill
    // it keep out no other sender.
    template <class Handler>
    size_t take(size_t max_samples, Handler&& take_sample) {
        forgetTooMany();
        size_t taken = 0;
        while (taken < max_samples) {
            const Batch batch(handle(), max_samples - taken);
            if (batch.size() == 0) break;
            for (size_t i = 0; i < batch.size(); ++i) {
                new_keys_ += batch.info(i).is_new_key;
                take_sample(*static_cast<const Sample*>(batch.sample(i)), batch.info(i));
            }
            taken += batch.size();
        }
        return taken;
    }

  private:
    Reader(const Participant& participant, const TopicDescription& description)
        : AnyReader(participant, description), most_keys_(description.most_keys) {}

    void forgetTooMany() {
        if (most_keys_ == 0 || new_keys_ < most_keys_) return;
        new_keys_ = 0;
        beginAnew(describeTopic<Sample>());
    }

    size_t most_keys_;
    size_t new_keys_ = 0;
};

// Lets the sample's payload point at `bytes`, which must outlive the write; nothing is copied.
template <class Sample>
void setPayload(Sample& sample, const std::string& bytes) {
    sample.payload._length = sample.payload._maximum = static_cast<uint32_t>(bytes.size());
    sample.payload._buffer = reinterpret_cast<uint8_t*>(const_cast<char*>(bytes.data()));
    sample.payload._release = false;
}
template <class Sample>
void setPayload(Sample&, std::string&&) = delete;

template <class Sample>
std::span<const uint8_t> payloadOf(const Sample& sample) {
    return {sample.payload._buffer, sample.payload._length};
}

// Sleeps until one of several readers has samples.
class WaitSet {
  public:
    explicit WaitSet(const Participant& participant);

    // `handle` is asked before each wait, for a reader may begin anew; 0: there is none.
    void add(std::function<int32_t()> handle);
    // Returns true when a reader has samples to take, false when `timeout` passed before.
    bool wait(std::chrono::nanoseconds timeout);

  private:
    struct Watched {
        std::function<int32_t()> handle;
        int32_t reader;
        Entity condition;
    };
    void watch(Watched& watched);

    Entity set_;
    std::vector<Watched> watched_;
};

}  // namespace bonemill::dds
