#include "haptic_server/scans/dicom/dicom_scan.h"

#include <algorithm>
#include <array>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <fstream>

#include "common/base/user_error.h"
#include "common/text/printed_text.h"

namespace bonemill {
namespace {

constexpr uint32_t kUndefinedLength = 0xffffffff;
constexpr uint32_t kPixelData = 0x7fe00010;
constexpr uint32_t kFloatPixelData = 0x7fe00008;
constexpr uint32_t kDoublePixelData = 0x7fe00009;
constexpr uint32_t kMediaClassUid = 0x00020002;
constexpr uint32_t kTransferSyntaxUid = 0x00020010;
constexpr uint32_t kSopClassUid = 0x00080016;
constexpr uint32_t kSeriesUid = 0x0020000e;
constexpr uint32_t kItem = 0xfffee000;
constexpr uint32_t kItemEnd = 0xfffee00d;
constexpr uint32_t kSequenceEnd = 0xfffee0dd;
constexpr int kMaxDepth = 32;
constexpr std::streamoff kPreambleBytes = 128;

// PS3.4 B.5: segmentation, surface segmentation, label map; RT structure set.
DicomDrawing drawingOf(const std::string& sop_class) {
    const std::string kStorage = "1.2.840.10008.5.1.4.1.1.";
    if (sop_class == kStorage + "66.4") return DicomDrawing::kSegmentation;
    for (const char* const kind : {"66.5", "66.7", "481.3"})
        if (sop_class == kStorage + kind) return DicomDrawing::kOther;
    return DicomDrawing::kNone;
}

struct CutShort {
    std::string problem;
};
struct Unclear {};  // GDCM may still know what to do

struct Element {
    uint32_t tag = 0;
    uint32_t length = 0;
    bool holds_items = false;
};

class Scanner {
  public:
    explicit Scanner(const std::filesystem::path& path) : file_(path, std::ios::binary) {
        std::error_code error;
        size_ = std::streamoff(std::filesystem::file_size(path, error));
        if (!file_ || error) throw UserError("cannot open " + path.string() + "; check its permissions");
    }

    DicomScan scan() {
        if (!startsLikeDicom()) return {};
        try {
            if (has_meta_ && !readMeta())  // deflated: opaque
                return {DicomKind::kImage, {}, media_class_, drawingOf(media_class_), {}};
            while (position_ < size_) skipElement(0);
        } catch (const CutShort& cut) {
            return {DicomKind::kCutShort, cut.problem, media_class_, drawing_, series_uid_};
        } catch (const Unclear&) {
            return {DicomKind::kImage, {}, media_class_, drawing_, series_uid_};
        }
        const DicomKind kind = has_pixels_ ? DicomKind::kImage : DicomKind::kNoImage;
        return {kind, {}, media_class_, drawing_, series_uid_, pixel_bytes_};
    }

  private:
    bool startsLikeDicom() {
        std::array<char, kPreambleBytes + 8> head{};
        file_.read(head.data(), head.size());
        const auto got = file_.gcount();
        file_.clear();
        has_meta_ = got >= kPreambleBytes + 4 && std::memcmp(head.data() + kPreambleBytes, "DICM", 4) == 0;
        if (has_meta_) {
            position_ = kPreambleBytes + 4;
            return true;
        }
        // Old exports have no preamble: they are a data set that starts with group 0002 or
        // 0008, little endian.
        const bool low_group = got >= 8 && (head[0] == 2 || head[0] == 8) && head[1] == 0 && head[3] == 0;
        explicit_vr_ = low_group && std::isupper(static_cast<unsigned char>(head[4])) &&
                       std::isupper(static_cast<unsigned char>(head[5]));
        has_meta_ = low_group && head[0] == 2;
        return low_group && (explicit_vr_ || head[0] == 8);
    }

    // Reads group 0002, which is always explicit little endian. Returns false for a deflated data set.
    bool readMeta() {
        explicit_vr_ = true;
        std::string transfer_syntax;
        while (position_ < size_ && peekGroup() == 0x0002) {
            const Element element = readElementHead();
            checkFits(element);
            if (element.tag == kMediaClassUid) media_class_ = text(element.length);
            if (element.tag == kTransferSyntaxUid) transfer_syntax = text(element.length);
            position_ += element.length;
        }
        if (transfer_syntax == "1.2.840.10008.1.2.1.99") return false;
        if (transfer_syntax.empty() && position_ >= size_) throw CutShort{"it ends after its first lines"};
        if (transfer_syntax.empty()) throw Unclear{};
        explicit_vr_ = transfer_syntax != "1.2.840.10008.1.2";
        big_endian_ = transfer_syntax == "1.2.840.10008.1.2.2";
        return true;
    }

    std::string text(uint32_t length) {
        constexpr uint32_t kLongest = 256;  // UIDs have 64
        std::string value(std::min<uint32_t>(length, kLongest), '\0');
        file_.seekg(position_);
        file_.read(value.data(), std::streamsize(value.size()));
        while (!value.empty() && (value.back() == '\0' || value.back() == ' ')) value.pop_back();
        return value;
    }

    uint32_t number(const unsigned char* bytes, int count) const {
        uint32_t value = 0;
        for (int b = 0; b < count; ++b) value |= uint32_t(bytes[big_endian_ ? count - 1 - b : b]) << (8 * b);
        return value;
    }

    void read(unsigned char* bytes, std::streamoff count) {
        if (position_ + count > size_) throw CutShort{"it ends within the head of an element"};
        file_.seekg(position_);
        file_.read(reinterpret_cast<char*>(bytes), count);
        if (!file_) throw CutShort{"it cannot be read to its end"};
        position_ += count;
    }

    uint32_t peekGroup() {
        std::array<unsigned char, 2> group{};
        read(group.data(), 2);
        position_ -= 2;
        return number(group.data(), 2);
    }

    Element readElementHead() {
        std::array<unsigned char, 8> head{};
        read(head.data(), 8);
        Element element;
        element.tag = number(&head[0], 2) << 16 | number(&head[2], 2);
        if (element.tag >> 16 == 0xfffe || !explicit_vr_) {
            element.length = number(&head[4], 4);
            element.holds_items = element.length == kUndefinedLength;
            return element;
        }
        const std::string vr(reinterpret_cast<const char*>(&head[4]), 2);
        if (!std::isupper(head[4]) || !std::isupper(head[5])) throw Unclear{};
        static constexpr const char* kLongForms[] = {"OB", "OD", "OF", "OL", "OV", "OW", "SQ",
                                                     "SV", "UC", "UN", "UR", "UT", "UV"};
        if (std::find(std::begin(kLongForms), std::end(kLongForms), vr) == std::end(kLongForms)) {
            element.length = number(&head[6], 2);
            return element;
        }
        std::array<unsigned char, 4> length{};
        read(length.data(), 4);
        element.length = number(length.data(), 4);
        element.holds_items = vr == "SQ" || element.length == kUndefinedLength;
        return element;
    }

    void checkFits(const Element& element) const {
        if (element.length == kUndefinedLength || std::streamoff(element.length) <= size_ - position_) return;
        throw CutShort{printed("element (%04x,%04x) claims %u bytes, %lld are left", element.tag >> 16,
                               element.tag & 0xffff, element.length,
                               static_cast<long long>(size_ - position_))};
    }

    // Of an element that stands in the file as a whole.
    void takeFact(const Element& element) {
        if (element.tag == kSeriesUid) series_uid_ = text(element.length);
        if (element.tag == kPixelData && element.length != kUndefinedLength) pixel_bytes_ = element.length;
    }

    void skipElement(int depth) {
        const Element element = readElementHead();
        if (depth == 0 &&
            (element.tag == kPixelData || element.tag == kFloatPixelData || element.tag == kDoublePixelData))
            has_pixels_ = true;
        if (depth == 0 && element.tag == kSopClassUid) drawing_ = drawingOf(text(element.length));
        if (element.tag == kItemEnd || element.tag == kSequenceEnd) throw Unclear{};
        checkFits(element);
        if (depth == 0) takeFact(element);
        if (element.length != kUndefinedLength)
            position_ += element.length;  // items of a sequence of known length lie inside it
        else if (element.holds_items)
            skipItems(depth + 1);
        else
            throw Unclear{};
    }

    void skipItems(int depth) {
        if (depth > kMaxDepth) throw Unclear{};
        while (true) {
            const Element item = readElementHead();
            if (item.tag == kSequenceEnd) return;
            if (item.tag != kItem) throw Unclear{};
            checkFits(item);
            if (item.length != kUndefinedLength)
                position_ += item.length;
            else
                skipToItemEnd(depth);
        }
    }

    void skipToItemEnd(int depth) {
        while (true) {
            std::array<unsigned char, 4> tag{};
            read(tag.data(), 4);
            position_ -= 4;
            if ((number(&tag[0], 2) << 16 | number(&tag[2], 2)) == kItemEnd) {
                readElementHead();
                return;
            }
            skipElement(depth);
        }
    }

    std::ifstream file_;
    std::streamoff size_ = 0;
    std::streamoff position_ = 0;
    bool has_meta_ = false;
    bool explicit_vr_ = false;
    bool big_endian_ = false;
    bool has_pixels_ = false;
    std::string media_class_, series_uid_;
    DicomDrawing drawing_ = DicomDrawing::kNone;
    std::optional<uint64_t> pixel_bytes_;
};

}  // namespace

DicomScan scanDicomFile(const std::filesystem::path& path) {
    return Scanner(path).scan();
}

}  // namespace bonemill
