#include <gtest/gtest.h>

#include "haptic_server/scans/import/import_volume.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/haptic_server/scans/import/expect_user_error.h"
#include "tests/unit/haptic_server/scans/import/volume_files.h"

namespace bonemill {
namespace {

TEST(Inv3, matrixIsReadWithItsRowsTurnedRound) {
    const test::TemporaryFolder folder;
    SampleVolume sample;
    sample.origin_mm.setZero();
    writeInv3File(folder / "a.inv3", sample, {});
    const RawVolume raw = importVolume(folder / "a.inv3");
    EXPECT_NO_THROW(expectSamePlaces(raw, sample));
    EXPECT_NE(raw.description.find("window level 100 width 400"), std::string::npos) << raw.description;
}

TEST(Inv3, otherSampleTypesAreRefused) {
    const test::TemporaryFolder folder;
    writeInv3File(folder / "a.inv3", SampleVolume(), {.dtype = "float64"});
    expectUserError([&] { importVolume(folder / "a.inv3"); }, {"a.inv3", "float64", "int16"});
}

TEST(Inv3, matrixOfTheWrongSizeIsRefused) {
    const test::TemporaryFolder folder;
    writeInv3File(folder / "a.inv3", SampleVolume(), {.missing_bytes = 2});
    expectUserError([&] { importVolume(folder / "a.inv3"); }, {"a.inv3", "matrix.dat"});
}

TEST(Inv3, cutShortArchiveIsRefused) {
    const test::TemporaryFolder folder;
    writeInv3File(folder / "a.inv3", SampleVolume(), {});
    const std::string bytes = readBytes(folder / "a.inv3");
    writeBytes(folder / "a.inv3", bytes.substr(0, bytes.size() / 2));
    expectUserError([&] { importVolume(folder / "a.inv3"); }, {"a.inv3"});
}

// The example of the Debian package invesalius-examples is read where it is installed: it is a head, so bone
// is in the upper half of the lowest slices' front (teeth) and air above the vertex.
TEST(Inv3, debianCraniumIsAHeadInLps) {
    const std::filesystem::path path = "/usr/share/doc/invesalius-examples/examples/Cranium.inv3";
    if (!std::filesystem::exists(path)) GTEST_SKIP() << "invesalius-examples is not installed";
    const RawVolume raw = importVolume(path);
    EXPECT_EQ(raw.geometry.dims, Eigen::Vector3i(256, 256, 108));
    EXPECT_NEAR(raw.geometry.spacing.x(), 0.9570312e-3, 1e-12);
    EXPECT_NEAR(raw.geometry.spacing.z(), 1.5e-3, 1e-12);
    EXPECT_TRUE(raw.is_hounsfield);
    const auto at = [&](int i, int j, int k) { return raw.values[size_t(i + 256 * (j + 256 * k))]; };
    // These are the outermost soft tissue along the middle of the face and of the back of the head, at the
    // height of the nose.
    int front = 0, back = 255;
    while (at(128, front, 20) < -300) ++front;
    while (at(128, back, 20) < -300) --back;
    int bone_front = front, bone_back = back;
    while (at(128, bone_front, 20) < 300) ++bone_front;
    while (at(128, bone_back, 20) < 300) --bone_back;
    EXPECT_GT(bone_front - front, back - bone_back) << "the nose lies in front: y must run backwards";
    double top = 0, bottom = 0;
    for (size_t n = 0; n < 256 * 256; ++n) {
        bottom += raw.values[n] > -300;
        top += raw.values[n + size_t(107) * 256 * 256] > -300;
    }
    EXPECT_LT(top, bottom / 2) << "the vertex is the narrow end: z must run upwards";
}

}  // namespace
}  // namespace bonemill
