#include "haptic_server/scans/nrrd/nrrd_header.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <fstream>
#include <limits>
#include <set>
#include <sstream>

#include "common/base/user_error.h"

namespace bonemill {
namespace {

constexpr size_t kMaxHeaderBytes = size_t(1) << 20;
// Decimal text in mm carries 15 digits or more; anything further away is another geometry.
constexpr double kGeometryTolerance = 1e-9;

// Field names ignore blanks and case: "data file", "datafile", "Data File".
std::string fieldName(const std::string& text) {
    std::string name;
    for (const char c : text)
        if (c != ' ' && c != '\t') name += char(std::tolower(static_cast<unsigned char>(c)));
    return name;
}

double mmPerUnit(const std::string& unit, const std::filesystem::path& path) {
    if (unit.empty() || unit == "mm" || unit == "millimeter" || unit == "???") return 1;
    if (unit == "m") return 1000;
    if (unit == "cm") return 10;
    if (unit == "um" || unit == "micron") return 1e-3;
    throw UserError(path.string() + ": space units \"" + unit + "\" are not known; use mm, cm, m or um");
}

// They stand in quotation marks; some writers leave these out.
std::vector<std::string> unitsOf(const std::string& text) {
    std::vector<std::string> units;
    if (text.find('"') == std::string::npos) {
        std::istringstream words(text);
        for (std::string word; words >> word;) units.push_back(word);
        return units;
    }
    for (size_t open = text.find('"'); open != std::string::npos;) {
        const size_t close = std::min(text.find('"', open + 1), text.size());
        units.push_back(text.substr(open + 1, close - open - 1));
        open = text.find('"', close + 1);
    }
    return units;
}

// A fourth axis may be time.
double mmPerUnitOfAll(const std::string& text, const std::filesystem::path& path) {
    std::vector<std::string> units = unitsOf(text);
    units.resize(std::min<size_t>(units.size(), 3));
    double mm = 1;
    for (const std::string& unit : units) {
        const double other = mmPerUnit(unit, path);
        if (&unit != &units.front() && other != mm)
            throw UserError(path.string() + ": its units (" + text +
                            ") differ from axis to axis; write all of them in mm");
        mm = other;
    }
    return mm;
}

// The library takes vectors whose length is no number for 1 mm.
void checkDirections(const std::string& text, const std::filesystem::path& path) {
    constexpr double kFarTooLong = 1e100;
    for (const double n : numbersIn(text))
        if (!(std::abs(n) <= kFarTooLong))
            throw UserError(path.string() +
                            ": the voxel spacing is not a sensible length; the header is damaged");
}

// For "nan", which stands where nothing is known, the library takes 1 mm, too.
void checkSpacings(const std::string& text, const std::filesystem::path& path) {
    for (const double n : numbersIn(text))
        if (!std::isfinite(n) || n <= 0)
            throw UserError(path.string() + ": its spacings (" + text +
                            ") are no lengths; write the voxels' size into the NRRD header");
}

// The library counts some of them with 32 bit, and would take 2^32 + 1 for 1.
void checkSizes(const std::string& text, const std::filesystem::path& path) {
    constexpr double kMostSize = std::numeric_limits<int>::max();
    for (const double n : numbersIn(text))
        if (!(n <= kMostSize))
            throw UserError(path.string() + ": its sizes (" + text + ") are absurd; the header is damaged");
}

void keepField(const std::string& name, const std::string& value, NrrdFields& fields) {
    if (name == "type") fields.type = value;
    if (name == "endian") fields.endian = fieldName(value);
    if (name == "space") fields.space = fieldName(value);
    if (name == "sizes") fields.sizes = value;
    if (name == "spacedirections") fields.space_directions = value;
    if (name == "spaceorigin") fields.space_origin = value;
    if (name == "spacings") fields.spacings = value;
    if (name == "kinds") fields.kinds = value;
    if (name == "axismins") fields.axis_mins = value;
    if (name == "axismaxs") fields.axis_maxs = value;
    if (name == "centers" || name == "centerings") fields.centers = value;
    if (name == "spaceunits") fields.space_units = value;
    if (name == "units") fields.axis_units = value;
    if (name == "lineskip" || name == "byteskip") fields.has_skip = fields.has_skip || value != "0";
}

void takeField(const std::string& name, const std::string& value, const std::filesystem::path& path,
               NrrdHeader& header) {
    keepField(name, value, header.fields);
    if (name == "encoding") header.encoding = fieldName(value);
    if (name == "datafile") header.data_file = value;
    if (name == "spacedirections") checkDirections(value, path);
    if (name == "spacings") checkSpacings(value, path);
    if (name == "sizes") checkSizes(value, path);
    header.has_spacing = header.has_spacing || name == "spacedirections" || name == "spacings";
}

// `seen` are the fields of the lines before.
void takeLine(const std::string& line, const std::filesystem::path& path, std::set<std::string>& seen,
              NrrdHeader& header) {
    const auto colon = line.find(':');
    if (line[0] == '#' || colon == std::string::npos) return;
    if (line.compare(colon, 2, ":=") != 0) {
        const std::string name = fieldName(line.substr(0, colon));
        if (!seen.insert(name).second)
            throw UserError(path.string() + ": its header states " + trimmed(line.substr(0, colon)) +
                            " twice; take one of them out");
        return takeField(name, trimmed(line.substr(colon + 1)), path, header);
    }
    if (line.substr(0, colon) == kNrrdGeometryKey)
        header.exact_geometry = geometryFromText(line.substr(colon + 2));
    takeSegmentLine(line.substr(0, colon), line.substr(colon + 2), path, header.segments);
}

}  // namespace

std::vector<double> numbersIn(std::string text) {
    for (char& c : text)
        if (c == '(' || c == ',' || c == ')') c = ' ';
    std::istringstream words(text);
    std::vector<double> numbers;
    for (std::string word; words >> word;) numbers.push_back(std::strtod(word.c_str(), nullptr));
    return numbers;
}

std::string firstBytes(const std::filesystem::path& path, size_t most) {
    std::ifstream file(path, std::ios::binary);
    std::string bytes(most, '\0');
    file.read(bytes.data(), std::streamsize(most));
    bytes.resize(size_t(file.gcount()));
    return bytes;
}

std::string trimmed(const std::string& text) {
    const auto first = text.find_first_not_of(" \t\r");
    if (first == std::string::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

NrrdHeader readNrrdHeader(const std::filesystem::path& path) {
    std::istringstream text(firstBytes(path, kMaxHeaderBytes));
    std::string line;
    if (!std::getline(text, line) || line.rfind("NRRD000", 0) != 0)
        throw UserError(path.string() + ": is not a NRRD file (it does not start with NRRD000)");
    NrrdHeader header;
    std::set<std::string> seen;
    header.bytes = line.size() + 1;
    while (std::getline(text, line)) {
        header.bytes += line.size() + 1;
        if (trimmed(line).empty()) break;
        takeLine(line, path, seen, header);
    }
    if (header.bytes >= kMaxHeaderBytes)
        throw UserError(path.string() + ": the NRRD header does not end; the file is damaged");
    const NrrdFields& fields = header.fields;
    header.mm_per_unit =
        mmPerUnitOfAll(fields.space_units.empty() ? fields.axis_units : fields.space_units, path);
    return header;
}

std::string geometryToText(const VolumeGeometry& geometry) {
    const auto& q = geometry.X_WV.rotation;
    const auto& p = geometry.X_WV.position;
    const auto& s = geometry.spacing;
    const auto& n = geometry.dims;
    char text[512];
    std::snprintf(text, sizeof text, "%d %d %d %a %a %a %a %a %a %a %a %a %a", n.x(), n.y(), n.z(), s.x(),
                  s.y(), s.z(), p.x(), p.y(), p.z(), q.w(), q.x(), q.y(), q.z());
    return text;
}

std::optional<VolumeGeometry> geometryFromText(const std::string& text) {
    std::istringstream words(text);
    double number[13];
    for (double& n : number) {
        std::string word;
        if (!(words >> word)) return std::nullopt;
        char* end = nullptr;
        n = std::strtod(word.c_str(), &end);
        if (end == word.c_str() || !std::isfinite(n)) return std::nullopt;
    }
    for (int a = 0; a < 3; ++a)
        if (number[a] < 1 || number[a] > 1e9 || number[a + 3] <= 0) return std::nullopt;
    VolumeGeometry geometry;
    geometry.dims = Eigen::Vector3d(number[0], number[1], number[2]).cast<int>();
    geometry.spacing = {number[3], number[4], number[5]};
    geometry.X_WV.position = {number[6], number[7], number[8]};
    geometry.X_WV.rotation = Eigen::Quaterniond(number[9], number[10], number[11], number[12]);
    if (std::abs(geometry.X_WV.rotation.norm() - 1) > kGeometryTolerance) return std::nullopt;
    return geometry;
}

bool isSameGeometry(const VolumeGeometry& a, const VolumeGeometry& b) {
    if (a.dims != b.dims) return false;
    const Eigen::Vector3d steps = a.dims.cast<double>();
    const double scale = (steps.cwiseProduct(a.spacing)).norm() + a.X_WV.position.norm();
    for (int corner = 0; corner < 4; ++corner) {  // origin and the end of each axis fix the whole grid
        Eigen::Vector3d index = Eigen::Vector3d::Zero();
        if (corner > 0) index[corner - 1] = steps[corner - 1];
        const Eigen::Vector3d difference =
            a.X_WV * a.spacing.cwiseProduct(index) - b.X_WV * b.spacing.cwiseProduct(index);
        if (!(difference.norm() <= kGeometryTolerance * scale)) return false;
    }
    return true;
}

}  // namespace bonemill
