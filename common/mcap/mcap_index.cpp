#include "common/mcap/mcap_index.h"

#include <zlib.h>

#include <algorithm>

namespace bonemill::mcap {
namespace {

std::string messageIndexOf(uint16_t channel, const std::vector<MessagePlace>& places) {
    std::string content, record;
    append(content, channel);
    append(content, uint32_t(places.size() * 2 * sizeof(uint64_t)));
    for (const MessagePlace& place : places) append(content, place.time_ns), append(content, place.offset);
    appendRecord(record, kMessageIndex, content);
    return record;
}

template <class Numbers>
void appendMap(std::string& out, const Numbers& numbers) {
    append(out, uint32_t(numbers.size() * (sizeof(uint16_t) + sizeof(uint64_t))));
    for (const auto& [channel, number] : numbers) append(out, channel), append(out, number);
}

}  // namespace

uint32_t crcOf(std::string_view bytes, uint32_t crc) {
    return uint32_t(crc32_z(crc, reinterpret_cast<const Bytef*>(bytes.data()), bytes.size()));
}

void Index::addBytes(std::string_view bytes) {
    size_ += bytes.size();
    crc_ = crcOf(bytes, crc_);
}

std::string Index::addChunk(const Chunk& chunk, const ChunkPlaces& places) {
    const bool is_first = messages_.empty();
    std::string message_indexes;
    std::map<uint16_t, uint64_t> offsets;
    for (const auto& [channel, of_channel] : places) {
        offsets[channel] = size_ + message_indexes.size();
        message_indexes += messageIndexOf(channel, of_channel);
        messages_[channel] += of_channel.size();
    }
    if (!places.empty()) {
        first_ns_ = is_first ? chunk.first_ns : std::min(first_ns_, chunk.first_ns);
        last_ns_ = std::max(last_ns_, chunk.last_ns);
    }
    std::string content;
    append(content, chunk.first_ns), append(content, chunk.last_ns);
    append(content, size_ - chunk.length), append(content, chunk.length);
    appendMap(content, offsets);
    append(content, uint64_t(message_indexes.size()));
    appendText(content, kZstd);
    append(content, chunk.packed_size), append(content, chunk.plain_size);
    appendRecord(chunk_records_, kChunkIndex, content);
    ++chunk_count_;
    return message_indexes;
}

uint64_t Index::messages() const {
    uint64_t all = 0;
    for (const auto& [channel, count] : messages_) all += count;
    return all;
}

std::string Index::summary(uint64_t start) const {
    std::string statistics, out = schemas_ + channels_ + chunk_records_;
    append(statistics, messages());
    append(statistics, schema_count_), append(statistics, channel_count_);
    append(statistics, uint32_t(0)), append(statistics, uint32_t(0));  // attachments, metadata
    append(statistics, chunk_count_);
    append(statistics, first_ns_), append(statistics, last_ns_);
    appendMap(statistics, messages_);
    const uint64_t statistics_at = out.size();
    appendRecord(out, kStatistics, statistics);
    const uint64_t offsets_at = start + out.size();

    const auto appendOffset = [&](Op op, uint64_t at, uint64_t length) {
        if (length == 0) return;
        std::string offset;
        append(offset, uint8_t(op)), append(offset, start + at), append(offset, length);
        appendRecord(out, kSummaryOffset, offset);
    };
    const uint64_t statistics_length = out.size() - statistics_at;
    appendOffset(kSchema, 0, schemas_.size());
    appendOffset(kChannel, schemas_.size(), channels_.size());
    appendOffset(kChunkIndex, schemas_.size() + channels_.size(), chunk_records_.size());
    appendOffset(kStatistics, statistics_at, statistics_length);

    append(out, uint8_t(kFooter));
    append(out, uint64_t(2 * sizeof(uint64_t) + sizeof(uint32_t)));
    append(out, start), append(out, offsets_at);
    append(out, crcOf(out));
    return out;
}

std::string Index::ending() const {
    std::string out, crc;
    append(crc, crc_);
    appendRecord(out, kDataEnd, crc);
    out += summary(size_ + out.size());
    out += kMagic;
    return out;
}

}  // namespace bonemill::mcap
