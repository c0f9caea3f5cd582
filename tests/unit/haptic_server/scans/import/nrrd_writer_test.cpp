#include "haptic_server/scans/nrrd/nrrd_writer.h"

#include <gtest/gtest.h>

#include <random>

#include "haptic_server/scans/import/import_volume.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/write_nrrd.h"
#include "tests/unit/haptic_server/scans/import/expect_user_error.h"
#include "tests/unit/haptic_server/scans/import/volume_files.h"

namespace bonemill {
namespace {

VolumeGeometry randomGeometry(std::mt19937& random) {
    std::uniform_real_distribution<double> number(-1, 1);
    VolumeGeometry geometry;
    geometry.dims = {4, 3, 2};
    geometry.spacing = Eigen::Vector3d(number(random), number(random), number(random)).cwiseAbs() * 1e-3 +
                       Eigen::Vector3d::Constant(1e-4);
    geometry.X_WV.position = {number(random), number(random), number(random)};
    geometry.X_WV.rotation =
        Eigen::Quaterniond(number(random), number(random), number(random), number(random)).normalized();
    return geometry;
}

void expectBitEqual(const VolumeGeometry& a, const VolumeGeometry& b) {
    EXPECT_EQ(a.dims, b.dims);
    EXPECT_EQ(a.spacing, b.spacing);
    EXPECT_EQ(a.X_WV.position, b.X_WV.position);
    EXPECT_EQ(a.X_WV.rotation.coeffs(), b.X_WV.rotation.coeffs());
}

template <class T>
void expectRoundTrip(const VolumeGeometry& geometry) {
    const test::TemporaryFolder folder;
    std::vector<T> values;
    for (size_t n = 0; n < geometry.voxelCount(); ++n) values.push_back(T(n * 9 + 1));
    writeNrrd(folder / "a.nrrd", geometry, std::span<const T>(values));
    // Another program may unpack what it stores again.
    std::string header = readBytes(folder / "a.nrrd");
    header.resize(header.find("\n\n") + 2);
    const std::string packed = "encoding: gzip";
    ASSERT_NE(header.find(packed), std::string::npos);
    header.replace(header.find(packed), packed.size(), "encoding: raw");
    writeBytes(folder / "raw.nrrd",
               header + std::string(reinterpret_cast<const char*>(values.data()), values.size() * sizeof(T)));
    for (const char* file : {"a.nrrd", "raw.nrrd"}) {
        const RawVolume raw = importVolume(folder / file);
        expectBitEqual(raw.geometry, geometry);
        for (size_t n = 0; n < values.size(); ++n) ASSERT_EQ(raw.values[n], float(values[n]));
    }
}

TEST(NrrdWriter, geometryAndValuesComeBackBitForBit) {
    std::mt19937 random(3);
    for (int n = 0; n < 50; ++n) {
        const VolumeGeometry geometry = randomGeometry(random);
        expectRoundTrip<uint8_t>(geometry);
        expectRoundTrip<uint16_t>(geometry);
        expectRoundTrip<float>(geometry);
    }
}

// Another program may change the standard fields and keep the key it does not know.
TEST(NrrdWriter, changedStandardFieldsWinOverTheKey) {
    const test::TemporaryFolder folder;
    VolumeGeometry geometry;
    geometry.dims = {4, 3, 2};
    geometry.spacing.setConstant(0.5e-3);
    const std::vector<uint8_t> values(24, 1);
    writeNrrd(folder / "a.nrrd", geometry, std::span<const uint8_t>(values));
    std::string bytes = readBytes(folder / "a.nrrd");
    const std::string origin = "space origin: (0,0,0)";
    ASSERT_NE(bytes.find(origin), std::string::npos);
    bytes.replace(bytes.find(origin), origin.size(), "space origin: (7,0,0)");
    writeBytes(folder / "a.nrrd", bytes);
    EXPECT_NEAR(importVolume(folder / "a.nrrd").geometry.X_WV.position.x(), 7e-3, 1e-15);
}

TEST(NrrdWriter, densitiesAreWrittenWithoutTheBorder) {
    const test::TemporaryFolder folder;
    VolumeGeometry geometry;
    geometry.dims = {3, 3, 3};
    geometry.spacing.setConstant(1e-3);
    VoxelVolume volume(geometry, 100);
    volume.set(2, 1, 0, 40000);
    writeNrrd(folder / "a.nrrd", volume);
    const RawVolume raw = importVolume(folder / "a.nrrd");
    for (size_t n = 0; n < raw.values.size(); ++n) EXPECT_EQ(raw.values[n], n == 2 + 3 ? 40000 : 0);
}

TEST(NrrdWriter, valuesThatComeInPartsAreOneVolume) {
    const test::TemporaryFolder folder;
    VolumeGeometry geometry;
    geometry.dims = {300, 200, 3};
    std::vector<uint16_t> values;
    for (size_t n = 0; n < geometry.voxelCount(); ++n) values.push_back(uint16_t(n * n));
    NrrdStream<uint16_t> file(folder / "a.nrrd", geometry);
    const std::span<const uint16_t> all(values);
    for (size_t begin = 0; begin < all.size(); begin += 7001)
        file.append(all.subspan(begin, std::min<size_t>(7001, all.size() - begin)));
    file.close();
    const RawVolume raw = importVolume(folder / "a.nrrd");
    for (size_t n = 0; n < values.size(); ++n) ASSERT_EQ(raw.values[n], values[n]) << n;
}

TEST(NrrdWriter, wrongNumberOfValuesIsRefused) {
    const test::TemporaryFolder folder;
    VolumeGeometry geometry;
    geometry.dims = {2, 2, 2};
    for (const size_t count : {7, 9}) {
        const std::vector<uint8_t> values(count, 1);
        expectUserError([&] { writeNrrd(folder / "a.nrrd", geometry, std::span<const uint8_t>(values)); },
                        {"a.nrrd", "too few or too many"});
    }
}

TEST(NrrdWriter, unwritablePathIsNamed) {
    VolumeGeometry geometry;
    geometry.dims = {2, 2, 2};
    const std::vector<uint8_t> values(8, 1);
    expectUserError([&] { writeNrrd("/nonexistent/a.nrrd", geometry, std::span<const uint8_t>(values)); },
                    {"/nonexistent/a.nrrd"});
}

}  // namespace
}  // namespace bonemill
