// A DICOM series that names its patient everywhere, and the search for what is left of that in other files.
#pragma once

#include <zlib.h>

#include <algorithm>
#include <cctype>
#include <cstdint>
#include <cstring>
#include <filesystem>
#include <fstream>
#include <functional>
#include <iterator>
#include <string>
#include <vector>

#include "haptic_server/core/volume/index_box.h"
#include "tests/unit/haptic_server/scans/import/dicom_elements.h"

namespace bonemill::test {

// Every planted text holds one of these; upper case, as forgetCase() has it.
inline const std::vector<std::string> kPlanted = {"QVPLANTED", "19610203", "20190817", "826.777.42"};

inline std::string bytesOfFile(const std::filesystem::path& file) {
    std::ifstream in(file, std::ios::binary);
    return {std::istreambuf_iterator<char>(in), {}};
}

inline std::string forgetCase(std::string text) {
    std::ranges::transform(text, text.begin(), [](unsigned char c) { return char(std::toupper(c)); });
    return text;
}

// Those that are in these bytes, in any case.
inline std::vector<std::string> plantedIn(const std::string& bytes) {
    const std::string text = forgetCase(bytes);
    std::vector<std::string> found;
    for (const std::string& word : kPlanted)
        if (text.find(word) != std::string::npos) found.push_back(word);
    return found;
}

// What is packed as gzip or zlib from this place on, as far as it goes.
inline std::string inflated(const std::string& bytes, size_t begin) {
    z_stream stream{};
    constexpr int kEitherHead = 15 + 32;
    if (inflateInit2(&stream, kEitherHead) != Z_OK) return {};
    stream.next_in = reinterpret_cast<Bytef*>(const_cast<char*>(bytes.data() + begin));
    stream.avail_in = uInt(bytes.size() - begin);
    std::string out;
    std::vector<char> block(size_t(1) << 16);
    int result = Z_OK;
    while (result == Z_OK) {
        stream.next_out = reinterpret_cast<Bytef*>(block.data());
        stream.avail_out = uInt(block.size());
        result = inflate(&stream, Z_NO_FLUSH);
        out.append(block.data(), block.size() - stream.avail_out);
    }
    inflateEnd(&stream);
    return out;
}

// The bytes, and all that is packed in them as gzip.
inline std::string unpacked(const std::string& bytes) {
    std::string all = bytes;
    for (size_t at = bytes.find("\x1f\x8b\x08"); at != std::string::npos;
         at = bytes.find("\x1f\x8b\x08", at + 1))
        all += inflated(bytes, at);
    return all;
}

// Names of the chunks of a PNG, in their order.
inline std::vector<std::string> pngChunks(const std::string& bytes) {
    std::vector<std::string> names;
    for (size_t at = 8; at + 12 <= bytes.size();) {
        uint32_t length = 0;
        for (size_t n = 0; n < 4; ++n) length = length << 8 | uint8_t(bytes[at + n]);
        names.push_back(bytes.substr(at + 4, 4));
        at += size_t(length) + 12;
    }
    return names;
}

// Names, links and contents of everything in the folder: where which planted text was found.
inline std::vector<std::string> plantedUnder(const std::filesystem::path& folder) {
    std::vector<std::string> found;
    const auto search = [&](const std::string& where, const std::string& bytes) {
        for (const std::string& word : plantedIn(bytes)) found.push_back(where + ": " + word);
    };
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder)) {
        const std::filesystem::path& path = entry.path();
        search("name of " + path.string(), path.lexically_relative(folder).string());
        if (entry.is_symlink()) search("link " + path.string(), std::filesystem::read_symlink(path).string());
        if (entry.is_regular_file()) search(path.string(), unpacked(bytesOfFile(path)));
    }
    return found;
}

struct PlantedSlice {
    int number = 0, edge = 40;  // pixels a side, a mm each
    std::function<int(const Eigen::Vector3i& voxel)> hu;
};

inline std::string plantedSliceBytes(const PlantedSlice& slice) {
    using namespace dicom;
    const std::string uid = "1.2.826.777.42.", text = "QVPLANTED ", kCt = "1.2.840.10008.5.1.4.1.1.2";
    const std::string own = uid + "9." + std::to_string(slice.number + 1);
    std::string pixels;
    for (int j = 0; j < slice.edge; ++j)
        for (int i = 0; i < slice.edge; ++i) pixels += number(uint16_t(slice.hu({i, j, slice.number})), 2);
    return metaHeader(kCt, own, "1.2.840.10008.1.2.1") +
           element(0x00080008, "CS", "ORIGINAL\\PRIMARY\\AXIAL") + element(0x00080012, "DA", "20190817") +
           element(0x00080014, "UI", uid + "1") + element(0x00080016, "UI", kCt) +
           element(0x00080018, "UI", own) + element(0x00080020, "DA", "20190817") +
           element(0x00080022, "DA", "20190817") + element(0x00080050, "SH", "QVPLANTED1") +
           element(0x00080060, "CS", "CT") + element(0x00080070, "LO", text + "maker") +
           element(0x00080080, "LO", text + "clinic") + element(0x00080081, "ST", text + "street") +
           element(0x00080090, "PN", "QVPLANTED^REFERRER") + element(0x00081010, "SH", "QVPLANTED2") +
           element(0x00081030, "LO", text + "study") + element(0x0008103e, "LO", text + "series") +
           element(0x00081050, "PN", "QVPLANTED^SURGEON") + element(0x00081070, "PN", "QVPLANTED^OPERATOR") +
           element(0x00081080, "LO", text + "diagnosis") + element(0x00090010, "LO", text + "creator") +
           element(0x00091001, "LO", text + "private") + element(0x00091002, "UN", text + "unknown") +
           element(0x00100010, "PN", "QVPLANTED^PATIENT") + element(0x00100020, "LO", "QVPLANTED-ID") +
           element(0x00100030, "DA", "19610203") + element(0x00101000, "LO", text + "other id") +
           element(0x00101001, "PN", "QVPLANTED^BORN") + element(0x00101040, "LO", text + "address") +
           element(0x00102154, "SH", "QVPLANTED3") + element(0x001021b0, "LT", text + "history") +
           element(0x00104000, "LT", text + "patient's comments") +
           element(0x00180010, "LO", text + "contrast") + element(0x00181000, "LO", "QVPLANTED-SERIAL") +
           element(0x00181030, "LO", text + "protocol") + element(0x00181210, "SH", "QVPLANTED4") +
           element(0x0020000d, "UI", uid + "2") + element(0x0020000e, "UI", uid + "3") +
           element(0x00200010, "SH", "QVPLANTED5") + element(0x00200012, "IS", "1") +
           element(0x00200032, "DS", "0\\0\\" + std::to_string(slice.number)) +
           element(0x00200037, "DS", "1\\0\\0\\0\\1\\0") + element(0x00200052, "UI", uid + "4") +
           element(0x00204000, "LT", text + "image comments") + shortElement(0x00280002, 1) +
           element(0x00280004, "CS", "MONOCHROME2") + shortElement(0x00280010, slice.edge) +
           shortElement(0x00280011, slice.edge) + element(0x00280030, "DS", "1\\1") +
           shortElement(0x00280100, 16) + shortElement(0x00280101, 16) + shortElement(0x00280102, 15) +
           shortElement(0x00280103, 1) + element(0x00281052, "DS", "0") + element(0x00281053, "DS", "1") +
           element(0x00324000, "LT", text + "study comments") +
           element(0x00400254, "LO", text + "procedure") + element(0x7fe00010, "OW", pixels);
}

// 40³ voxels of 1 mm from the origin on, in a folder that names the patient, too.
inline std::filesystem::path writePlantedSeries(const std::filesystem::path& folder,
                                                const std::function<int(const Eigen::Vector3i&)>& hu) {
    const std::filesystem::path series = folder / "QVPLANTED^PATIENT_19610203";
    std::filesystem::create_directories(series);
    for (int n = 0; n < 40; ++n)
        std::ofstream(series / ("qvplanted" + std::to_string(n) + ".dcm"), std::ios::binary)
            << plantedSliceBytes({.number = n, .hu = hu});
    return series;
}

// A ball of bone in soft tissue, beside air.
inline int plantedHu(const Eigen::Vector3i& v) {
    const double d = (v.cast<double>() - Eigen::Vector3d(20, 20, 20)).norm() - 12;
    return v.z() == 0 ? -1000 : int(std::clamp(500 - 700 * d, 40.0, 1500.0));
}

}  // namespace bonemill::test
