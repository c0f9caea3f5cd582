#include <algorithm>
#include <array>
#include <cctype>
#include <functional>
#include <string>
#include <vector>

#include "common/base/user_error.h"
#include "common/process/work_ahead.h"
#include "haptic_server/scans/confined/import_limits.h"
#include "haptic_server/scans/formats/slice_names.h"
#include "haptic_server/scans/formats/volume_file.h"
#include "haptic_server/scans/frame/physical_frame.h"
#include "haptic_server/scans/pixels/itk_image_file.h"
#include "haptic_server/scans/pixels/png_picture.h"
#include "haptic_server/scans/pixels/tiff_picture.h"

namespace bonemill {
namespace {

namespace fs = std::filesystem;

constexpr uint64_t kMaxPictureEdge = 32768;  // the largest of micro-CT have 16384

std::string extensionOf(const fs::path& path) {
    std::string extension = path.extension().string();
    std::ranges::transform(extension, extension.begin(),
                           [](unsigned char c) { return char(std::tolower(c)); });
    return extension == ".tiff" ? ".tif" : extension;
}

bool isPicture(const fs::path& path) {
    return extensionOf(path) == ".png" || extensionOf(path) == ".tif";
}

// Not those of folders within, and no hidden ones, such as macOS leaves everywhere.
std::vector<fs::path> filesIn(const fs::path& folder) {
    std::vector<fs::path> files;
    std::error_code error, unreadable;
    for (fs::directory_iterator entry(folder, error), end; !error && entry != end; entry.increment(error))
        if (entry->is_regular_file(unreadable) && entry->path().filename().string().front() != '.')
            files.push_back(entry->path());
    if (error) throw UserError("cannot list the folder " + folder.string() + ": " + error.message());
    return files;
}

struct Stack {
    fs::path folder;
    std::vector<fs::path> slices;
    size_t others = 0;  // files that are left out
    std::string remark = {};

    bool isPng() const { return extensionOf(slices.front()) == ".png"; }
};

Stack stackOf(const fs::path& folder) {
    Stack stack{folder, {}};
    for (const fs::path& file : filesIn(folder))
        if (isPicture(file))
            stack.slices.push_back(file);
        else
            ++stack.others;
    std::ranges::sort(stack.slices, [](const fs::path& a, const fs::path& b) {
        return isBeforeNaturally(a.filename().string(), b.filename().string());
    });
    for (const fs::path& slice : stack.slices)
        if (extensionOf(slice) != extensionOf(stack.slices.front()))
            throw UserError(slice.string() + ": is of another type than " +
                            stack.slices.front().filename().string() +
                            "; a folder of slices needs PNG files or TIFF files alone");
    std::vector<std::string> names;
    for (const fs::path& slice : stack.slices) names.push_back(slice.stem().string());
    const SliceNumbers numbers = sliceNumbersOf(names);
    if (!numbers.problem.empty()) throw UserError(folder.string() + ": " + numbers.problem);
    stack.remark = numbers.remark;
    return stack;
}

// One grey value per pixel.
struct Picture {
    uint64_t width = 0, height = 0;
    unsigned bits = 0;
    bool is_white_zero = false;
    bool operator==(const Picture&) const = default;
    uint64_t bytes() const { return width * height * bits / 8; }
};

std::string pictureText(const Picture& picture) {
    return std::to_string(picture.width) + " x " + std::to_string(picture.height) + " pixels of " +
           std::to_string(picture.bits) + " bit" + (picture.is_white_zero ? ", 0 shown white" : "");
}

// Says where the values of this picture are to go; null: nowhere, they are not read.
using Place = std::function<RawValues*(const Picture&)>;

template <class File>
Picture readAs(const fs::path& path, const Place& place) {
    File file(path);
    const Picture picture{file.width(), file.height(), file.bits(), file.isWhiteZero()};
    if (picture.width < 1 || picture.height < 1 || std::max(picture.width, picture.height) > kMaxPictureEdge)
        throw UserError(path.string() + ": claims an image of absurd size; the file is damaged");
    if (RawValues* const values = place(picture)) file.appendValues(*values);
    return picture;
}

Picture readPicture(const fs::path& path, const Place& place) {
    return extensionOf(path) == ".png" ? readAs<PngPicture>(path, place) : readAs<TiffPicture>(path, place);
}

RawValues pixelsOf(const fs::path& slice, const Stack& stack, const Picture& first) {
    RawValues pixels;
    readPicture(slice, [&](const Picture& picture) {
        if (picture != first)
            throw UserError(slice.string() + ": has " + pictureText(picture) + ", but " +
                            stack.slices.front().filename().string() + " has " + pictureText(first) +
                            "; all slices must be alike");
        return &pixels;
    });
    if (pixels.size() != size_t(first.width * first.height))
        throw UserError(slice.string() + ": holds fewer pixels than its header says; the file is damaged");
    return pixels;
}

RawValues readPictures(const Stack& stack, const Picture& first) {
    const uint64_t picture = first.bytes();
    uint64_t bytes = 0;
    for (const fs::path& slice : stack.slices) bytes = std::max(bytes, mostMemoryToRead(slice, picture));
    RawValues values;
    values.reserve(size_t(first.width * first.height) * stack.slices.size());
    const MemoryCap cap(memoryForAll(bytes, picture * stack.slices.size()));
    workAhead(
        stack.slices, [&](const fs::path& slice) { return pixelsOf(slice, stack, first); },
        [&](const fs::path&, const RawValues& pixels) {
            pixels.visit([&](auto samples) { values.append(samples); });
        });
    return values;
}

}  // namespace

bool isImageStack(const std::filesystem::path& folder) {
    const std::vector<fs::path> files = filesIn(folder);
    return 2 * std::ranges::count_if(files, isPicture) > std::ssize(files);
}

void refuseOtherPictures(const std::filesystem::path& folder) {
    const std::vector<fs::path> files = filesIn(folder);
    const auto isOther = [](const fs::path& path) {
        constexpr std::array kEndings = {".jpg", ".jpeg", ".jp2", ".bmp", ".gif", ".webp"};
        return std::ranges::find(kEndings, extensionOf(path)) != kEndings.end();
    };
    if (2 * std::ranges::count_if(files, isOther) > std::ssize(files))
        throw UserError(
            folder.string() + ": its pictures (" + std::ranges::find_if(files, isOther)->filename().string() +
            ", ...) are of a kind that is not read; save each slice as PNG or TIFF, grey, with 8 or "
            "16 bit, from the scanner's own data");
}

void checkSpacing(const Eigen::Vector3d& spacing_mm, const std::string& file) {
    constexpr double kMinMm = 1e-6, kMaxMm = 1e4;
    if (!(spacing_mm.minCoeff() >= kMinMm && spacing_mm.maxCoeff() <= kMaxMm))
        throw UserError(file + ": volume.spacing_mm needs the voxels' edges, each above 0: x, y and z in mm");
}

RawVolume importImageStack(const std::filesystem::path& folder,
                           const std::optional<Eigen::Vector3d>& spacing_mm) {
    const std::string name = folder.string();
    if (!spacing_mm)
        throw UserError(name + ": its images do not say how large a voxel is; write volume.spacing_mm");
    checkSpacing(*spacing_mm, name);
    const Stack stack = stackOf(folder);
    const Picture first = readPicture(stack.slices.front(), [](const Picture&) { return nullptr; });
    checkVolumeSize({first.width, first.height, stack.slices.size()}, first.bits / 8, name);
    RawVolume raw;
    raw.values = readPictures(stack, first);
    FileFrame frame;
    frame.dims = {int(first.width), int(first.height), int(stack.slices.size())};
    frame.spacing_mm = *spacing_mm;
    frame.directions.setIdentity();
    frame.origin_mm.setZero();
    makeRightHanded(frame, name, raw.geometry, raw.values);
    raw.lacks_patient_axes = true;
    raw.description = std::to_string(stack.slices.size()) + (stack.isPng() ? " PNG" : " TIFF") + " images, " +
                      stack.slices.front().filename().string() + " to " +
                      stack.slices.back().filename().string();
    if (!stack.remark.empty()) raw.description += ", " + stack.remark;
    if (first.is_white_zero)
        raw.description += "; values as they are stored: 0, which these files show as white, is the lowest";
    if (stack.others > 0) raw.description += "; " + std::to_string(stack.others) + " other files left out";
    return raw;
}

}  // namespace bonemill
