// Makes the bytes of an MCAP file (https://mcap.dev/spec), which stock tools read: in chunks, packed by zstd,
// each with its CRC and an index. It only ever adds at the end, and knows of no file: who writes may be
// killed at any time, and what was whole before is whole. It is for one normal thread at a time.
#pragma once

#include <map>
#include <memory>
#include <string>
#include <string_view>

#include "common/mcap/mcap_index.h"

struct ZSTD_CCtx_s;  // zstd's ZSTD_CCtx

namespace bonemill::mcap {

// A chunk holds no more than this many bytes before they are packed, but for a message that is larger by
// itself.
constexpr size_t kMaxChunk = size_t(16) << 20;
constexpr size_t kMaxMessage = size_t(64) << 20;

class Writer {
  public:
    // Who writes, for people: a name and a version.
    Writer(std::string_view profile, std::string_view library);

    // Both come before the messages that need them, each id once; they go into the chunk under way, whose CRC
    // covers them.
    void addSchema(const Schema& schema);
    void addChannel(const Channel& channel);
    // `data` has kMaxMessage bytes at most.
    void addMessage(uint16_t channel, uint64_t time_ns, std::string_view data);
    // An empty one is none.
    void closeChunk();
    // Closes the chunk and makes the file's end; nothing may come after.
    void finish();

    // Returns what was made since the call before: whole records, to be written at the file's end.
    std::string take();
    // Of all that was made.
    const Index& index() const { return index_; }

  private:
    void emit(std::string_view bytes);

    std::unique_ptr<ZSTD_CCtx_s, size_t (*)(ZSTD_CCtx_s*)> zstd_;
    Index index_;
    std::string out_;
    std::string chunk_, packed_;  // records
    ChunkPlaces places_;
    std::map<uint16_t, uint32_t> sequences_;
    uint64_t first_ns_ = 0, last_ns_ = 0;
};

}  // namespace bonemill::mcap
