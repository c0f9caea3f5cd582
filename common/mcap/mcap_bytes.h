// Numbers, texts and records as MCAP writes them (https://mcap.dev/spec): low bytes first, a length before
// each. They are for normal threads.
#pragma once

#include <bit>
#include <cstdint>
#include <cstring>
#include <string>
#include <string_view>

namespace bonemill::mcap {

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

}  // namespace bonemill::mcap
