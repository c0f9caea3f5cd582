// What the end of an MCAP file says of all that is before it. Writer and reader keep one as they go, so that
// a file whose end is missing can be given it. It is for normal threads.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <map>
#include <string>
#include <string_view>
#include <vector>

namespace bonemill::mcap {

// Numbers, texts and records as MCAP writes them (https://mcap.dev/spec): low bytes first, a length before
// each.
static_assert(std::endian::native == std::endian::little, "MCAP is little-endian, and numbers are copied");

enum Op : uint8_t {
    kHeader = 0x01,
    kFooter = 0x02,
    kSchema = 0x03,
    kChannel = 0x04,
    kMessage = 0x05,
    kChunk = 0x06,
    kMessageIndex = 0x07,
    kChunkIndex = 0x08,
    kStatistics = 0x0B,
    kSummaryOffset = 0x0E,
    kDataEnd = 0x0F,
};

constexpr std::string_view kMagic{"\x89MCAP0\r\n", 8};
constexpr std::string_view kZstd = "zstd";
constexpr size_t kRecordHead = 9;  // its kind and its length

template <class Number>
void append(std::string& out, Number number) {
    char bytes[sizeof number];
    std::memcpy(bytes, &number, sizeof number);
    out.append(bytes, sizeof number);
}
inline void appendText(std::string& out, std::string_view text) {
    append(out, uint32_t(text.size()));
    out += text;
}
inline void appendRecord(std::string& out, Op op, std::string_view content) {
    append(out, uint8_t(op));
    append(out, uint64_t(content.size()));
    out += content;
}

// Takes one thing after the other from bytes that anyone may have made. What is not there reads as zero or
// nothing, and from then on isGood() is false.
class Taker {
  public:
    explicit Taker(std::string_view bytes) : rest_(bytes) {}

    template <class Number>
    Number number() {
        Number number{};
        const std::string_view taken = bytes(sizeof number);
        if (taken.size() == sizeof number) std::memcpy(&number, taken.data(), sizeof number);
        return number;
    }
    std::string_view bytes(uint64_t count) {
        if (count > rest_.size()) {
            is_good_ = false;
            rest_ = {};
            return {};
        }
        const std::string_view taken = rest_.substr(0, size_t(count));
        rest_.remove_prefix(size_t(count));
        return taken;
    }
    std::string_view text() { return bytes(number<uint32_t>()); }

    std::string_view rest() const { return rest_; }
    bool isGood() const { return is_good_; }
    // All was there, and nothing more.
    bool isDone() const { return is_good_ && rest_.empty(); }

  private:
    std::string_view rest_;
    bool is_good_ = true;
};

struct Schema {
    uint16_t id = 0;       // not 0
    std::string name;      // of a Protobuf message: with its package
    std::string encoding;  // "protobuf"
    std::string data;      // of Protobuf: a serialized FileDescriptorSet
};

struct Channel {
    uint16_t id = 0;
    uint16_t schema = 0;
    std::string topic;
    std::string encoding;  // of its messages: "protobuf"
};

struct Message {
    uint16_t channel = 0;
    uint32_t sequence = 0;  // counts the channel's messages from 0
    uint64_t time_ns = 0;   // since 1970-01-01
    std::string_view data;
};

// Where the messages of one channel are in a chunk.
struct MessagePlace {
    uint64_t time_ns, offset;
};
using ChunkPlaces = std::map<uint16_t, std::vector<MessagePlace>>;

// It grows by some 100 bytes for each chunk, and by each schema and channel.
class Index {
  public:
    // These bytes come next in the file, before the end of its data.
    void addBytes(std::string_view bytes);
    // These records were met, in a chunk.
    void addSchema(std::string_view record) { schemas_ += record, ++schema_count_; }
    void addChannel(std::string_view record) { channels_ += record, ++channel_count_; }
    // The chunk begins at size() - length. Returns the records that follow it in the file, which are to be
    // added as bytes.
    struct Chunk {
        uint64_t length, packed_size, plain_size, first_ns, last_ns;
    };
    std::string addChunk(const Chunk& chunk, const ChunkPlaces& places);

    // How much of these there is: the whole of it is kept.
    uint64_t recordBytes() const { return schemas_.size() + channels_.size(); }
    uint64_t records() const { return uint64_t(schema_count_) + channel_count_; }
    uint64_t size() const { return size_; }
    uint32_t crc() const { return crc_; }  // of all of that
    uint64_t chunks() const { return chunk_count_; }
    uint64_t messages() const;
    // All that comes after the data: how it ends, the index, and the footer.
    std::string ending() const;

  private:
    std::string summary(uint64_t start) const;

    std::string schemas_, channels_, chunk_records_;
    uint64_t size_ = 0;
    uint32_t crc_ = 0;
    uint16_t schema_count_ = 0;
    uint32_t channel_count_ = 0, chunk_count_ = 0;
    std::map<uint16_t, uint64_t> messages_;  // by channel
    uint64_t first_ns_ = 0, last_ns_ = 0;
};

// CRC-32 as zlib and MCAP have it; `crc` is that of what comes before.
uint32_t crcOf(std::string_view bytes, uint32_t crc = 0);

}  // namespace bonemill::mcap
