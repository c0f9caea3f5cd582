#include "common/igtl_wire/igtl_frame.h"

#include <algorithm>
#include <array>

#include "common/igtl_wire/igtl_bytes.h"

namespace bonemill::igtl {
namespace {

constexpr uint64_t kPolynomial = 0x42F0E1EBA9EA3693;
constexpr size_t kTypeAt = 2, kDeviceAt = 14, kBodySizeAt = 42, kCrcAt = 50;
constexpr uint16_t kNewestVersion = 3;
constexpr size_t kExtendedHeaderBytes = 12;  // of version 3: its size, two sizes of metadata, a number

constexpr std::array<uint64_t, 256> crcTable() {
    std::array<uint64_t, 256> table{};
    for (uint64_t byte = 0; byte < table.size(); ++byte) {
        uint64_t crc = byte << 56;
        for (int bit = 0; bit < 8; ++bit) crc = crc << 1 ^ (crc >> 63 ? kPolynomial : 0);
        table[byte] = crc;
    }
    return table;
}

// Without the zeros that fill the field up.
std::string textAt(std::string_view header, size_t at, size_t size) {
    const std::string_view field = header.substr(at, size);
    return std::string(field.substr(0, std::min(field.find('\0'), size)));
}

std::string printable(std::string text) {
    for (char& sign : text)
        if (sign < ' ' || sign > '~') sign = '?';
    return text;
}

void appendField(std::string& bytes, std::string_view text, size_t size) {
    const std::string_view kept = text.substr(0, size);
    bytes += kept;
    bytes.append(size - kept.size(), '\0');
}

}  // namespace

uint64_t crcOf(std::string_view bytes) noexcept {
    static constexpr auto kTable = crcTable();
    uint64_t crc = 0;
    for (const char byte : bytes) crc = kTable[crc >> 56 ^ uint8_t(byte)] ^ crc << 8;
    return crc;
}

uint64_t stampOf(int64_t unix_ns) noexcept {
    constexpr uint64_t kSecond = 1'000'000'000;
    const uint64_t ns = uint64_t(std::max<int64_t>(unix_ns, 0));
    return ns / kSecond << 32 | ((ns % kSecond) << 32) / kSecond;
}

std::string frameOf(std::string_view type, std::string_view device, int64_t unix_ns, std::string_view body) {
    std::string frame;
    frame.reserve(kHeaderBytes + body.size());
    append(frame, uint16_t(1));
    appendField(frame, type, kTypeBytes);
    appendField(frame, device, kDeviceBytes);
    append(frame, stampOf(unix_ns));
    append(frame, uint64_t(body.size()));
    append(frame, crcOf(body));
    frame += body;
    return frame;
}

std::string FrameReader::take(std::string_view bytes, const std::function<void(const Frame&)>& use) {
    while (complaint_.empty() && !bytes.empty()) {
        if (header_.size() < kHeaderBytes) {
            const size_t part = std::min(kHeaderBytes - header_.size(), bytes.size());
            header_ += bytes.substr(0, part);
            bytes.remove_prefix(part);
            if (header_.size() < kHeaderBytes) break;
            complaint_ = begin();
        } else {
            const size_t part = size_t(std::min<uint64_t>(missing_, bytes.size()));
            if (kind_) body_ += bytes.substr(0, part);
            bytes.remove_prefix(part);
            missing_ -= part;
        }
        if (complaint_.empty() && missing_ == 0) complaint_ = finish(use);
    }
    return complaint_;
}

// The header is here: nothing of the body is kept before its size is believed.
std::string FrameReader::begin() {
    version_ = read<uint16_t>(header_, 0);
    if (version_ < 1 || version_ > kNewestVersion)
        return "this is no OpenIGTLink: version " + std::to_string(version_);
    frame_.type = textAt(header_, kTypeAt, kTypeBytes);
    frame_.device = printable(textAt(header_, kDeviceAt, kDeviceBytes));
    crc_ = read<uint64_t>(header_, kCrcAt);
    missing_ = read<uint64_t>(header_, kBodySizeAt);
    const auto kind = std::ranges::find(wanted_, frame_.type, &WantedType::type);
    kind_ = kind == wanted_.end() ? nullptr : &*kind;
    const uint64_t around = version_ < 3 ? 0 : kMostAround;
    const bool fits =
        kind_ ? missing_ >= kind_->least && missing_ <= kind_->most + around : missing_ <= kMostSkipped;
    if (fits) return "";
    return "a body of " + std::to_string(missing_) + " bytes, in a message of type " + printable(frame_.type);
}

std::string FrameReader::finish(const std::function<void(const Frame&)>& use) {
    header_.clear();
    if (!kind_) {
        ++skipped_frames_;
        return "";
    }
    frame_.body = std::move(body_);
    body_.clear();
    if (crcOf(frame_.body) != crc_) return "a wrong checksum, in a message of type " + frame_.type;
    if (version_ >= 3 && !unwrap()) return "a wrong extended header, in a message of type " + frame_.type;
    use(frame_);
    return "";
}

// Takes away what version 3 puts before and behind.
bool FrameReader::unwrap() {
    const std::string_view body = frame_.body;
    if (body.size() < kExtendedHeaderBytes) return false;
    const size_t before = read<uint16_t>(body, 0);
    const size_t behind = read<uint16_t>(body, 2) + size_t(read<uint32_t>(body, 4));
    if (before < kExtendedHeaderBytes || before + behind > body.size()) return false;
    const size_t size = body.size() - before - behind;
    if (size < kind_->least || size > kind_->most) return false;
    frame_.body = frame_.body.substr(before, size);
    return true;
}

}  // namespace bonemill::igtl
