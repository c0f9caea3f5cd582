// Cuts what a peer sends by OpenIGTLink into frames, and writes frames: a header of 58 bytes (big-endian),
// then a body. What comes is believed only after its bounds: version, type, size of the body before any of it
// is kept, then the checksum. It takes any bytes, never throws on them, and holds no more than the largest
// body that is wanted. For one thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <functional>
#include <string>
#include <string_view>
#include <vector>

namespace bonemill::igtl {

inline constexpr size_t kHeaderBytes = 58, kTypeBytes = 12, kDeviceBytes = 20;

// The CRC-64 of ECMA-182, not reflected, begun with 0.
uint64_t crcOf(std::string_view bytes) noexcept;

struct Frame {
    std::string type, device;
    std::string body;  // without what version 3 has around it
};

// Unix time in ns as OpenIGTLink has it: seconds in the upper 32 bits, their fraction in the lower.
uint64_t stampOf(int64_t unix_ns) noexcept;

// Returns the whole frame, in version 1 of the header, which every peer reads. Type and device are cut to
// what the header has room for.
std::string frameOf(std::string_view type, std::string_view device, int64_t unix_ns, std::string_view body);

// A type that is wanted, and how long its body may be.
struct WantedType {
    std::string type;
    size_t least, most;  // bytes
};

class FrameReader {
  public:
    // What nobody asked for is read past, up to this size.
    static constexpr uint64_t kMostSkipped = 1 << 20;
    // Around a body of version 3: its own header and metadata.
    static constexpr size_t kMostAround = 4096;

    explicit FrameReader(std::vector<WantedType> wanted) : wanted_(std::move(wanted)) {}

    // Takes the next bytes of the line and hands on each wanted frame that they complete. Returns why the
    // line makes no sense; empty: it goes on. After a complaint it takes nothing more.
    std::string take(std::string_view bytes, const std::function<void(const Frame&)>& use);

    // A frame has begun and lacks something.
    bool isWithin() const noexcept { return !header_.empty(); }
    uint64_t skippedFrames() const noexcept { return skipped_frames_; }
    size_t heldBytes() const noexcept { return header_.capacity() + body_.capacity(); }

  private:
    std::string begin();
    std::string finish(const std::function<void(const Frame&)>& use);
    bool unwrap();

    const std::vector<WantedType> wanted_;
    std::string header_;  // as much as has come of this frame's
    std::string body_;
    Frame frame_;
    const WantedType* kind_ = nullptr;  // of this frame; none: it is read past
    uint16_t version_ = 0;
    uint64_t crc_ = 0;
    uint64_t missing_ = 0;  // bytes of the body
    uint64_t skipped_frames_ = 0;
    std::string complaint_;
};

}  // namespace bonemill::igtl
