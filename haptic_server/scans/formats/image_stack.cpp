#include <algorithm>
#include <cctype>
#include <string>
#include <string_view>
#include <vector>

#include "common/base/user_error.h"
#include "common/process/work_ahead.h"
#include "haptic_server/scans/confined/import_limits.h"
#include "haptic_server/scans/formats/volume_file.h"
#include "haptic_server/scans/frame/physical_frame.h"
#include "haptic_server/scans/pixels/itk_image_file.h"

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

size_t endOfDigits(const std::string& text, size_t from) {
    while (from < text.size() && std::isdigit(static_cast<unsigned char>(text[from]))) ++from;
    return from;
}

// The digits of the number that begins there, without leading zeros.
std::string_view numberAt(const std::string& text, size_t begin, size_t end) {
    while (begin + 1 < end && text[begin] == '0') ++begin;
    return std::string_view(text).substr(begin, end - begin);
}

struct Stack {
    fs::path folder;
    std::vector<fs::path> slices;
    size_t others = 0;  // files that are left out

    ItkFormat format() const {
        return extensionOf(slices.front()) == ".png" ? ItkFormat::kPng : ItkFormat::kTiff;
    }
};

Stack stackOf(const fs::path& folder) {
    Stack stack{folder, {}, 0};
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
    return stack;
}

std::string pictureText(const ItkImageHeader& header) {
    return std::to_string(header.dims[0]) + " x " + std::to_string(header.dims[1]) + " pixels of " +
           std::to_string(8 * header.bytes_per_voxel) + " bit";
}

// A picture of one grey value per pixel. One page of a file of several has a third axis of its own.
void checkPicture(const ItkImageHeader& header, const std::string& file) {
    if (header.components != 1)
        throw UserError(file + ": is in colour or has transparent places; save the slices as grey images");
    if (header.dims.size() < 2 ||
        std::any_of(header.dims.begin() + 2, header.dims.end(), [](uint64_t n) { return n > 1; }))
        throw UserError(file + ": holds several images; save each slice as a file of its own");
    if (header.bytes_per_voxel > 2)
        throw UserError(file + ": has " + std::to_string(8 * header.bytes_per_voxel) +
                        " bit per pixel; save the slices with 8 or 16 bit");
    if (std::max(header.dims[0], header.dims[1]) > kMaxPictureEdge)
        throw UserError(file + ": claims an image of absurd size; the file is damaged");
}

RawValues pixelsOf(const fs::path& slice, const Stack& stack, const ItkImageHeader& first) {
    ItkImageFile image(stack.format(), slice);
    const ItkImageHeader& header = image.header();
    checkPicture(header, slice.string());
    if (pictureText(header) != pictureText(first))
        throw UserError(slice.string() + ": has " + pictureText(header) + ", but " +
                        stack.slices.front().filename().string() + " has " + pictureText(first) +
                        "; all slices must be alike");
    RawValues pixels;
    image.appendValues(pixels);
    if (pixels.size() != size_t(first.dims[0] * first.dims[1]))
        throw UserError(slice.string() + ": holds fewer pixels than its header says; the file is damaged");
    return pixels;
}

RawValues readPictures(const Stack& stack, const ItkImageHeader& first) {
    const uint64_t picture = first.dims[0] * first.dims[1] * first.bytes_per_voxel;
    uint64_t bytes = 0;
    for (const fs::path& slice : stack.slices) bytes = std::max(bytes, mostMemoryToRead(slice, picture));
    RawValues values;
    values.reserve(size_t(first.dims[0] * first.dims[1]) * stack.slices.size());
    const MemoryCap cap(memoryForAll(bytes, picture * stack.slices.size()));
    workAhead(
        stack.slices, [&](const fs::path& slice) { return pixelsOf(slice, stack, first); },
        [&](const fs::path&, const RawValues& pixels) {
            pixels.visit([&](auto samples) { values.append(samples); });
        });
    return values;
}

}  // namespace

bool isBeforeNaturally(const std::string& a, const std::string& b) {
    size_t i = 0, j = 0;
    while (i < a.size() && j < b.size()) {
        const size_t i_end = endOfDigits(a, i), j_end = endOfDigits(b, j);
        if (i_end > i && j_end > j) {
            const std::string_view m = numberAt(a, i, i_end), n = numberAt(b, j, j_end);
            if (m != n) return m.size() != n.size() ? m.size() < n.size() : m < n;
            i = i_end;
            j = j_end;
        } else {
            if (a[i] != b[j]) return a[i] < b[j];
            ++i;
            ++j;
        }
    }
    if (i < a.size() || j < b.size()) return i == a.size();
    return a < b;  // "a01" and "a1"
}

bool isImageStack(const std::filesystem::path& folder) {
    const std::vector<fs::path> files = filesIn(folder);
    return 2 * std::ranges::count_if(files, isPicture) > std::ssize(files);
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
    const ItkImageHeader first = ItkImageFile(stack.format(), stack.slices.front()).header();
    checkPicture(first, stack.slices.front().string());
    checkVolumeSize({first.dims[0], first.dims[1], stack.slices.size()}, first.bytes_per_voxel, name);
    RawVolume raw;
    raw.values = readPictures(stack, first);
    FileFrame frame;
    frame.dims = {int(first.dims[0]), int(first.dims[1]), int(stack.slices.size())};
    frame.spacing_mm = *spacing_mm;
    frame.directions.setIdentity();
    frame.origin_mm.setZero();
    makeRightHanded(frame, name, raw.geometry, raw.values);
    raw.lacks_patient_axes = true;
    raw.description = std::to_string(stack.slices.size()) +
                      (stack.format() == ItkFormat::kPng ? " PNG" : " TIFF") + " images, " +
                      stack.slices.front().filename().string() + " to " +
                      stack.slices.back().filename().string();
    if (stack.others > 0) raw.description += "; " + std::to_string(stack.others) + " other files left out";
    return raw;
}

}  // namespace bonemill
