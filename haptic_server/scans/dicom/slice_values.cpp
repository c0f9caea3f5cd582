#include "haptic_server/scans/dicom/slice_values.h"

#include <algorithm>
#include <span>
#include <utility>

#include "common/base/user_error.h"
#include "common/process/work_ahead.h"
#include "haptic_server/scans/confined/import_limits.h"
#include "haptic_server/scans/dicom/dicom_headers.h"
#include "haptic_server/scans/dicom/dicom_pixels.h"
#include "haptic_server/scans/pixels/itk_image_file.h"

namespace bonemill {
namespace {

using Slices = std::span<const DicomSlice>;

// Slices that follow each other in one file.
std::vector<Slices> filesOf(Slices slices) {
    std::vector<Slices> files;
    while (!slices.empty()) {
        const auto other = std::ranges::find_if(
            slices, [&](const DicomSlice& slice) { return slice.path != slices.front().path; });
        const auto count = size_t(other - slices.begin());
        files.push_back(slices.first(count));
        slices = slices.subspan(count);
    }
    return files;
}

struct OfFile {
    std::vector<FrameValues> frames;
    uint64_t surplus = 0;
};

OfFile framesOf(const Slices& slices) {
    DicomPixels pixels(slices.front().path);
    OfFile file{{}, pixels.surplus()};
    for (const DicomSlice& slice : slices) {
        if (size_t(slice.frame) >= pixels.frameCount() ||
            pixels.frameSize() != size_t(slice.columns) * size_t(slice.rows))
            throw UserError(slice.path.string() + ": has changed while it was read; try again");
        file.frames.push_back(pixels.takeFrame(size_t(slice.frame), slice.rescale.value_or(DicomRescale())));
    }
    return file;
}

}  // namespace

std::string readSlices(const std::vector<DicomSlice>& slices, RawValues& values) {
    // While a frame is decoded, and as it is held while it becomes wider.
    constexpr uint64_t kDecodedBytes = 8, kHeldBytes = 2 + 4;
    const std::vector<Slices> files = filesOf(slices);
    const uint64_t pixels = uint64_t(slices.front().columns) * uint64_t(slices.front().rows);
    uint64_t bytes = 0;
    for (const Slices& file : files)
        bytes = std::max(bytes, mostMemoryToRead(file.front().path, kDecodedBytes * pixels * file.size()));
    const MemoryCap cap(memoryForAll(bytes, kHeldBytes * pixels * slices.size()));
    JoinedFrames joined(values);
    LeftOut surplus;
    workAhead(files, framesOf, [&](const Slices& of_file, OfFile file) {
        for (FrameValues& frame : file.frames) joined.append(std::exchange(frame, {}));
        if (file.surplus > 0)
            surplus.add("files with more Pixel Data than Rows x Columns x frames need, the rest not read",
                        of_file.front().path);
    });
    joined.finish();
    const size_t padded = joined.paddingCount();
    if (slices.size() > 1 && padded == values.size())
        throw UserError(slices.front().path.string() +
                        ": the series has no value but its Pixel Padding Value, which means no data; export "
                        "it anew");
    std::string said;
    if (padded > 0)
        said =
            std::to_string(padded) + " voxels are padding, no data (Pixel Padding Value), and count as air";
    if (!surplus.text().empty()) said += (said.empty() ? "" : "; ") + surplus.text();
    return said;
}

}  // namespace bonemill
