#include "haptic_server/scans/dicom/dicom_segments.h"

#include <gdcmReader.h>
#include <gdcmTransferSyntax.h>

#include <map>
#include <set>
#include <span>
#include <utility>
#include <vector>

#include "common/base/user_error.h"
#include "common/math/pinned_math.h"
#include "haptic_server/scans/confined/import_limits.h"
#include "haptic_server/scans/confined/shared_name.h"
#include "haptic_server/scans/dicom/dicom_groups.h"
#include "haptic_server/scans/dicom/segment_grid.h"
#include "haptic_server/scans/labels/labels.h"
#include "haptic_server/scans/pixels/dicom_rescale.h"

namespace bonemill {

Eigen::Vector3d colorOfLab(const std::array<uint16_t, 3>& stored) {
    constexpr double kMax = 65535;
    const double lightness = stored[0] / kMax * 100;
    const double a = stored[1] / kMax * 255 - 128, b = stored[2] / kMax * 255 - 128;
    const auto unfold = [](double f) {
        constexpr double kBend = 6.0 / 29;
        return f > kBend ? f * f * f : 3 * kBend * kBend * (f - 4.0 / 29);
    };
    const double fy = (lightness + 16) / 116;
    const Eigen::Vector3d white(0.96422, 1, 0.82521);
    const Eigen::Vector3d xyz =
        white.cwiseProduct(Eigen::Vector3d(unfold(fy + a / 500), unfold(fy), unfold(fy - b / 200)));
    // From D50 to the sRGB of IEC 61966-2-1, whose white is D65, by Bradford's adaptation.
    Eigen::Matrix3d to_linear;
    to_linear << 3.1338561, -1.6168667, -0.4906146, -0.9787684, 1.9161415, 0.0334540, 0.0719453, -0.2289914,
        1.4052427;
    return (to_linear * xyz).unaryExpr([](double linear) {
        if (!(linear > 0)) return 0.0;
        const double shown =
            linear <= 0.0031308 ? 12.92 * linear : 1.055 * pinned::pow(linear, 1 / 2.4) - 0.055;
        return std::min(shown, 1.0);
    });
}

namespace {

const gdcm::Tag kCharacterSet(0x0008, 0x0005);
const gdcm::Tag kRows(0x0028, 0x0010), kColumns(0x0028, 0x0011), kBitsAllocated(0x0028, 0x0100);
const gdcm::Tag kNumberOfFrames(0x0028, 0x0008);
const gdcm::Tag kSegmentationType(0x0062, 0x0001), kMaxFraction(0x0062, 0x000e);
const gdcm::Tag kSegmentSequence(0x0062, 0x0002), kSegmentNumber(0x0062, 0x0004),
    kSegmentLabel(0x0062, 0x0005), kSegmentColor(0x0062, 0x000d);
const gdcm::Tag kSegmentGroup(0x0062, 0x000a), kReferencedSegment(0x0062, 0x000b);
const gdcm::Tag kMeasuresGroup(0x0028, 0x9110), kSpacingBetween(0x0018, 0x0088), kThickness(0x0018, 0x0050);
const gdcm::Tag kSegmentPixels(0x7fe0, 0x0010);

[[noreturn]] void refuseFile(const std::filesystem::path& file, const std::string& why) {
    throw UserError(file.string() + ": " + why + kWayOverSlicer);
}

// The values of all frames, row by row.
struct FramePixels {
    std::span<const uint8_t> bytes;
    size_t rows = 0, columns = 0;
    bool is_binary = true;
    uint8_t least = 1;  // of a fractional segment's voxels

    // see(column) for those of the segment.
    template <class See>
    void forEachIn(size_t frame, size_t row, See&& see) const {
        const size_t begin = (frame * rows + row) * columns;
        for (size_t column = 0; column < columns;) {
            const size_t at = begin + column;
            if (!is_binary) {
                if (bytes[at] >= least) see(column);
                ++column;
                continue;
            }
            const unsigned packed = bytes[at / 8] >> (at % 8);  // the first pixel is the lowest bit
            const size_t count = std::min(8 - at % 8, columns - column);
            for (size_t n = 0; packed >> n != 0 && n < count; ++n)
                if (packed >> n & 1) see(column + n);
            column += count;
        }
    }
};

struct SegmentFrames {
    std::vector<size_t> segments;  // of each frame, number in Segments::list
    std::vector<DicomPlace> places;
};

class SegmentationReader {
  public:
    explicit SegmentationReader(const std::filesystem::path& file) : file_(file) {
        noteFileBeingRead(file);
        reader_.SetFileName(file.c_str());
        if (!reader_.Read()) refuseFile(file_, "the DICOM library cannot read it");
    }

    RawVolume read() {
        checkType();
        readSegments();
        const FunctionalGroups groups(data());
        FramePixels pixels = findPixels(groups.frameCount());
        const SegmentFrames frames = readFrames(groups);
        const SegmentGrid grid = segmentGridOf(frames.places, {int(pixels.columns), int(pixels.rows)},
                                               stepsOf(groups), file_.string());
        constexpr uint64_t kBytesPerVoxel = 2 * sizeof(uint16_t);
        const Eigen::Vector3i& dims = grid.frame.dims;
        checkVolumeSize({uint64_t(dims.x()), uint64_t(dims.y()), uint64_t(dims.z())}, kBytesPerVoxel,
                        file_.string());
        RawVolume raw;
        raw.values.append(joinFrames(pixels, frames, grid));
        raw.segments = std::move(segments_);
        makeRightHanded(grid.frame, file_.string(), raw.geometry, raw.values);
        raw.description = describe(frames.segments.size(), grid, raw.segments.are_layered);
        return raw;
    }

  private:
    const gdcm::DataSet& data() const { return reader_.GetFile().GetDataSet(); }
    std::string text(const gdcm::Tag& tag) const { return withoutPadding(bytesOf(data(), tag)); }
    std::string frameName(size_t frame) const {
        return file_.string() + " frame " + std::to_string(frame + 1);
    }

    void checkType() {
        type_ = text(kSegmentationType);
        if (type_ != "BINARY" && type_ != "FRACTIONAL")
            refuseFile(file_, "is a segmentation of a kind that is not read (" + oneWord(type_) +
                                  "; BINARY and FRACTIONAL are)");
        const gdcm::TransferSyntax& syntax = reader_.GetFile().GetHeader().GetDataSetTransferSyntax();
        if (syntax.IsEncapsulated()) refuseFile(file_, "its pixels are compressed");
        if (syntax.GetSwapCode() != gdcm::SwapCode::LittleEndian)
            refuseFile(file_, "its numbers are big endian");
    }

    static std::string oneWord(const std::string& word) {
        const bool is_plain = word.size() <= 16 && std::ranges::all_of(word, [](unsigned char c) {
                                  return (c >= 'A' && c <= 'Z') || c == '_';
                              });
        return is_plain && !word.empty() ? word : "none that is known";
    }

    // Other codings than UTF-8 and Latin-1 keep what is ASCII.
    std::string nameOf(const std::string& stored) const {
        const std::string coding = text(kCharacterSet);
        if (coding == "ISO_IR 192") return stored;
        std::string name;
        for (const unsigned char c : stored) {
            if (c < 0x80)
                name += char(c);
            else if (coding == "ISO_IR 100")
                name += {char(0xc0 | c >> 6), char(0x80 | (c & 0x3f))};
            else
                name += '?';
        }
        return name;
    }

    void readSegments() {
        const DicomItems items = itemsOf(data(), kSegmentSequence);
        if (!items || items->GetNumberOfItems() == 0) refuseFile(file_, "says nothing of its segments");
        if (items->GetNumberOfItems() > kMaxSegments)
            throw UserError(file_.string() + ": has more than " + std::to_string(kMaxSegments) +
                            " segments; export fewer of them");
        for (size_t n = 1; n <= items->GetNumberOfItems(); ++n)  // GDCM counts items from 1
            readSegment(items->GetItem(n).GetNestedDataSet(), n);
    }
    void readSegment(const gdcm::DataSet& item, size_t place) {
        const auto number = numberOf<uint16_t>(bytesOf(item, kSegmentNumber));
        if (!number || *number == 0 || !by_number_.emplace(*number, segments_.list.size()).second)
            refuseFile(file_, "its segment " + std::to_string(place) + " has no number of its own above 0");
        Segment segment{nameOf(withoutPadding(bytesOf(item, kSegmentLabel))), {}, {}};
        if (!isSegmentName(segment.name))
            throw UserError(file_.string() + ": segment " + std::to_string(*number) +
                            " has no name of 1 to " + std::to_string(kLongestSegmentName) +
                            " bytes without control characters; rename it in 3D Slicer");
        if (const auto lab = numberOf<std::array<uint16_t, 3>>(bytesOf(item, kSegmentColor)))
            segment.color = colorOfLab(*lab);
        segments_.list.push_back(std::move(segment));
        numbers_.push_back(*number);
    }

    FramePixels findPixels(size_t frames) const {
        const auto rows = numberOf<uint16_t>(bytesOf(data(), kRows)),
                   columns = numberOf<uint16_t>(bytesOf(data(), kColumns)),
                   bits = numberOf<uint16_t>(bytesOf(data(), kBitsAllocated));
        FramePixels pixels;
        pixels.is_binary = type_ == "BINARY";
        if (!rows || !columns || *rows == 0 || *columns == 0 || bits != (pixels.is_binary ? 1 : 8))
            refuseFile(file_, "its frames are not of 1 bit (BINARY) or 8 bits (FRACTIONAL), or of no size");
        if (frames == 0 || text(kNumberOfFrames) != std::to_string(frames))
            refuseFile(file_, "does not describe each of its frames");
        pixels.rows = *rows;
        pixels.columns = *columns;
        pixels.least = pixels.is_binary ? 1 : leastFraction();
        if (!data().FindDataElement(kSegmentPixels)) refuseFile(file_, "holds no pixels");
        const gdcm::ByteValue* bytes = data().GetDataElement(kSegmentPixels).GetByteValue();
        if (!bytes) refuseFile(file_, "its pixels are compressed");
        const uint64_t samples = uint64_t(frames) * pixels.rows * pixels.columns;
        checkStoredBytes(pixels.is_binary ? (samples + 7) / 8 : samples, bytes->GetLength(), file_.string());
        pixels.bytes = {reinterpret_cast<const uint8_t*>(bytes->GetPointer()), size_t(bytes->GetLength())};
        return pixels;
    }
    uint8_t leastFraction() const {
        const auto most = numberOf<uint16_t>(bytesOf(data(), kMaxFraction));
        if (!most || *most == 0 || *most > 255)
            refuseFile(file_, "its Maximum Fractional Value is not one of 1 to 255");
        return uint8_t((*most + 1) / 2);
    }

    SegmentFrames readFrames(const FunctionalGroups& groups) const {
        SegmentFrames frames;
        for (size_t f = 0; f < groups.frameCount(); ++f) {
            const auto number = groups.number<uint16_t>(f, kSegmentGroup, kReferencedSegment);
            const auto segment = number ? by_number_.find(*number) : by_number_.end();
            if (segment == by_number_.end())
                refuseFile(frameName(f), "is of no segment that the file describes");
            const DicomPlaceTexts texts = groups.placeTexts(f);
            if (!texts.areComplete()) refuseFile(frameName(f), "does not say where in the patient it lies");
            frames.segments.push_back(segment->second);
            frames.places.push_back(placeFromTexts(texts, kThreeDigits, frameName(f)));
        }
        return frames;
    }

    static SliceSteps stepsOf(const FunctionalGroups& groups) {
        const auto length = [&](const gdcm::Tag& tag) -> std::optional<double> {
            const auto numbers = decimalNumbers(groups.text(0, kMeasuresGroup, tag));
            if (!numbers || numbers->size() != 1) return std::nullopt;
            return numbers->front();
        };
        return {length(kSpacingBetween), length(kThickness)};
    }

    // The frames of each slice of the grid, by segment.
    std::map<int, std::vector<size_t>> framesOfSlices(const SegmentFrames& frames,
                                                      const SegmentGrid& grid) const {
        std::map<int, std::vector<size_t>> of_slice;
        std::set<std::pair<int, size_t>> seen;
        for (size_t f = 0; f < grid.places.size(); ++f) {
            const int slice = grid.places[f].slice;
            if (!seen.emplace(slice, frames.segments[f]).second)
                refuseFile(frameName(f), "is a second one of segment " +
                                             std::to_string(numbers_[frames.segments[f]]) + " at its place");
            of_slice[slice].push_back(f);
        }
        return of_slice;
    }

    // Numbers the segments of each voxel, and lists the numbers with the segments.
    std::vector<uint16_t> joinFrames(const FramePixels& pixels, const SegmentFrames& frames,
                                     const SegmentGrid& grid) {
        const auto columns = size_t(grid.frame.dims.x()), rows = size_t(grid.frame.dims.y());
        std::vector<uint16_t> values(columns * rows * size_t(grid.frame.dims.z()));
        SegmentCodes codes(file_.string());
        std::vector<SegmentMembers> members(columns);
        for (const auto& [slice, of_slice] : framesOfSlices(frames, grid))
            for (size_t row = 0; row < rows; ++row) {
                std::ranges::fill(members, SegmentMembers());
                for (const size_t f : of_slice) {
                    const Eigen::Vector2i& first = grid.places[f].first;
                    const int own_row = int(row) - first.y();
                    if (own_row < 0 || own_row >= int(pixels.rows)) continue;
                    pixels.forEachIn(f, size_t(own_row), [&](size_t column) {
                        members[column + size_t(first.x())].set(frames.segments[f]);
                    });
                }
                number(members, codes, values.data() + columns * (row + rows * size_t(slice)));
            }
        nameNumbers(codes, values);
        return values;
    }
    static void number(const std::vector<SegmentMembers>& members, SegmentCodes& codes, uint16_t* out) {
        uint16_t code = 0;
        for (size_t column = 0; column < members.size(); ++column) {
            if (column == 0 || members[column] != members[column - 1]) code = codes.codeOf(members[column]);
            out[column] = code;
        }
    }
    // Without overlap a voxel has the number that the file gives its segment.
    void nameNumbers(const SegmentCodes& codes, std::vector<uint16_t>& values) {
        codes.listIn(segments_);
        segments_.are_layered = codes.anyOverlap();
        if (segments_.are_layered) return;
        std::vector<uint16_t> number_of_code(kMaxSegments + 1);
        for (size_t n = 0; n < numbers_.size(); ++n) {
            for (const uint32_t code : segments_.list[n].labels) number_of_code[code] = numbers_[n];
            segments_.list[n].labels = {numbers_[n]};
        }
        for (uint16_t& value : values) value = number_of_code[value];
    }

    std::string describe(size_t frames, const SegmentGrid& grid, bool overlap) const {
        std::string text = "DICOM SEG (" + type_ + "), " + std::to_string(numbers_.size()) + " segments" +
                           (overlap ? " that overlap" : "") + " in " + std::to_string(frames) + " frames";
        constexpr double kWorthSaying = 0.01;  // mm
        if (grid.aside_mm > kWorthSaying)
            text +=
                "; its slices are shifted sideways (a tilted gantry?): each voxel lies at the nearest one "
                "of the grid";
        return text;
    }

    std::filesystem::path file_;
    gdcm::Reader reader_;
    std::string type_;
    Segments segments_;
    std::vector<uint16_t> numbers_;         // of the segments, as the file gives them
    std::map<uint16_t, size_t> by_number_;  // in Segments::list
};

}  // namespace

RawVolume importDicomSegments(const std::filesystem::path& file) {
    return SegmentationReader(file).read();
}

}  // namespace bonemill
