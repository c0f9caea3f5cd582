#include "haptic_server/scans/formats/metaimage_header.h"

#include <algorithm>
#include <array>
#include <cstdlib>
#include <map>
#include <optional>
#include <sstream>
#include <string_view>
#include <vector>

#include "common/base/user_error.h"
#include "haptic_server/scans/formats/stored_bytes.h"
#include "haptic_server/scans/nrrd/nrrd_header.h"

namespace bonemill {
namespace {

constexpr double kMaxEdge = 1e9;  // more is refused before it is asked for
constexpr size_t kMaxHeaderBytes = size_t(1) << 16;

using Fields = std::map<std::string, std::string>;

bool isTrue(const std::string& text) {
    return !text.empty() && (text[0] == 'T' || text[0] == 't' || text[0] == '1');
}

// None where the text is anything else.
std::vector<double> numbersOf(const std::string& text) {
    std::istringstream words(text);
    std::vector<double> numbers;
    for (double number; words >> number;) numbers.push_back(number);
    return words.eof() ? numbers : std::vector<double>();
}

constexpr std::array kOriginNames = {"Offset", "Position", "Origin"};
constexpr std::array kMatrixNames = {"TransformMatrix", "Rotation", "Orientation"};

// MetaIO's fixed arrays trust these counts.
void checkCounts(const Fields& fields, const std::string& file) {
    const auto checkCount = [&](const char* key, int wanted) {
        const auto field = fields.find(key);
        if (field != fields.end() && numbersOf(field->second).size() != size_t(wanted))
            throw UserError(file + ": " + key + " = " + field->second + " does not hold " +
                            std::to_string(wanted) + " number" + (wanted == 1 ? "" : "s"));
    };
    checkCount("DimSize", 3);
    checkCount("ElementSpacing", 3);
    checkCount("ElementSize", 3);
    checkCount("CenterOfRotation", 3);
    for (const char* origin : kOriginNames) checkCount(origin, 3);
    for (const char* matrix : kMatrixNames) checkCount(matrix, 9);
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

// A file may use any of the names. Of several that do not agree the library takes one.
std::vector<double> numbersOfAny(const Fields& fields, const std::array<const char*, 3>& names,
                                 const std::vector<double>& otherwise, const std::string& file) {
    const char* first = nullptr;
    for (const char* name : names) {
        if (!fields.count(name)) continue;
        if (first && numbersOf(fields.at(name)) != numbersOf(fields.at(first)))
            throw UserError(file + ": its " + first + " and its " + name +
                            " say different things; take one of them out");
        if (!first) first = name;
    }
    return first ? numbersOf(fields.at(first)) : otherwise;
}

// Towards the patient's left, back or head it is that axis of LPS, else its opposite; nothing: no such side.
std::optional<Eigen::Vector3d> towards(char side) {
    const size_t axis = std::string_view("LPS").find(side), opposite = std::string_view("RAI").find(side);
    if (axis != std::string_view::npos) return Eigen::Vector3d::Unit(Eigen::Index(axis));
    if (opposite != std::string_view::npos) return -Eigen::Vector3d::Unit(Eigen::Index(opposite));
    return std::nullopt;
}

// Of AnatomicalOrientation ITK writes the sides where the axes begin (RAI beside a matrix of 1), MetaIO's own
// documentation means those where they end.
bool areSidesOf(const std::string& sides, const Eigen::Matrix3d& directions) {
    constexpr double kLeastCosine = 0.3;  // an axis between three sides has 0.58 with each
    double least = 1, most = -1;
    for (int a = 0; a < 3; ++a) {
        const double cosine = directions.col(a).normalized().dot(towards(sides[size_t(a)]).value());
        least = std::min(least, cosine);
        most = std::max(most, cosine);
    }
    return least > kLeastCosine || most < -kLeastCosine;
}

// Its letters name the patient's sides; other letters, "???" among them, name none.
bool namesPatientSides(const std::string& text) {
    return text.size() == 3 && std::ranges::all_of(text, [](char side) { return towards(side).has_value(); });
}

FilePlace placeOf(const Fields& fields, const std::string& file) {
    const auto text = [&](const char* name) { return fields.count(name) ? fields.at(name) : std::string(); };
    const double mm_per_unit = mmPerDistanceUnit(text("DistanceUnits"), file);
    // ElementSize is how large the voxels are, wherever they lie.
    const std::string& spacing = text(fields.count("ElementSpacing") ? "ElementSpacing" : "ElementSize");
    const auto vectorOf = [](const std::vector<double>& n) { return Eigen::Vector3d(n.data()); };
    FilePlace place;
    FileFrame& frame = place.frame;
    frame.dims = vectorOf(numbersOf(text("DimSize"))).cwiseMin(kMaxEdge).cwiseMax(0).cast<int>();
    frame.spacing_mm =
        mm_per_unit * (spacing.empty() ? Eigen::Vector3d::Ones() : vectorOf(numbersOf(spacing)));
    frame.origin_mm = mm_per_unit * vectorOf(numbersOfAny(fields, kOriginNames, {0, 0, 0}, file));
    // Each three numbers are where an axis points.
    frame.directions =
        Eigen::Matrix3d(numbersOfAny(fields, kMatrixNames, {1, 0, 0, 0, 1, 0, 0, 0, 1}, file).data());
    const std::string sides = text("AnatomicalOrientation");
    place.is_patients = namesPatientSides(sides);
    if (place.is_patients && !areSidesOf(sides, frame.directions))
        throw UserError(
            file + ": its AnatomicalOrientation " + sides +
            " contradicts its TransformMatrix (1 0 0 0 1 0 0 0 1 where there is none), in which each "
            "three numbers point along an axis, to the patient's left, back and head; correct the "
            "wrong one, or take AnatomicalOrientation out");
    return place;
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
    header.has_spacing = fields.count("ElementSpacing") || fields.count("ElementSize");
    header.place = placeOf(fields, file_name);
    header.is_compressed = isTrue(fields["CompressedData"]);
    if (header.is_compressed) header.packed_bytes = packedBytes(fields["CompressedDataSize"], file_name);
    const std::string& data = fields["ElementDataFile"];
    if (data != "LOCAL" && data != "Local" && data != "local") header.data_file = data;
    return header;
}

}  // namespace bonemill
