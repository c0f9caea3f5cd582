#include "haptic_server/volume/import/nifti_header.h"

#include <zlib.h>

#include <algorithm>
#include <array>
#include <bit>
#include <cmath>
#include <cstdint>
#include <cstring>
#include <memory>

#include "common/user_error.h"

namespace bonemill {
namespace {

// These are the offsets of the fields in nifti1.h.
constexpr size_t kHeaderBytes = 348;
constexpr size_t kDimOffset = 40;
constexpr size_t kPixdimOffset = 76;
constexpr size_t kVoxOffsetOffset = 108;
constexpr size_t kQformCodeOffset = 252;
constexpr size_t kSformCodeOffset = 254;
constexpr size_t kQuaternOffset = 256;
constexpr size_t kSformEnd = 328;
constexpr size_t kMagicOffset = 344;
constexpr int kNifti2HeaderBytes = 540;
constexpr double kMaxExtensionBytes = 64 << 20;

class Header {
  public:
    explicit Header(const std::filesystem::path& path) {
        const std::unique_ptr<gzFile_s, int (*)(gzFile)> file(gzopen(path.c_str(), "rb"), gzclose);
        if (file) is_complete_ = gzread(file.get(), bytes_.data(), kHeaderBytes) == int(kHeaderBytes);
        swapped_ = at<int32_t>(0) != int32_t(kHeaderBytes);
    }
    bool isComplete() const { return is_complete_; }

    template <class T>
    T at(size_t offset) const {
        std::array<char, sizeof(T)> raw;
        std::memcpy(raw.data(), bytes_.data() + offset, sizeof(T));
        if (swapped_) std::reverse(raw.begin(), raw.end());
        return std::bit_cast<T>(raw);
    }
    std::string magic() const { return {bytes_.data() + kMagicOffset, 3}; }

  private:
    std::array<char, kHeaderBytes> bytes_{};
    bool is_complete_ = false;
    bool swapped_ = false;
};

// ITK takes the singular values of these numbers and aborts the process when one is not finite.
bool isGeometryFinite(const Header& header) {
    constexpr float kFarthest = 1e9f;
    const auto isFine = [&](size_t offset) { return std::abs(header.at<float>(offset)) < kFarthest; };
    for (size_t offset = kPixdimOffset; offset < kPixdimOffset + 16; offset += 4)
        if (!isFine(offset)) return false;
    for (size_t offset = kQuaternOffset; offset < kSformEnd; offset += 4)
        if (!isFine(offset)) return false;
    return true;
}

}  // namespace

NiftiHeader readNiftiHeader(const std::filesystem::path& path) {
    const Header header(path);
    const std::string file = path.string();
    if (!header.isComplete())
        throw UserError(file + ": is too short (or its gzip is too damaged) for a NIfTI file");
    if (header.at<int32_t>(0) == kNifti2HeaderBytes)
        throw UserError(file + ": is NIfTI-2; convert it to NIfTI-1");
    if (header.at<int32_t>(0) != int32_t(kHeaderBytes) || header.magic() != "n+1")
        throw UserError(file + ": is not a single-file NIfTI-1 volume");
    const int axes = header.at<int16_t>(kDimOffset);
    bool dims_ok = axes >= 1 && axes <= 7;
    for (int a = 1; dims_ok && a <= axes; ++a) dims_ok = header.at<int16_t>(kDimOffset + 2 * size_t(a)) > 0;
    if (!dims_ok)
        throw UserError(file + ": its NIfTI header states impossible dimensions; the file is damaged");
    if (!isGeometryFinite(header))
        throw UserError(file + ": its NIfTI header holds positions that are no numbers; the file is damaged");
    const float data_offset = header.at<float>(kVoxOffsetOffset);
    if (!(data_offset >= float(kHeaderBytes) && double(data_offset) < kMaxExtensionBytes))
        throw UserError(file +
                        ": its NIfTI header puts the voxels at an impossible place; the file is damaged");
    const bool has_patient_space =
        header.at<int16_t>(kQformCodeOffset) > 0 || header.at<int16_t>(kSformCodeOffset) > 0;
    return {uint64_t(data_offset), has_patient_space};
}

}  // namespace bonemill
