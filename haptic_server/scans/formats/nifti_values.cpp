#include "haptic_server/scans/formats/nifti_values.h"

#include <zlib.h>

#include <algorithm>
#include <cstring>
#include <functional>
#include <map>
#include <memory>
#include <numeric>
#include <string>
#include <type_traits>
#include <vector>

#include "common/base/user_error.h"
#include "haptic_server/scans/confined/import_limits.h"

namespace bonemill {
namespace {

constexpr size_t kBlock = size_t(1) << 18;  // voxels

// A file that is packed by gzip, or not: zlib tells by its first bytes.
class PackedFile {
  public:
    explicit PackedFile(const std::filesystem::path& path)
        : name_(path.string()), file_(gzopen(path.c_str(), "rb"), gzclose) {
        if (!file_) throw UserError(name_ + ": cannot be opened; check its permissions");
    }

    bool isPacked() const { return gzdirect(file_.get()) == 0; }
    // Fewer bytes than asked for: the file ends there. Throws UserError when what is packed is damaged.
    size_t read(void* bytes, size_t count) {
        const int got = gzread(file_.get(), bytes, unsigned(count));
        int error = Z_OK;
        gzerror(file_.get(), &error);
        if (got < 0 || (error != Z_OK && error != Z_STREAM_END))
            throw UserError(name_ +
                            ": its compressed voxels are cut short or damaged; copy or export it anew");
        return size_t(got);
    }
    void skip(uint64_t count) {
        std::vector<char> skipped(kBlock);
        while (count > 0) {
            const size_t got = read(skipped.data(), std::min<uint64_t>(count, skipped.size()));
            if (got == 0) return;
            count -= got;
        }
    }
    // Reads on to the end, so that a checksum there counts; of a packed file no further than a block.
    uint64_t countToEnd() {
        std::vector<char> more(kBlock);
        uint64_t count = 0;
        while (const size_t got = read(more.data(), more.size())) {
            count += got;
            if (isPacked()) break;
        }
        return count;
    }

  private:
    std::string name_;
    std::unique_ptr<gzFile_s, int (*)(gzFile)> file_;
};

template <class T>
inline constexpr bool kIsHeldAsItIs =
    std::is_same_v<T, uint8_t> || std::is_same_v<T, int16_t> || std::is_same_v<T, uint16_t>;

template <class T>
void swapBytes(std::vector<T>& samples) {
    for (T& sample : samples) {
        auto* const bytes = reinterpret_cast<unsigned char*>(&sample);
        std::reverse(bytes, bytes + sizeof sample);
    }
}

template <class T>
void append(const std::vector<T>& samples, const NiftiHeader& header, RawValues& values) {
    const bool is_scaled = header.slope != 1 || header.intercept != 0;
    if constexpr (kIsHeldAsItIs<T>)
        if (!is_scaled) return values.append(std::span<const T>(samples));
    std::vector<float> scaled(samples.size());
    std::ranges::transform(samples, scaled.begin(), [&](T sample) {
        return is_scaled ? float(header.slope * double(sample) + header.intercept) : float(sample);
    });
    values.append(std::span<const float>(scaled));
}

// Returns how many there were.
template <class T>
uint64_t appendVoxels(PackedFile& file, const NiftiHeader& header, uint64_t count, RawValues& values) {
    std::vector<T> samples;
    for (uint64_t left = count; left > 0; left -= samples.size()) {
        samples.resize(std::min<uint64_t>(left, kBlock));
        const size_t got = file.read(samples.data(), samples.size() * sizeof(T));
        if (got < samples.size() * sizeof(T)) return (count - left) * sizeof(T) + got;
        if (header.is_swapped) swapBytes(samples);
        append(samples, header, values);
    }
    return count * sizeof(T);
}

struct Type {
    uint64_t bytes;
    uint64_t (*append)(PackedFile&, const NiftiHeader&, uint64_t, RawValues&);
};

template <class T>
Type typeOf() {
    return {sizeof(T), appendVoxels<T>};
}

const Type& typeOf(const NiftiHeader& header, const std::string& file) {
    static const std::map<int, Type> kTypes{// nifti1.h
                                            {2, typeOf<uint8_t>()},    {256, typeOf<int8_t>()},
                                            {4, typeOf<int16_t>()},    {512, typeOf<uint16_t>()},
                                            {8, typeOf<int32_t>()},    {768, typeOf<uint32_t>()},
                                            {1024, typeOf<int64_t>()}, {1280, typeOf<uint64_t>()},
                                            {16, typeOf<float>()},     {64, typeOf<double>()}};
    const auto type = kTypes.find(header.datatype);
    if (type == kTypes.end())
        throw UserError(file + ": its sample type (NIfTI datatype " + std::to_string(header.datatype) +
                        ") is not a plain number; write it with one number of 8 to 64 bit per voxel");
    return type->second;
}

// Before memory is asked for.
void checkFileSize(const std::filesystem::path& path, bool is_packed, uint64_t needed, uint64_t offset) {
    std::error_code error;
    const uint64_t size = std::filesystem::file_size(path, error);
    const uint64_t most = is_packed ? size * kMaxDeflateRatio : size;
    checkStoredBytes(needed, most > offset ? most - offset : 0, path.string());
}

}  // namespace

uint64_t niftiVoxelBytes(const NiftiHeader& header, const std::filesystem::path& path) {
    return typeOf(header, path.string()).bytes;
}

NiftiValues readNiftiValues(const std::filesystem::path& path, const NiftiHeader& header) {
    const Type& type = typeOf(header, path.string());
    const uint64_t count =
        std::accumulate(header.dims.begin(), header.dims.end(), uint64_t(1), std::multiplies<>());
    PackedFile file(path);
    NiftiValues read{.values = {}, .surplus = 0, .is_packed = file.isPacked()};
    checkFileSize(path, read.is_packed, count * type.bytes, header.data_offset);
    file.skip(header.data_offset);
    read.values.reserve(size_t(count));
    checkStoredBytes(count * type.bytes, type.append(file, header, count, read.values), path.string());
    read.surplus = file.countToEnd();
    return read;
}

}  // namespace bonemill
