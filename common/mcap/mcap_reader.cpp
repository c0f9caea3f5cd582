#include "common/mcap/mcap_reader.h"

#include <zstd.h>

#include <algorithm>
#include <istream>
#include <optional>

#include "common/mcap/mcap_index.h"
#include "common/mcap/mcap_writer.h"

namespace bonemill::mcap {
namespace {

constexpr uint64_t kMaxHeader = 4096;
constexpr uint64_t kMaxPlain = kMaxChunk + kMaxMessage;
constexpr uint64_t kMaxPacked = kMaxPlain + kMaxPlain / 128;  // more than zstd ever makes of it
constexpr uint64_t kMaxTorn = uint64_t(1) << 20;              // of one chunk

// The rest of the file, of which no more is read than is there.
class Input {
  public:
    explicit Input(std::istream& stream) : stream_(stream) {
        stream_.seekg(0, std::ios::end);
        left_ = stream_ ? uint64_t(stream_.tellg()) : 0;
        stream_.seekg(0);
    }
    uint64_t left() const { return left_; }
    // False: it is not all there.
    bool take(uint64_t count, std::string& bytes) {
        bytes.clear();
        if (count > left_) return false;
        bytes.resize(size_t(count));
        if (!stream_.read(bytes.data(), std::streamsize(count))) return false;
        left_ -= count;
        return true;
    }

  private:
    std::istream& stream_;
    uint64_t left_ = 0;
};

// A chunk that is unpacked; its messages point into it.
struct OpenChunk {
    std::string plain;
    std::vector<Message> messages;
    std::vector<std::string_view> schemas, channels;  // records
    std::vector<Channel> new_channels;
    ChunkPlaces places;
    uint64_t first_ns = 0, last_ns = 0;
    uint64_t record_bytes = 0;  // of schemas and channels
};

class FileReader {
  public:
    FileReader(std::istream& stream, const Visit& visit)
        : input_(stream), size_(input_.left()), visit_(visit) {}

    Reading read() {
        readHeader();
        while (out_.problem.empty() && !is_at_end_) readRecord();
        if (out_.problem.empty()) readEnding();
        out_.is_whole = out_.problem.empty();
        out_.lost_bytes = out_.is_whole ? 0 : size_ - out_.index.size();
        out_.is_torn_chunk = out_.is_whole || (is_cut_off_ && out_.lost_bytes <= kMaxTorn);
        return std::move(out_);
    }

  private:
    void fail(const std::string& what) {
        out_.problem = what + " at byte " + std::to_string(out_.index.size());
    }

    bool takeAll(uint64_t count, std::string& bytes) {
        is_cut_off_ = count > input_.left();
        return input_.take(count, bytes);
    }
    // False: no whole record is there.
    bool takeRecord(uint64_t most) {
        std::string head;
        if (!takeAll(kRecordHead, head)) return false;
        Taker taker(head);
        op_ = taker.number<uint8_t>();
        const auto length = taker.number<uint64_t>();
        if (length > most || !takeAll(length, content_)) return false;
        record_size_ = kRecordHead + length;
        head_ = std::move(head);
        return true;
    }
    void keepRecord() { out_.index.addBytes(head_), out_.index.addBytes(content_); }

    void readHeader() {
        std::string magic;
        if (!input_.take(kMagic.size(), magic) || magic != kMagic) return fail("this is no MCAP file");
        if (!takeRecord(kMaxHeader) || op_ != kHeader) return fail("the header is torn or changed");
        Taker taker(content_);
        out_.profile = taker.text(), out_.library = taker.text();
        if (!taker.isDone()) return fail("the header is torn or changed");
        out_.index.addBytes(kMagic);
        keepRecord();
    }

    void readRecord() {
        is_cut_off_ = input_.left() == 0;
        if (is_cut_off_) return fail("the end is missing: whoever wrote it was stopped");
        if (!takeRecord(kMaxPacked)) return fail("the file is torn");
        if (op_ == kDataEnd) {
            is_at_end_ = true;
            return;
        }
        OpenChunk chunk;
        if (op_ != kChunk || !open(chunk))
            return fail(hasRoomFor(chunk) ? "a chunk is damaged" : "there are too many schemas and channels");
        keep(chunk);
        for (const Message& message : chunk.messages) visit_(channels_.at(message.channel), message);
    }

    bool open(OpenChunk& chunk) {
        Taker taker(content_);
        const auto first_ns = taker.number<uint64_t>(), last_ns = taker.number<uint64_t>();
        const auto plain_size = taker.number<uint64_t>();
        const auto crc = taker.number<uint32_t>();
        const bool is_zstd = taker.text() == kZstd;
        const std::string_view packed = taker.bytes(taker.number<uint64_t>());
        if (!taker.isDone() || !is_zstd || plain_size > kMaxPlain) return false;
        if (ZSTD_getFrameContentSize(packed.data(), packed.size()) != plain_size) return false;
        chunk.plain.resize(size_t(plain_size));
        const size_t unpacked =
            ZSTD_decompress(chunk.plain.data(), chunk.plain.size(), packed.data(), packed.size());
        if (unpacked != plain_size || crcOf(chunk.plain) != crc) return false;
        packed_size_ = packed.size();
        return parse(chunk) && chunk.first_ns == first_ns && chunk.last_ns == last_ns;
    }

    // Its CRC is right; yet whoever made it may have made it so.
    bool parse(OpenChunk& chunk) {
        Taker taker(chunk.plain);
        while (!taker.rest().empty()) {
            const std::string_view start = taker.rest();
            const auto op = taker.number<uint8_t>();
            const std::string_view content = taker.bytes(taker.number<uint64_t>());
            if (!taker.isGood()) return false;
            const std::string_view record = start.substr(0, kRecordHead + content.size());
            const auto offset = uint64_t(start.data() - chunk.plain.data());
            if (op == kSchema)
                chunk.schemas.push_back(record);
            else if (op == kChannel ? !takeChannel(content, record, chunk)
                                    : op != kMessage || !takeMessage(content, offset, chunk))
                return false;
            if (op != kMessage) chunk.record_bytes += record.size();
            if (!hasRoomFor(chunk)) return false;
        }
        return true;
    }

    // They are kept, and looked through for each message.
    bool hasRoomFor(const OpenChunk& chunk) const {
        return out_.index.recordBytes() + chunk.record_bytes <= kMaxRecordBytes &&
               out_.index.records() + chunk.schemas.size() + chunk.channels.size() <= kMaxRecords;
    }

    bool takeChannel(std::string_view content, std::string_view record, OpenChunk& chunk) {
        Taker taker(content);
        Channel channel;
        channel.id = taker.number<uint16_t>(), channel.schema = taker.number<uint16_t>();
        channel.topic = taker.text(), channel.encoding = taker.text();
        taker.text();  // metadata
        if (!taker.isDone() || find(channel.id, chunk)) return false;
        chunk.channels.push_back(record);
        chunk.new_channels.push_back(std::move(channel));
        return true;
    }

    bool find(uint16_t id, const OpenChunk& chunk) const {
        return channels_.contains(id) ||
               std::ranges::any_of(chunk.new_channels,
                                   [id](const Channel& channel) { return channel.id == id; });
    }

    bool takeMessage(std::string_view content, uint64_t offset, OpenChunk& chunk) {
        Taker taker(content);
        Message message;
        message.channel = taker.number<uint16_t>(), message.sequence = taker.number<uint32_t>();
        message.time_ns = taker.number<uint64_t>();
        taker.number<uint64_t>();  // when it was published
        message.data = taker.rest();
        if (!taker.isGood() || !find(message.channel, chunk)) return false;
        const bool is_first = chunk.messages.empty();
        chunk.first_ns = is_first ? message.time_ns : std::min(chunk.first_ns, message.time_ns);
        chunk.last_ns = std::max(chunk.last_ns, message.time_ns);
        chunk.places[message.channel].push_back({message.time_ns, offset});
        chunk.messages.push_back(message);
        return true;
    }

    // What follows the chunk in the file is known from it.
    void keep(OpenChunk& chunk) {
        keepRecord();
        for (const std::string_view record : chunk.schemas) out_.index.addSchema(record);
        for (const std::string_view record : chunk.channels) out_.index.addChannel(record);
        for (Channel& channel : chunk.new_channels) channels_[channel.id] = std::move(channel);
        const std::string indexes = out_.index.addChunk(
            {record_size_, packed_size_, chunk.plain.size(), chunk.first_ns, chunk.last_ns}, chunk.places);
        std::string found;
        if (takeAll(indexes.size(), found) && found == indexes) return out_.index.addBytes(indexes);
        fail("the index of a chunk is torn or changed");
        out_.missing = indexes;
    }

    // It is known from what is before it, too.
    void readEnding() {
        const std::string ending = out_.index.ending();
        std::string found = head_ + content_, rest;
        const bool is_longer = found.size() + input_.left() > ending.size();
        if (!is_longer && input_.take(input_.left(), rest)) found += rest;
        if (found == ending && !is_longer) return;
        is_cut_off_ = !is_longer && ending.starts_with(found);
        fail("the end is torn or changed, or something before it that no chunk covers,");
    }

    Input input_;
    uint64_t size_;
    const Visit& visit_;
    Reading out_;
    std::map<uint16_t, Channel> channels_;
    uint8_t op_ = 0;
    std::string head_, content_;  // of the record under way
    uint64_t record_size_ = 0, packed_size_ = 0;
    bool is_at_end_ = false;
    bool is_cut_off_ = false;  // what was taken last goes on behind the file's end
};

}  // namespace

Reading read(std::istream& input, const Visit& visit) {
    return FileReader(input, visit).read();
}

}  // namespace bonemill::mcap
