#include "haptic_server/scans/formats/volume_file.h"

#include <cstdint>
#include <cstdlib>
#include <map>
#include <sstream>
#include <string>

#include "common/base/user_error.h"
#include "common/files/require_file.h"
#include "haptic_server/scans/confined/import_limits.h"
#include "haptic_server/scans/formats/nifti_header.h"
#include "haptic_server/scans/formats/stored_bytes.h"
#include "haptic_server/scans/frame/physical_frame.h"
#include "haptic_server/scans/nrrd/nrrd_header.h"
#include "haptic_server/scans/pixels/itk_image_file.h"

namespace bonemill {
namespace {

struct MetaImageHeader {
    std::string data_file;  // empty: attached (LOCAL)
    bool is_compressed = false;
    uint64_t packed_bytes = 0;  // of the compressed voxels
    double mm_per_unit = 1;
    bool has_spacing = false;        // says something of the voxels' size
    bool has_patient_space = false;  // AnatomicalOrientation names the patient's sides
    uint64_t bytes = 0;              // length of the header; attached data begin here
};

constexpr size_t kMaxHeaderBytes = size_t(1) << 16;

using Fields = std::map<std::string, std::string>;

bool isTrue(const std::string& text) {
    return !text.empty() && (text[0] == 'T' || text[0] == 't' || text[0] == '1');
}

// The sides are letters such as RAI; "???" stands for none.
bool namesPatientSides(const std::string& text) {
    return text.size() == 3 && text.find_first_not_of("RLAPSI") == std::string::npos;
}

int countOf(const std::string& text) {
    std::istringstream words(text);
    int count = 0;
    for (double number; words >> number;) ++count;
    return words.eof() ? count : -1;
}

// MetaIO's fixed arrays trust these counts.
void checkCounts(const Fields& fields, const std::string& file) {
    const auto checkCount = [&](const char* key, int wanted) {
        const auto field = fields.find(key);
        if (field != fields.end() && countOf(field->second) != wanted)
            throw UserError(file + ": " + key + " = " + field->second + " does not hold " +
                            std::to_string(wanted) + " number" + (wanted == 1 ? "" : "s"));
    };
    checkCount("DimSize", 3);
    checkCount("ElementSpacing", 3);
    checkCount("ElementSize", 3);
    for (const char* origin : {"Offset", "Position", "Origin", "CenterOfRotation"}) checkCount(origin, 3);
    for (const char* matrix : {"TransformMatrix", "Rotation", "Orientation"}) checkCount(matrix, 9);
    for (const char* number : {"ElementNumberOfChannels", "HeaderSize", "CompressedDataSize"})
        checkCount(number, 1);
}

// MetaIO allocates what this number says, and reads no further.
uint64_t packedBytes(const std::string& text, const std::string& file) {
    const double bytes = std::strtod(text.c_str(), nullptr);
    if (!(bytes >= 1 && bytes < 1e15))
        throw UserError(file + ": its voxels are compressed, and CompressedDataSize (\"" + text +
                        "\") does not say to how many bytes; write the file anew");
    return uint64_t(bytes);
}

double mmPerDistanceUnit(const std::string& unit, const std::string& file) {
    if (unit.empty() || unit == "mm" || unit == "?") return 1;
    if (unit == "cm") return 10;
    if (unit == "um") return 1e-3;
    throw UserError(file + ": DistanceUnits = " + unit + " are not known; use mm, cm or um");
}

// Returns whether the field is absent or holds this number.
bool isNumber(Fields& fields, const char* key, double wanted) {
    const std::string& text = fields[key];
    char* end = nullptr;
    return text.empty() || (std::strtod(text.c_str(), &end) == wanted && *end == '\0');
}

// The library takes some of these for other voxels, and passes over the others.
void checkKind(Fields& fields, const std::string& file) {
    if (!isTrue(fields["BinaryData"]))
        throw UserError(file + ": its voxels are not said to be binary (BinaryData = True); write them so");
    if (!isNumber(fields, "HeaderSize", 0))
        throw UserError(file + ": HeaderSize = " + fields["HeaderSize"] +
                        " puts the voxels behind another header; cut that off");
    for (const auto& [key, none] : {std::pair("ElementToIntensityFunctionSlope", 1.0),
                                    std::pair("ElementToIntensityFunctionOffset", 0.0)})
        if (!isNumber(fields, key, none))
            throw UserError(file + ": " + key + " = " + fields[key] +
                            " scales the voxels, which is not supported; write them scaled");
    if (namesSeveralFiles(fields["ElementDataFile"]))
        throw UserError(file + ": spreads its voxels over several files (" + fields["ElementDataFile"] +
                        "); write them into one");
}

// MetaIO parts a name from its value by a colon, too, and takes one of two values of a name.
void takeLine(const std::string& line, size_t equals, const std::string& file, Fields& fields) {
    const std::string key = trimmed(line.substr(0, equals));
    if (key.find(':') != std::string::npos)
        throw UserError(file + ": its header's line \"" + key + " = ...\" holds a colon; take it out");
    if (!fields.emplace(key, trimmed(line.substr(equals + 1))).second && key != "Comment")
        throw UserError(file + ": its header states " + key + " twice; take one of them out");
}

// Returns the header's length.
uint64_t readFields(const std::filesystem::path& path, Fields& fields) {
    std::istringstream text(firstBytes(path, kMaxHeaderBytes));
    uint64_t bytes = 0;
    for (std::string line; !fields.count("ElementDataFile") && std::getline(text, line);) {
        bytes += line.size() + 1;
        const auto equals = line.find('=');
        if (equals == std::string::npos) break;
        takeLine(line, equals, path.string(), fields);
    }
    return bytes;
}

// Reads at most 64 KiB. Throws UserError naming the file when it is no three-dimensional MetaImage, or of a
// kind that the library reads otherwise than it is meant: voxels as text, behind another header, in several
// files, or to be scaled.
MetaImageHeader readMetaImageHeader(const std::filesystem::path& path) {
    const std::string file_name = path.string();
    Fields fields;
    const uint64_t bytes = readFields(path, fields);
    if (!fields.count("ElementDataFile") || !fields.count("DimSize") || !fields.count("ElementType"))
        throw UserError(file_name +
                        ": is not a MetaImage (DimSize, ElementType and ElementDataFile are needed)");
    if (fields["NDims"] != "3")
        throw UserError(file_name + ": has NDims = " + fields["NDims"] +
                        "; one volume of 3 dimensions is needed");
    checkCounts(fields, file_name);
    checkKind(fields, file_name);
    MetaImageHeader header;
    header.bytes = bytes;
    header.mm_per_unit = mmPerDistanceUnit(fields["DistanceUnits"], file_name);
    header.has_spacing = fields.count("ElementSpacing") || fields.count("ElementSize");
    header.has_patient_space = namesPatientSides(fields["AnatomicalOrientation"]);
    header.is_compressed = isTrue(fields["CompressedData"]);
    if (header.is_compressed) header.packed_bytes = packedBytes(fields["CompressedDataSize"], file_name);
    const std::string& data = fields["ElementDataFile"];
    if (data != "LOCAL" && data != "Local" && data != "local") header.data_file = data;
    return header;
}

struct FileFacts {
    std::string format;
    StoredData data;
    double mm_per_unit = 1;
    bool has_patient_space = true;
    bool has_spacing = true;              // libraries take 1 mm where it is not said
    bool has_other_data = false;          // beside its voxels, where the header says so
    uint64_t stored_bytes_per_voxel = 0;  // 0: as many as the library's
    std::optional<FileFrame> frame = {};  // nothing: the library's
    std::string remark = {};
    NrrdSegments segments = {};
    std::optional<Eigen::Vector3d> spacing_mm = {};  // what the scene says of it
};

// Axes of one voxel beyond the third do not make it less of a volume.
std::vector<uint64_t> volumeDims(std::vector<uint64_t> dims) {
    while (dims.size() > 3 && dims.back() == 1) dims.pop_back();
    return dims;
}

FileFrame frameOf(const ItkImageHeader& header, double mm_per_unit) {
    FileFrame frame;
    for (int a = 0; a < 3; ++a) {
        frame.dims[a] = int(header.dims[size_t(a)]);
        frame.spacing_mm[a] = header.spacing[size_t(a)] * mm_per_unit;
        frame.origin_mm[a] = header.origin[size_t(a)] * mm_per_unit;
        frame.directions.col(a) = Eigen::Vector3d(header.axis[size_t(a)].data());
    }
    return frame;
}

std::string segmentRemark(const Segments& segments) {
    if (segments.list.empty()) return {};
    return ", " + std::to_string(segments.list.size()) + " segments" +
           (segments.are_layered ? " in layers" : "");
}

// One byte may make their count even, or end a line. Of packed ones no more than the first few are counted.
std::string surplusRemark(const StoredData& data, uint64_t found, uint64_t needed) {
    if (data.packing == StoredData::Packing::kOther || found <= needed + 1) return {};
    const bool is_plain = data.packing == StoredData::Packing::kPlain;
    return "; " + data.file.filename().string() + " holds " +
           (is_plain ? std::to_string(found - needed) + " bytes more" : "more bytes") +
           " than the header's sizes need (" + std::to_string(needed) +
           "), which were not read: are they right?";
}

FileFrame frameFor(const FileFacts& facts, const ItkImageHeader& header) {
    FileFrame frame = facts.frame.value_or(frameOf(header, facts.mm_per_unit));
    if (facts.spacing_mm) frame.spacing_mm = *facts.spacing_mm;
    return frame;
}

RawVolume readThrough(ItkFormat format, const std::filesystem::path& path, const FileFacts& facts) {
    const std::string file = path.string();
    requireFile(facts.data.file);  // The library opens it with the header.
    ItkImageFile image(format, path);
    const ItkImageHeader& header = image.header();
    if (header.components != 1 && (facts.segments.empty() || header.components > kMaxSegments))
        throw UserError(file + ": has " + std::to_string(header.components) +
                        " values per voxel (colour or vectors); one number per voxel is needed");
    const std::vector<uint64_t> dims = volumeDims(header.dims);
    const uint64_t copies = format == ItkFormat::kNifti ? 2 : 1;  // its library fills a buffer of its own
    const uint64_t layers = header.components;
    checkVolumeSize(dims, copies * layers * header.bytes_per_voxel, file);
    requireOneSpacing(facts.has_spacing, facts.spacing_mm.has_value(),
                      format == ItkFormat::kNrrd ? "spacings or space directions" : "ElementSpacing = X Y Z",
                      file);
    if (facts.spacing_mm) checkSpacing(*facts.spacing_mm, file);
    const uint64_t voxels = dims[0] * dims[1] * dims[2];
    const uint64_t stored = facts.stored_bytes_per_voxel;
    const uint64_t needed = layers * voxels * (stored > 0 ? stored : header.bytes_per_voxel);
    const uint64_t found = countStoredBytes(facts.data, needed);
    checkStoredBytes(needed, found, file);
    RawVolume raw;
    raw.values.reserve(size_t(layers * voxels));
    image.appendValues(raw.values);
    if (!facts.segments.empty())
        raw.segments = joinLayers(facts.segments, uint32_t(layers), raw.values, file);
    const bool flipped = makeRightHanded(frameFor(facts, header), file, raw.geometry, raw.values);
    raw.lacks_patient_axes = !facts.has_patient_space;
    raw.description = facts.format + (flipped ? ", left-handed: third axis reversed" : "") +
                      (facts.remark.empty() ? "" : ", " + facts.remark) + segmentRemark(raw.segments) +
                      (facts.has_other_data ? "" : surplusRemark(facts.data, found, needed));
    return raw;
}

using Packing = StoredData::Packing;

}  // namespace

RawVolume importNrrd(const std::filesystem::path& path, const std::optional<Eigen::Vector3d>& spacing_mm) {
    const NrrdHeader header = readNrrdHeader(path);
    if (namesSeveralFiles(header.data_file))
        throw UserError(path.string() + ": spreads its voxels over several files (data file: " +
                        header.data_file + "); write them into one");
    FileFacts facts{.format = "NRRD",
                    .data = StoredData{path, header.bytes},
                    .mm_per_unit = header.mm_per_unit,
                    .has_patient_space = header.has_patient_space,
                    .has_spacing = header.has_spacing,
                    .has_other_data = header.fields.has_skip,
                    .segments = header.segments,
                    .spacing_mm = spacing_mm};
    if (!header.data_file.empty()) facts.data = StoredData{path.parent_path() / header.data_file};
    // ITK's NRRD library finds short gzip data itself.
    if (header.encoding != "raw") facts.data.packing = Packing::kOther;
    RawVolume raw = readThrough(ItkFormat::kNrrd, path, facts);
    if (header.exact_geometry && isSameGeometry(*header.exact_geometry, raw.geometry))
        raw.geometry = *header.exact_geometry;
    return raw;
}

RawVolume importNifti(const std::filesystem::path& path) {
    const NiftiHeader header = readNiftiHeader(path);
    FileFacts facts{.format = "NIfTI",
                    .data = StoredData{path, header.data_offset},
                    .has_patient_space = header.has_patient_space,
                    .stored_bytes_per_voxel = header.bytes_per_voxel,
                    .frame = header.frame,
                    .remark = header.remark};
    if (path.extension() == ".gz") facts.data = StoredData{path, 0, Packing::kDeflate, 0, header.data_offset};
    if (header.frame) checkFrame(*header.frame, path.string());
    return readThrough(ItkFormat::kNifti, path, facts);
}

RawVolume importMetaImage(const std::filesystem::path& path,
                          const std::optional<Eigen::Vector3d>& spacing_mm) {
    const MetaImageHeader header = readMetaImageHeader(path);
    FileFacts facts{.format = "MetaImage",
                    .data = StoredData{path, header.bytes},
                    .mm_per_unit = header.mm_per_unit,
                    .has_patient_space = header.has_patient_space,
                    .has_spacing = header.has_spacing,
                    .spacing_mm = spacing_mm};
    if (!header.data_file.empty()) facts.data = StoredData{path.parent_path() / header.data_file};
    if (header.is_compressed) {
        checkStoredBytes(header.packed_bytes, countStoredBytes(facts.data, header.packed_bytes),
                         path.string());
        facts.data.packing = Packing::kDeflate;
        facts.data.packed_bytes = header.packed_bytes;
    }
    return readThrough(ItkFormat::kMetaImage, path, facts);
}

}  // namespace bonemill
