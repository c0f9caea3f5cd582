#include "common/mcap/mcap_writer.h"

#include <zstd.h>

#include <algorithm>
#include <new>
#include <utility>

#include "common/base/assert.h"
#include "common/mcap/mcap_index.h"

namespace bonemill::mcap {
namespace {

constexpr int kLevel = 3;

}  // namespace

Writer::Writer(std::string_view profile, std::string_view library) : zstd_(ZSTD_createCCtx(), ZSTD_freeCCtx) {
    if (!zstd_) throw std::bad_alloc();
    std::string header, start{kMagic};
    appendText(header, profile), appendText(header, library);
    appendRecord(start, kHeader, header);
    emit(start);
}

void Writer::emit(std::string_view bytes) {
    index_.addBytes(bytes);
    out_ += bytes;
}

void Writer::addSchema(const Schema& schema) {
    std::string content, record;
    append(content, schema.id);
    appendText(content, schema.name), appendText(content, schema.encoding), appendText(content, schema.data);
    appendRecord(record, kSchema, content);
    index_.addSchema(record);
    chunk_ += record;
}

void Writer::addChannel(const Channel& channel) {
    std::string content, record;
    append(content, channel.id), append(content, channel.schema);
    appendText(content, channel.topic), appendText(content, channel.encoding);
    append(content, uint32_t(0));  // metadata
    appendRecord(record, kChannel, content);
    index_.addChannel(record);
    chunk_ += record;
}

void Writer::addMessage(uint16_t channel, uint64_t time_ns, std::string_view data) {
    BONEMILL_ASSERT(data.size() <= kMaxMessage);
    if (!chunk_.empty() && chunk_.size() + data.size() > kMaxChunk) closeChunk();
    first_ns_ = places_.empty() ? time_ns : std::min(first_ns_, time_ns);
    last_ns_ = places_.empty() ? time_ns : std::max(last_ns_, time_ns);
    places_[channel].push_back({time_ns, chunk_.size()});
    append(chunk_, uint8_t(kMessage));
    append(chunk_, uint64_t(sizeof channel + sizeof(uint32_t) + 2 * sizeof time_ns + data.size()));
    append(chunk_, channel), append(chunk_, sequences_[channel]++);
    append(chunk_, time_ns), append(chunk_, time_ns);
    chunk_ += data;
}

void Writer::closeChunk() {
    if (chunk_.empty()) return;
    packed_.resize(ZSTD_compressBound(chunk_.size()));
    const size_t packed =
        ZSTD_compressCCtx(zstd_.get(), packed_.data(), packed_.size(), chunk_.data(), chunk_.size(), kLevel);
    if (ZSTD_isError(packed)) throw std::bad_alloc();  // nothing else can go wrong
    std::string content, record;
    append(content, first_ns_), append(content, last_ns_);
    append(content, uint64_t(chunk_.size())), append(content, crcOf(chunk_));
    appendText(content, kZstd);
    append(content, uint64_t(packed));
    content.append(packed_, 0, packed);
    appendRecord(record, kChunk, content);
    emit(record);
    emit(index_.addChunk({record.size(), packed, chunk_.size(), first_ns_, last_ns_}, places_));
    chunk_.clear();
    places_.clear();
    first_ns_ = last_ns_ = 0;
}

void Writer::finish() {
    closeChunk();
    out_ += index_.ending();
}

std::string Writer::take() {
    return std::exchange(out_, {});
}

}  // namespace bonemill::mcap
