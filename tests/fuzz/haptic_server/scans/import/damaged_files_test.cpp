// Small valid files of every format with random damage are imported or refused with UserError; nothing
// crashes, hangs or takes absurd amounts of memory. AddressSanitizer's build tries each damage; the others,
// which would see a part of what it sees, the first third. BONEMILL_FUZZ_SEED and BONEMILL_FUZZ_ROUNDS change
// what is tried.
#include <gtest/gtest.h>
#include <sys/resource.h>

#include <algorithm>
#include <cstdlib>
#include <iostream>
#include <random>

#include "common/base/user_error.h"
#include "haptic_server/scans/dicom/dicom_scan.h"
#include "haptic_server/scans/import/import_volume.h"
#include "tests/support/stl_writer.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/haptic_server/scans/import/archive_files.h"
#include "tests/unit/haptic_server/scans/import/dicom_bytes.h"
#include "tests/unit/haptic_server/scans/import/dicom_seg_bytes.h"
#include "tests/unit/haptic_server/scans/import/picture_files.h"
#include "tests/unit/haptic_server/scans/import/seg_nrrd.h"
#include "tests/unit/haptic_server/scans/import/volume_files.h"

#ifdef __SANITIZE_ADDRESS__
// ITK's readers and assimp lose what they hold when they refuse a file; the programs read in a child process
// that ends then.
extern "C" const char* __lsan_default_suppressions() {
    return "leak:libITK\nleak:libz.so\nleak:libassimp\n";
}
#endif

namespace bonemill {
namespace {

// Through the guard each round starts a process, and GDCM's absurd allocations take their time.
constexpr unsigned kDicomShare = 15;
#ifdef __SANITIZE_ADDRESS__
constexpr unsigned kRounds = 1500;
#else
constexpr unsigned kRounds = 500;
#endif

// Beyond this address space an allocation for files of a few hundred bytes is absurd and fails as
// std::bad_alloc. Sanitizers reserve terabytes for themselves and bring a limit of their own.
void limitMemory() {
#if !defined(__SANITIZE_ADDRESS__) && !defined(__SANITIZE_THREAD__)
    constexpr rlim_t kEnough = rlim_t(6) << 30;
    const rlimit limit{kEnough, kEnough};
    setrlimit(RLIMIT_AS, &limit);
#endif
}

unsigned numberFromEnvironment(const char* name, unsigned fallback) {
    const char* text = std::getenv(name);
    return text ? unsigned(std::strtoul(text, nullptr, 10)) : fallback;
}

using Random = std::mt19937;

size_t below(Random& random, size_t limit) {
    return std::uniform_int_distribution<size_t>(0, limit - 1)(random);
}

// Half of all damage goes to the first bytes, where the headers are.
size_t somePlace(Random& random, const std::string& bytes) {
    return below(random, below(random, 2) ? bytes.size() : std::min<size_t>(bytes.size(), 400));
}

void flipBits(Random& random, std::string& bytes) {
    for (size_t n = below(random, 8) + 1; n > 0; --n)
        bytes[somePlace(random, bytes)] ^= char(1 << below(random, 8));
}

void truncate(Random& random, std::string& bytes) {
    bytes.resize(below(random, bytes.size()));
}

void overwriteWithExtremes(Random& random, std::string& bytes) {
    const char extremes[] = {char(0xff), 0x7f, char(0x80), 0, '9', '-'};
    const char byte = extremes[below(random, sizeof extremes)];
    const size_t first = somePlace(random, bytes),
                 count = std::min(below(random, 9) + 1, bytes.size() - first);
    for (size_t n = 0; n < count; ++n) bytes[first + n] = byte;
}

void moveBlock(Random& random, std::string& bytes) {
    const size_t from = somePlace(random, bytes),
                 count = std::min(below(random, 64) + 1, bytes.size() - from);
    const std::string block = bytes.substr(from, count);
    bytes.insert(somePlace(random, bytes), block);
}

// A number in a text header becomes another one.
void replaceDigits(Random& random, std::string& bytes) {
    const char* numbers[] = {"0", "-1", "99999999999", "1e300", "nan", "4294967297", ""};
    const size_t digit = bytes.find_first_of("0123456789", somePlace(random, bytes));
    if (digit == std::string::npos) return;
    bytes.replace(digit, 1, numbers[below(random, 7)]);
}

std::string damaged(Random& random, std::string bytes) {
    void (*const kinds[])(Random&, std::string&) = {flipBits, truncate, overwriteWithExtremes, moveBlock,
                                                    replaceDigits};
    kinds[below(random, 5)](random, bytes);
    return bytes;
}

using Import = RawVolume(const std::filesystem::path&, const ImportOptions&);

void importOrRefuse(Import import, const std::filesystem::path& path) {
    try {
        const RawVolume raw = import(path, {});
        EXPECT_EQ(raw.values.size(), raw.geometry.voxelCount());
        EXPECT_TRUE(raw.geometry.X_WV.isFinite());
        EXPECT_TRUE(raw.geometry.spacing.allFinite() && raw.geometry.spacing.minCoeff() > 0);
    } catch (const UserError& error) {
        EXPECT_EQ(std::string(error.what()).find('\n'), std::string::npos) << error.what();
    }
}

class DamagedFiles : public ::testing::Test {
  protected:
    static void SetUpTestSuite() { limitMemory(); }

    // Damages file `name` of the folder again and again, and imports `entry`.
    void fuzz(Import import, const std::string& name, const std::string& entry, unsigned share = 1) {
        const unsigned seed = numberFromEnvironment("BONEMILL_FUZZ_SEED", 20240612);
        const unsigned rounds = numberFromEnvironment("BONEMILL_FUZZ_ROUNDS", kRounds / share);
        std::cout << "seed " << seed << ", " << rounds << " rounds of " << name << "\n";
        const std::string intact = readBytes(folder_ / name);
        ASSERT_FALSE(intact.empty());
        ASSERT_NO_THROW(import(folder_ / entry, {}));
        for (unsigned round = 0; round < rounds; ++round) {
            SCOPED_TRACE("seed " + std::to_string(seed) + " round " + std::to_string(round));
            Random random(seed + round);
            writeBytes(folder_ / name, damaged(random, intact));
            ASSERT_NO_THROW(scanDicomFile(folder_ / name));
            ASSERT_NO_THROW(importOrRefuse(import, folder_ / entry));
        }
    }
    // The readers run in this very process, so that one that crashes ends the test.
    void fuzz(const std::string& name) { fuzz(importVolumeHere, name, name); }

    test::TemporaryFolder folder_;
    const SampleVolume sample_;
};

TEST_F(DamagedFiles, nrrd) {
    writeNrrdFile(folder_ / "a.nrrd", sample_, {});
    fuzz("a.nrrd");
}

TEST_F(DamagedFiles, nrrdGzip) {
    writeNrrdFile(folder_ / "a.nrrd", sample_, {.is_compressed = true});
    fuzz("a.nrrd");
}

TEST_F(DamagedFiles, nrrdDetached) {
    writeNrrdFile(folder_ / "a.nhdr", sample_, {.is_big_endian = true, .is_detached = true});
    fuzz("a.nhdr");
}

TEST_F(DamagedFiles, nifti) {
    writeNiftiFile(folder_ / "a.nii", sample_, {});
    fuzz("a.nii");
}

TEST_F(DamagedFiles, niftiGzip) {
    writeNiftiFile(folder_ / "a.nii.gz", sample_, {.is_compressed = true});
    fuzz("a.nii.gz");
}

TEST_F(DamagedFiles, metaImage) {
    writeMetaImageFile(folder_ / "a.mha", sample_, {});
    fuzz("a.mha");
}

TEST_F(DamagedFiles, metaImageCompressed) {
    writeMetaImageFile(folder_ / "a.mha", sample_, {.is_compressed = true});
    fuzz("a.mha");
}

TEST_F(DamagedFiles, metaImageDetached) {
    writeMetaImageFile(folder_ / "a.mhd", sample_, {.is_detached = true});
    fuzz("a.mhd");
}

TEST_F(DamagedFiles, inv3) {
    writeInv3File(folder_ / "a.inv3", sample_, {});
    fuzz("a.inv3");
}

// They are unpacked by a process of their own, and what comes of it is read by another one.
TEST_F(DamagedFiles, archives) {
    writeNrrdFile(folder_ / "ct.nrrd", sample_, {});
    for (const char* const name : {"a.zip", "a.tar", "a.tar.gz", "a.tar.xz"}) {
        writeArchive(folder_ / name, {{"readme.txt", "x"}, {"scan/ct.nrrd", readBytes(folder_ / "ct.nrrd")}});
        fuzz(importVolume, name, name, 4 * kDicomShare);
    }
}

TEST_F(DamagedFiles, segments) {
    const auto label = [](const Eigen::Vector3i& v, int layer) { return v.x() > layer; };
    writeSegNrrd(folder_ / "a.seg.nrrd",
                 {.layers = 2,
                  .segments = segmentLines(0, "nerve", 1, 0) + segmentLines(1, "canal", 1, 1),
                  .label = label});
    fuzz("a.seg.nrrd");
}

// libpng ends the process that reads a damaged file, so that folders of pictures are imported through the
// guard.
RawVolume importStack(const std::filesystem::path& path, const ImportOptions& options) {
    ImportOptions with_spacing = options;
    with_spacing.spacing_mm = Eigen::Vector3d(1, 1, 1);
    return importVolume(path, with_spacing);
}

TEST_F(DamagedFiles, pngSlice) {
    for (int k = 0; k < 3; ++k) writeBytes(folder_ / ("a" + std::to_string(k) + ".png"), png({}));
    fuzz(importStack, "a1.png", "", kDicomShare);
}

TEST_F(DamagedFiles, tiffSlice) {
    for (int k = 0; k < 3; ++k) writeBytes(folder_ / ("a" + std::to_string(k) + ".tif"), tiff({}));
    fuzz(importStack, "a1.tif", "", kDicomShare);
}

// Such a file is damaged in few places that change the surface and leave it closed.
constexpr unsigned kSurfaceShare = 5;

TEST_F(DamagedFiles, stl) {
    writeBytes(folder_ / "a.stl", test::textStl(test::boxSoup({0, 0, 0}, {40, 4, 4})));
    fuzz(importVolumeHere, "a.stl", "a.stl", kSurfaceShare);
}

// The library's reader of PLY crashes on damaged files.
TEST_F(DamagedFiles, ply) {
    writeBytes(
        folder_ / "a.ply",
        "ply\nformat ascii 1.0\nelement vertex 4\nproperty float x\nproperty float y\nproperty float z\n"
        "element face 4\nproperty list uchar int vertex_indices\nend_header\n0 0 0\n8 0 0\n0 8 0\n0 0 8\n"
        "3 0 2 1\n3 0 1 3\n3 0 3 2\n3 1 2 3\n");
    fuzz(importVolume, "a.ply", "a.ply", kSurfaceShare);
}

// GDCM asserts on damaged files, so DICOM is imported as the programs do it, through the guard; our own scan
// of the elements, which runs first, is tried in this process.
DicomImage smallSlice(int k) {
    DicomImage image;
    image.position = "0\\0\\" + std::to_string(k);
    image.pixels.assign(20, int16_t(k * 100));
    return image;
}

TEST_F(DamagedFiles, dicomSlice) {
    for (int k = 0; k < 3; ++k) writeDicomFile(folder_ / ("slice" + std::to_string(k)), smallSlice(k));
    fuzz(importVolume, "slice1", "", kDicomShare);
}

TEST_F(DamagedFiles, dicomSliceThatNamesItsSeries) {
    for (int k = 0; k < 5; ++k) writeDicomFile(folder_ / ("slice" + std::to_string(k)), smallSlice(k));
    fuzz(importVolume, "slice1", "slice1", 2 * kDicomShare);
}

RawVolume listOnly(const std::filesystem::path& path, const ImportOptions&) {
    for (const std::string& line : listSeries(path))
        EXPECT_TRUE(std::ranges::all_of(line, [](char c) { return c >= ' ' && c <= '~'; })) << line;
    return {};
}

TEST_F(DamagedFiles, dicomListed) {
    for (int k = 0; k < 5; ++k) {
        DicomImage image = smallSlice(k);
        image.series_description = "description";
        image.image_type = "ORIGINAL\\PRIMARY";
        image.kernel = "B70f";
        writeDicomFile(folder_ / ("slice" + std::to_string(k)), image);
    }
    fuzz(listOnly, "slice1", "", 2 * kDicomShare);
}

TEST_F(DamagedFiles, dicomMultiFrame) {
    DicomImage image = smallSlice(0);
    image.pixels.assign(60, 5);
    image.frame_positions = {"0\\0\\0", "0\\0\\1", "0\\0\\2"};
    image.frame_rescales = {"1|-1024", "2|0", "0.5|-1024"};
    writeDicomFile(folder_ / "a.dcm", image);
    fuzz(importVolume, "a.dcm", "a.dcm", kDicomShare);
}

// Two segments that overlap, on three slices.
DicomSegmentation smallSegmentation(const std::string& type) {
    DicomSegmentation file{.type = type,
                           .character_set = "ISO_IR 100",
                           .spacing_between = "1",
                           .thickness = "1",
                           .most_fraction = 2,
                           .segments = {{1, "nerve", {40000, 30000, 20000}}, {2, "canal"}},
                           .frames = {}};
    for (int k = 0; k < 3; ++k)
        for (const int segment : {1, 2})
            file.frames.push_back({segment,
                                   "0\\0\\" + std::to_string(k),
                                   {1, 0, 1, 1, 0, 1, uint8_t(segment == 2), 0, 1, 1, 0, 0}});
    return file;
}

TEST_F(DamagedFiles, dicomSegBinary) {
    writeDicomSeg(folder_ / "a.dcm", smallSegmentation("BINARY"));
    fuzz(importVolume, "a.dcm", "a.dcm", kDicomShare);
}

TEST_F(DamagedFiles, dicomSegFractional) {
    writeDicomSeg(folder_ / "a.dcm", smallSegmentation("FRACTIONAL"));
    fuzz(importVolume, "a.dcm", "a.dcm", 2 * kDicomShare);
}

}  // namespace
}  // namespace bonemill
