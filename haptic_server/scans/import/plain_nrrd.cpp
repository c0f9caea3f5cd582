#include <fcntl.h>
#include <unistd.h>
#include <zlib.h>

#include <algorithm>
#include <bit>
#include <vector>

#include "common/base/user_error.h"
#include "haptic_server/scans/confined/import_limits.h"
#include "haptic_server/scans/frame/physical_frame.h"
#include "haptic_server/scans/import/import_volume.h"
#include "haptic_server/scans/nrrd/nrrd_header.h"
#include "haptic_server/scans/nrrd/nrrd_place.h"

namespace bonemill {
namespace {

static_assert(std::endian::native == std::endian::little, "bytes are swapped for files that are big endian");

[[noreturn]] void refuse(const std::filesystem::path& path, const std::string& why) {
    throw UserError(path.string() + ": " + why +
                    ", which needs a program with the readers of scans (BONEMILL_WITH_SCANS)");
}

std::vector<uint64_t> dimsOf(const NrrdFields& fields) {
    std::vector<uint64_t> dims;
    for (const double n : numbersIn(fields.sizes)) dims.push_back(n >= 1 ? uint64_t(n) : 0);
    return dims;
}

// The voxels of an open file, unpacked where they are packed.
class VoxelBytes {
  public:
    VoxelBytes(const std::filesystem::path& path, const NrrdHeader& header)
        : path_(path), is_packed_(header.encoding != "raw"), file_(open(path.c_str(), O_RDONLY | O_CLOEXEC)) {
        if (file_ < 0 || lseek(file_, off_t(header.bytes), SEEK_SET) < 0)
            throw UserError(path.string() + ": cannot be read; check the path and who may read it");
        if (is_packed_) packed_ = gzdopen(file_, "rb");
        if (is_packed_ && (!packed_ || gzdirect(packed_)))
            throw UserError(path.string() + ": its voxels are not packed as its header says; it is damaged");
    }
    ~VoxelBytes() {
        if (packed_)
            gzclose(packed_);
        else if (file_ >= 0)
            close(file_);
    }
    VoxelBytes(const VoxelBytes&) = delete;
    VoxelBytes& operator=(const VoxelBytes&) = delete;

    void read(void* bytes, size_t count) {
        char* next = static_cast<char*>(bytes);
        for (const char* const end = next + count; next < end;) {
            const size_t most = std::min(size_t(end - next), size_t(1) << 20);
            const ssize_t done = packed_ ? gzread(packed_, next, unsigned(most)) : ::read(file_, next, most);
            if (done <= 0)
                throw UserError(path_.string() +
                                ": holds fewer voxels than its header promises; it is cut short or damaged");
            next += done;
        }
    }

  private:
    std::filesystem::path path_;
    bool is_packed_;
    int file_;
    gzFile packed_ = nullptr;
};

template <class T>
T swapped(T value) {
    auto* const bytes = reinterpret_cast<unsigned char*>(&value);
    std::reverse(bytes, bytes + sizeof value);
    return value;
}

using AppendVoxels = void (*)(VoxelBytes&, uint64_t, bool, RawValues&);

template <class T>
void appendVoxels(VoxelBytes& bytes, uint64_t count, bool is_swapped, RawValues& values) {
    constexpr bool kIsHeld =
        std::is_same_v<T, uint8_t> || std::is_same_v<T, int16_t> || std::is_same_v<T, uint16_t>;
    constexpr uint64_t kBlock = uint64_t(1) << 20;
    values.reserve(size_t(count));
    std::vector<T> block;
    for (uint64_t left = count; left > 0; left -= block.size()) {
        block.resize(size_t(std::min(left, kBlock)));
        bytes.read(block.data(), block.size() * sizeof(T));
        if (is_swapped) std::ranges::transform(block, block.begin(), swapped<T>);
        if constexpr (kIsHeld)
            values.append(std::span<const T>(block));
        else
            values.append(std::span<const float>(std::vector<float>(block.begin(), block.end())));
    }
}

struct VoxelType {
    std::vector<const char*> names;
    size_t bytes;
    AppendVoxels append;
};

const VoxelType& typeOf(const NrrdHeader& header, const std::filesystem::path& path) {
    static const std::vector<VoxelType> kTypes{
        {{"signed char", "int8", "int8_t"}, 1, appendVoxels<int8_t>},
        {{"uchar", "unsigned char", "uint8", "uint8_t"}, 1, appendVoxels<uint8_t>},
        {{"short", "short int", "signed short", "signed short int", "int16", "int16_t"},
         2,
         appendVoxels<int16_t>},
        {{"ushort", "unsigned short", "unsigned short int", "uint16", "uint16_t"}, 2, appendVoxels<uint16_t>},
        {{"int", "signed int", "int32", "int32_t"}, 4, appendVoxels<int32_t>},
        {{"uint", "unsigned int", "uint32", "uint32_t"}, 4, appendVoxels<uint32_t>},
        {{"float"}, 4, appendVoxels<float>},
        {{"double"}, 8, appendVoxels<double>}};
    for (const VoxelType& type : kTypes)
        for (const char* const name : type.names)
            if (header.fields.type == name) return type;
    refuse(path, "its voxels are of type \"" + header.fields.type + "\"");
}

void requirePlain(const NrrdHeader& header, const std::filesystem::path& path) {
    if (!header.data_file.empty() || header.fields.has_skip)
        refuse(path, "its voxels do not follow its header in the same file");
    if (header.encoding != "raw" && header.encoding != "gzip" && header.encoding != "gz")
        refuse(path, "its encoding is " + header.encoding);
    if (numbersIn(header.fields.sizes).size() != 3) refuse(path, "it has other than three axes");
}

}  // namespace

RawVolume readPlainNrrd(const std::filesystem::path& path, const std::optional<Eigen::Vector3d>& spacing_mm) {
    const NrrdHeader header = readNrrdHeader(path);
    requirePlain(header, path);
    const VoxelType& type = typeOf(header, path);
    const std::vector<uint64_t> dims = dimsOf(header.fields);
    checkVolumeSize(dims, type.bytes + sizeof(float), path.string());
    requireOneSpacing(header.has_spacing, spacing_mm.has_value(), "spacings or space directions",
                      path.string());
    FilePlace place = nrrdPlaceOf(header, path.string());
    if (spacing_mm) place.frame.spacing_mm = *spacing_mm;
    RawVolume raw;
    VoxelBytes bytes(path, header);
    type.append(bytes, dims[0] * dims[1] * dims[2], header.fields.endian == "big", raw.values);
    if (!header.segments.empty()) raw.segments = joinLayers(header.segments, 1, raw.values, path.string());
    const bool flipped = makeRightHanded(place.frame, path.string(), raw.geometry, raw.values);
    if (header.exact_geometry && isSameGeometry(*header.exact_geometry, raw.geometry))
        raw.geometry = *header.exact_geometry;
    raw.lacks_patient_axes = !place.is_patients;
    raw.description = std::string("NRRD") + (flipped ? ", left-handed: third axis reversed" : "");
    return raw;
}

}  // namespace bonemill
