#include "haptic_server/volume/import/meta_image_header.h"

#include <cstdlib>
#include <fstream>
#include <map>
#include <sstream>

#include "common/user_error.h"

namespace bonemill {
namespace {

constexpr size_t kMaxHeaderBytes = size_t(1) << 16;

std::string trimmed(const std::string& text) {
    const auto first = text.find_first_not_of(" \t\r");
    if (first == std::string::npos) return {};
    return text.substr(first, text.find_last_not_of(" \t\r") - first + 1);
}

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
void checkCounts(const std::map<std::string, std::string>& fields, const std::string& file) {
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

// MetaIO allocates what this number says.
uint64_t packedBytes(const std::string& text, const std::string& file) {
    if (text.empty()) return 0;
    const double bytes = std::strtod(text.c_str(), nullptr);
    if (!(bytes >= 0 && bytes < 1e15))
        throw UserError(file + ": CompressedDataSize = " + text + " is no size");
    return uint64_t(bytes);
}

}  // namespace

MetaImageHeader readMetaImageHeader(const std::filesystem::path& path) {
    const std::string file_name = path.string();
    std::ifstream file(path, std::ios::binary);
    std::map<std::string, std::string> fields;
    std::string line;
    uint64_t bytes = 0;
    while (!fields.count("ElementDataFile") && bytes < kMaxHeaderBytes && std::getline(file, line)) {
        bytes += line.size() + 1;
        const auto equals = line.find('=');
        if (equals == std::string::npos) break;
        fields[trimmed(line.substr(0, equals))] = trimmed(line.substr(equals + 1));
    }
    if (!fields.count("ElementDataFile") || !fields.count("DimSize") || !fields.count("ElementType"))
        throw UserError(file_name +
                        ": is not a MetaImage (DimSize, ElementType and ElementDataFile are needed)");
    if (fields["NDims"] != "3")
        throw UserError(file_name + ": has NDims = " + fields["NDims"] +
                        "; one volume of 3 dimensions is needed");
    checkCounts(fields, file_name);
    MetaImageHeader header;
    header.bytes = bytes;
    header.has_spacing = fields.count("ElementSpacing") || fields.count("ElementSize");
    header.has_patient_space = namesPatientSides(fields["AnatomicalOrientation"]);
    header.is_compressed = isTrue(fields["CompressedData"]);
    if (header.is_compressed) header.packed_bytes = packedBytes(fields["CompressedDataSize"], file_name);
    const std::string& data = fields["ElementDataFile"];
    if (data != "LOCAL" && data != "Local" && data != "local") header.data_file = data;
    return header;
}

}  // namespace bonemill
