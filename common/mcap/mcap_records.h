// Schemas, channels and messages, as they follow each other in a chunk; of anyone's making. It is for normal
// threads.
#pragma once

#include <cstdint>
#include <map>
#include <set>
#include <string>
#include <string_view>
#include <vector>

#include "common/mcap/mcap_index.h"
#include "common/mcap/mcap_writer.h"

namespace bonemill::mcap {

// Of a chunk that is unpacked, and more than zstd ever makes of it.
constexpr uint64_t kMaxPlain = kMaxChunk + kMaxMessage;
constexpr uint64_t kMaxPacked = kMaxPlain + kMaxPlain / 128;

// What was found in some bytes, and points into them.
struct FoundRecords {
    std::vector<Message> messages;
    std::vector<std::string_view> schemas, channels;  // records
    std::vector<uint16_t> new_schemas;
    std::vector<Channel> new_channels;
    ChunkPlaces places;
    uint64_t first_ns = 0, last_ns = 0;  // of messages
    uint64_t record_bytes = 0;           // of schemas and channels
};

class KnownRecords {
  public:
    // Others than mcap::Writer say a schema and a channel again in each chunk.
    enum class Repeats { kNone, kAllowed };
    explicit KnownRecords(Repeats repeats) : repeats_(repeats) {}

    // False: they make no sense, or there are too many of them (hasRoomFor()).
    bool find(std::string_view bytes, const Index& known, FoundRecords& found) const;
    // They are kept, and looked through for each message.
    static bool hasRoomFor(const FoundRecords& found, const Index& known);
    // From now on they are known, also to the index.
    void keep(FoundRecords& found, Index& index);

    const Channel& channelOf(const Message& message) const { return channels_.at(message.channel); }

  private:
    bool takeSchema(std::string_view content, std::string_view record, FoundRecords& found) const;
    bool takeChannel(std::string_view content, std::string_view record, FoundRecords& found) const;
    bool takeMessage(std::string_view content, uint64_t offset, FoundRecords& found) const;
    const Channel* channel(uint16_t id, const FoundRecords& found) const;

    Repeats repeats_;
    std::map<uint16_t, Channel> channels_;
    std::set<uint16_t> schemas_;
};

}  // namespace bonemill::mcap
