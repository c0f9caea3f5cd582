#include "haptic_server/scans/formats/meta_image_header.h"

#include <cstdlib>
#include <map>
#include <sstream>

#include "common/base/user_error.h"
#include "haptic_server/scans/formats/stored_bytes.h"
#include "haptic_server/scans/nrrd/header_text.h"

namespace bonemill {
namespace {

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

}  // namespace

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

}  // namespace bonemill
