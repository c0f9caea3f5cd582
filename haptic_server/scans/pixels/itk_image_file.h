// This is the only door to ITK's readers: one image file, header first, pixels when its size has
// been found sensible.
//
// There is no Eigen and no ITK type in here: ITK brings an Eigen of its own that cannot share a source
// file with ours.
#pragma once

#include <array>
#include <cstdint>
#include <filesystem>
#include <memory>
#include <string>
#include <vector>

#include "haptic_server/core/volume/raw_values.h"

namespace bonemill {

enum class ItkFormat { kNrrd, kMetaImage };

struct ItkImageHeader {
    std::vector<uint64_t> dims;  // all axes of the file
    unsigned components = 1;     // values per voxel
    uint64_t bytes_per_voxel = 0;
    // These are the first three axes in LPS and the file's unit of length (mm unless it says otherwise); axes
    // are unit axes where it has fewer.
    std::array<double, 3> spacing{1, 1, 1};
    std::array<double, 3> origin{};
    std::array<std::array<double, 3>, 3> axis{};  // where each index axis points
};

// What reading a file of N bytes of voxels may take: the file, what it unpacks to and some tables.
// Lengths that ask for more are damaged.
uint64_t mostMemoryToRead(const std::filesystem::path& file, uint64_t voxel_bytes);

// It is for start-up only; each object is for one thread, several may read beside each other. Throws
// UserError with one message naming the file.
class ItkImageFile {
  public:
    // Reads the header.
    ItkImageFile(ItkFormat format, const std::filesystem::path& path);
    ~ItkImageFile();
    ItkImageFile(const ItkImageFile&) = delete;
    ItkImageFile& operator=(const ItkImageFile&) = delete;

    const ItkImageHeader& header() const { return header_; }

    // Appends all samples, rescaled as the file says, first axis fastest.
    void appendValues(RawValues& values);

  private:
    struct Reader;
    std::string file_;
    std::unique_ptr<Reader> reader_;
    ItkImageHeader header_;
};

}  // namespace bonemill
