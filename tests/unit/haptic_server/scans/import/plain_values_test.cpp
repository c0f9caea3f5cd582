// A known ramp comes back from NRRD, NIfTI, MetaImage, PNG and TIFF as it was stored, for every type, order
// of bytes, packing and scale; and what a library would change for a display is read as stored, or refused
// for its true reason.
#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <functional>
#include <limits>

#include "haptic_server/scans/import/import_volume.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/haptic_server/scans/import/deflated_bytes.h"
#include "tests/unit/haptic_server/scans/import/expect_user_error.h"
#include "tests/unit/haptic_server/scans/import/picture_files.h"
#include "tests/unit/haptic_server/scans/import/tiff_bytes.h"
#include "tests/unit/haptic_server/scans/import/volume_files.h"

namespace bonemill {
namespace {

constexpr int kColumns = 5, kRows = 4, kDepth = 3, kValues = kColumns * kRows * kDepth;
constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

struct Type {
    const char *nrrd, *meta;
    int nifti;  // datatype
    int bytes;
    bool is_signed, is_float;
};
constexpr Type kTypes[] = {
    {"uint8", "MET_UCHAR", 2, 1, false, false},     {"int8", "MET_CHAR", 256, 1, true, false},
    {"uint16", "MET_USHORT", 512, 2, false, false}, {"int16", "MET_SHORT", 4, 2, true, false},
    {"uint32", "MET_UINT", 768, 4, false, false},   {"int32", "MET_INT", 8, 4, true, false},
    {"float", "MET_FLOAT", 16, 4, true, true},      {"double", "MET_DOUBLE", 64, 8, true, true}};

// All that the type holds, as far as a float does.
std::vector<double> rampOf(int bits, bool is_signed) {
    const double count = std::ldexp(1, std::min(bits, 24)), low = is_signed ? -count / 2 : 0;
    std::vector<double> ramp;
    for (int n = 0; n < kValues; ++n) ramp.push_back(std::floor(low + (count - 1) * n / (kValues - 1)));
    return ramp;
}
std::vector<double> rampOf(const Type& type) {
    return rampOf(8 * type.bytes, type.is_signed);
}

template <class T>
std::string asBytes(T value, bool is_big_endian) {
    std::string bytes(sizeof value, '\0');
    std::memcpy(bytes.data(), &value, sizeof value);
    if (is_big_endian) std::ranges::reverse(bytes);
    return bytes;
}

std::string asBytes(const Type& type, double value, bool is_big_endian) {
    if (type.is_float)
        return type.bytes == 4 ? asBytes(float(value), is_big_endian) : asBytes(value, is_big_endian);
    const std::string whole = asBytes(int64_t(value), is_big_endian);
    return is_big_endian ? whole.substr(8 - size_t(type.bytes)) : whole.substr(0, size_t(type.bytes));
}

std::string asBytes(const Type& type, const std::vector<double>& ramp, bool is_big_endian) {
    std::string bytes;
    for (const double value : ramp) bytes += asBytes(type, value, is_big_endian);
    return bytes;
}

class PlainValues : public testing::Test {
  protected:
    void expectRamp(const std::filesystem::path& path, const std::vector<double>& ramp,
                    const std::string& what, const ImportOptions& options = {}) {
        SCOPED_TRACE(what);
        RawVolume raw;
        ASSERT_NO_THROW(raw = importVolumeHere(path, options));
        ASSERT_EQ(raw.values.size(), ramp.size());
        for (size_t n = 0; n < ramp.size(); ++n) ASSERT_NEAR(raw.values[n], ramp[n], 1) << "value " << n;
        ++count_;
    }
    void expectRefused(const std::filesystem::path& path, std::initializer_list<std::string> words,
                       const ImportOptions& options = {}) {
        expectUserError([&] { importVolumeHere(path, options); }, words);
    }

    test::TemporaryFolder folder_;
    int count_ = 0;
};

std::string nrrdOf(const Type& type, const std::string& bytes, bool is_big_endian,
                   const std::string& encoding) {
    return std::string("NRRD0004\ntype: ") + type.nrrd +
           "\ndimension: 3\nspace: LPS\nsizes: 5 4 3\nspace directions: (1,0,0) (0,1,0) (0,0,1)\n"
           "space origin: (0,0,0)\nold min: 3\nold max: 7\nendian: " +
           (is_big_endian ? "big" : "little") + "\nencoding: " + encoding + "\n\n" + bytes;
}

TEST_F(PlainValues, ofNrrdComeBack) {
    for (const Type& type : kTypes)
        for (const bool is_big_endian : {false, true})
            for (const char* encoding : {"raw", "gzip"}) {
                std::string bytes = asBytes(type, rampOf(type), is_big_endian);
                if (encoding[0] == 'g') bytes = deflated(bytes, DeflateHead::kGzip);
                writeBytes(folder_ / "a.nrrd", nrrdOf(type, bytes, is_big_endian, encoding));
                expectRamp(folder_ / "a.nrrd", rampOf(type), type.nrrd + std::string(encoding));
            }
    EXPECT_EQ(count_, 8 * 2 * 2);
}

std::string metaOf(const Type& type, const std::string& bytes, bool is_big_endian, bool is_packed) {
    return std::string("ObjectType = Image\nNDims = 3\nBinaryData = True\nBinaryDataByteOrderMSB = ") +
           (is_big_endian ? "True" : "False") +
           (is_packed ? "\nCompressedData = True\nCompressedDataSize = " + std::to_string(bytes.size())
                      : "") +
           "\nElementMin = 3\nElementMax = 7\nElementSpacing = 1 1 1\nDimSize = 5 4 3\nElementType = " +
           type.meta + "\nElementDataFile = LOCAL\n" + bytes;
}

TEST_F(PlainValues, ofMetaImageComeBack) {
    for (const Type& type : kTypes)
        for (const bool is_big_endian : {false, true})
            for (const bool is_packed : {false, true}) {
                std::string bytes = asBytes(type, rampOf(type), is_big_endian);
                if (is_packed) bytes = deflated(bytes, DeflateHead::kZlib);
                writeBytes(folder_ / "a.mha", metaOf(type, bytes, is_big_endian, is_packed));
                expectRamp(folder_ / "a.mha", rampOf(type), type.meta);
            }
    EXPECT_EQ(count_, 8 * 2 * 2);
}

struct Scale {
    float slope, intercept;
    bool applies;
};
// No slope is said by 0 or NaN.
constexpr Scale kScales[] = {{1, 0, true},     {0, 0, false},    {kNan, 0, false},       {kNan, kNan, false},
                             {0, kNan, false}, {1, -1024, true}, {0.5f, -100.25f, true}, {-2, 7, true}};

std::string niftiOf(const Type& type, const std::string& bytes, const Scale& scale, bool is_big_endian) {
    std::string header(352, '\0');
    const auto put = [&](size_t offset, auto value) {
        header.replace(offset, sizeof value, asBytes(value, is_big_endian));
    };
    put(0, int32_t(348));
    for (size_t n = 0; n < 4; ++n) put(40 + 2 * n, int16_t(n == 0 ? 3 : 6 - int(n)));
    put(70, int16_t(type.nifti));
    put(72, int16_t(8 * type.bytes));
    for (size_t n = 0; n < 4; ++n) put(76 + 4 * n, 1.0f);
    put(108, 352.0f);
    put(112, scale.slope);
    put(116, scale.intercept);
    header[123] = 2;
    put(124, 7.0f);  // cal_max, for a display
    put(128, 3.0f);  // cal_min
    put(254, int16_t(1));
    for (size_t row = 0; row < 3; ++row) put(280 + 20 * row, row < 2 ? -1.0f : 1.0f);
    header.replace(344, 3, "n+1");
    return header + bytes;
}

TEST_F(PlainValues, ofNiftiComeBack) {
    for (const Type& type : kTypes)
        for (const bool is_big_endian : {false, true})
            for (const Scale& scale : kScales)
                for (const bool is_packed : {false, true}) {
                    std::vector<double> ramp = rampOf(type);
                    const std::string bytes =
                        niftiOf(type, asBytes(type, ramp, is_big_endian), scale, is_big_endian);
                    const auto path = folder_ / (is_packed ? "a.nii.gz" : "a.nii");
                    writeBytes(path, is_packed ? deflated(bytes, DeflateHead::kGzip) : bytes);
                    for (double& value : ramp)
                        if (scale.applies) value = scale.slope * value + scale.intercept;
                    expectRamp(path, ramp, type.nrrd + std::string(" slope ") + std::to_string(scale.slope));
                }
    EXPECT_EQ(count_, 8 * 2 * 8 * 2);
}

// A float holds no whole numbers above 2^24, but what an offset makes of them.
TEST_F(PlainValues, ofNiftiWithALargeOffsetComeBack) {
    constexpr float kOffset = 1 << 30;
    const std::vector<double> ramp = rampOf(16, true);
    std::vector<double> stored = ramp;
    for (double& value : stored) value += double(kOffset);
    for (const Type& type : kTypes) {
        if (type.bytes < 4 || (type.is_float && type.bytes < 8)) continue;
        writeBytes(folder_ / "a.nii",
                   niftiOf(type, asBytes(type, stored, false), {1, -kOffset, true}, false));
        expectRamp(folder_ / "a.nii", ramp, type.nrrd);
    }
    EXPECT_GE(count_, 2);
}

TEST_F(PlainValues, ofNiftiComeBackWhateverItsNameSaysOfItsPacking) {
    const Type& type = kTypes[3];
    const std::string bytes = niftiOf(type, asBytes(type, rampOf(type), false), {1, 0, true}, false);
    writeBytes(folder_ / "plain.nii.gz", bytes);
    expectRamp(folder_ / "plain.nii.gz", rampOf(type), "not packed");
    std::string packed = deflated(bytes, DeflateHead::kGzip);
    writeBytes(folder_ / "packed.nii", packed);
    expectRamp(folder_ / "packed.nii", rampOf(type), "packed");
    packed[packed.size() - 6] ^= 1;  // of its checksum
    writeBytes(folder_ / "damaged.nii.gz", packed);
    expectRefused(folder_ / "damaged.nii.gz", {"damaged.nii.gz", "damaged"});
}

TEST_F(PlainValues, ofNiftiThatAreNoPlainNumbersAreRefused) {
    for (const char* datatype : {"\x20", "\x80", "\1"}) {  // complex, colour, bits
        std::string bytes = niftiOf(kTypes[3], std::string(120, 'x'), {1, 0, true}, false);
        bytes[70] = datatype[0];
        writeBytes(folder_ / "a.nii", bytes);
        expectRefused(folder_ / "a.nii", {"a.nii", "sample type", "not a plain number"});
    }
}

TEST_F(PlainValues, ofNiftiWithAnInterceptButNoSlopeAreRefused) {
    const Type& type = kTypes[3];
    for (const float slope : {0.0f, kNan}) {
        writeBytes(folder_ / "a.nii",
                   niftiOf(type, asBytes(type, rampOf(type), false), {slope, -1024, false}, false));
        expectRefused(folder_ / "a.nii", {"a.nii", "scl_slope", "scl_inter"});
    }
}

// One byte may fill up or end a line.
TEST_F(PlainValues, fewerBytesAreRefusedAndMoreAreSaid) {
    const Type& type = kTypes[3];
    const std::string bytes = asBytes(type, rampOf(type), false);
    const std::function<std::string(const std::string&)> writers[] = {
        [&](const std::string& b) { return nrrdOf(type, b, false, "raw"); },
        [&](const std::string& b) { return metaOf(type, b, false, false); },
        [&](const std::string& b) {
            return niftiOf(type, b, {1, 0, true}, false);
        }};
    const char* const names[] = {"a.nrrd", "a.mha", "a.nii"};
    for (size_t f = 0; f < std::size(names); ++f) {
        const auto path = folder_ / names[f];
        writeBytes(path, writers[f](bytes.substr(1)));
        expectRefused(path, {names[f], "119", "120"});
        writeBytes(path, writers[f](bytes + "\n"));
        EXPECT_EQ(importVolumeHere(path).description.find("more"), std::string::npos) << names[f];
        writeBytes(path, writers[f](bytes + std::string(30, 'x')));
        const std::string said = importVolumeHere(path).description;
        EXPECT_NE(said.find("30 bytes more than the header's sizes need (120)"), std::string::npos) << said;
    }
}

ImportOptions withSpacing() {
    ImportOptions options;
    options.spacing_mm = Eigen::Vector3d(1, 1, 1);
    return options;
}

class PictureValues : public PlainValues {
  protected:
    // A slice each.
    void write(const std::string& ending, const std::vector<double>& ramp,
               const std::function<std::string(const std::vector<double>&)>& bytes) {
        const auto size = ptrdiff_t(ramp.size() / kDepth);
        for (int k = 0; k < kDepth; ++k)
            writeBytes(folder_ / ("a" + std::to_string(k) + ending),
                       bytes({ramp.begin() + k * size, ramp.begin() + (k + 1) * size}));
    }
};

std::string pngOf(int bits, const std::vector<double>& values, char colour = 0,
                  const std::string& chunks = {}) {
    std::string rows;
    for (size_t n = 0; n < values.size(); ++n) {
        if (n % kColumns == 0) rows += '\0';
        rows += bigEndian(uint32_t(values[n]), bits == 16 ? 2 : 1);
    }
    const std::string head =
        bigEndian(kColumns, 4) + bigEndian(kRows, 4) + char(bits) + colour + std::string(3, '\0');
    return "\x89PNG\r\n\x1a\n" + pngChunk("IHDR", head) + chunks +
           pngChunk("IDAT", deflated(rows, DeflateHead::kZlib)) + pngChunk("IEND", "");
}

// Gamma, significant bits and a background are for displays.
TEST_F(PictureValues, ofPngComeBack) {
    const std::string gamma = pngChunk("gAMA", bigEndian(45455, 4));
    for (const int bits : {8, 16})
        for (const std::string& chunks :
             {std::string(), gamma, pngChunk("sBIT", bigEndian(uint32_t(bits - 4), 1)),
              pngChunk("bKGD", bigEndian(3, 2))}) {
            const std::vector<double> ramp = rampOf(bits, false);
            write(".png", ramp, [&](const auto& values) { return pngOf(bits, values, 0, chunks); });
            expectRamp(folder_.path(), ramp, "PNG " + std::to_string(bits) + chunks.substr(0, 8),
                       withSpacing());
        }
    EXPECT_EQ(count_, 2 * 4);
}

TEST_F(PictureValues, ofPngInFewBitsOrAPaletteAreRefused) {
    for (const int bits : {1, 2, 4}) {
        write(".png", rampOf(8, false), [&](const auto& values) { return pngOf(bits, values); });
        expectRefused(folder_.path(), {"a0.png", std::to_string(bits) + " bit", "8 or 16"}, withSpacing());
    }
    write(".png", rampOf(8, false),
          [&](const auto& values) { return pngOf(8, values, 3, pngChunk("PLTE", std::string(768, 'x'))); });
    expectRefused(folder_.path(), {"a0.png", "palette"}, withSpacing());
}

TEST_F(PictureValues, ofTiffComeBack) {
    for (const int photometric : {0, 1})
        for (const bool is_signed : {false, true})
            for (const int bits : {8, 16})
                for (const bool is_big_endian : {false, true})
                    for (const bool is_packed : {false, true})
                        for (const int rows_per_strip : {0, 1, 3, 4}) {  // 0: tiles
                            const std::vector<double> ramp = rampOf(bits, is_signed);
                            const TiffKind kind{.photometric = photometric,
                                                .bits = bits,
                                                .is_signed = is_signed,
                                                .is_big_endian = is_big_endian,
                                                .is_packed = is_packed,
                                                .rows_per_strip = rows_per_strip};
                            write(".tif", ramp,
                                  [&](const auto& values) { return tiffOf(kind, kColumns, values); });
                            expectRamp(folder_.path(), ramp,
                                       "TIFF " + std::to_string(bits) + " photometric " +
                                           std::to_string(photometric) + " rows " +
                                           std::to_string(rows_per_strip),
                                       withSpacing());
                        }
    EXPECT_EQ(count_, 2 * 2 * 2 * 2 * 2 * 4);
    const TiffKind white{.photometric = 0};
    write(".tif", rampOf(16, false), [&](const auto& values) { return tiffOf(white, kColumns, values); });
    const std::string said = importVolumeHere(folder_.path(), withSpacing()).description;
    EXPECT_NE(said.find("show as white"), std::string::npos) << said;
}

TEST_F(PictureValues, ofTiffThatIsNotPlainAreRefusedForWhatItIs) {
    const std::pair<TiffKind, const char*> kinds[] = {{{.photometric = 3}, "palette"},
                                                      {{.photometric = 2}, "colour"},
                                                      {{.photometric = 5}, "photometric"},
                                                      {{.samples = 2}, "transparent"},
                                                      {{.orientation = 4}, "orientation 4"},
                                                      {{.orientation = 6}, "orientation 6"},
                                                      {{.bits = 32}, "32 bit"},
                                                      {{.bits = 12}, "12 bit"},
                                                      {{.missing_bytes = 5}, "cannot be read"},
                                                      {{.rows_per_strip = 0, .missing_bytes = 5}, "bytes"},
                                                      {{.rows_per_strip = 4, .missing_bytes = 5}, "bytes"}};
    for (const auto& [kind, word] : kinds) {
        write(".tif", rampOf(16, false), [&](const auto& values) { return tiffOf(kind, kColumns, values); });
        SCOPED_TRACE(word + std::string(kind.rows_per_strip == 0 ? " in tiles" : " in strips"));
        expectRefused(folder_.path(), {".tif", word}, withSpacing());
    }
}

}  // namespace
}  // namespace bonemill
