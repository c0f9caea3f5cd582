// Every sample of NRRD, NIfTI and MetaImage must lie where the format's definition puts it.
#include <gtest/gtest.h>

#include <cmath>
#include <limits>

#include "haptic_server/volume/import/import_volume.h"
#include "haptic_server/volume/import/nrrd_writer.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/volume_import/expect_user_error.h"
#include "tests/unit/volume_import/volume_files.h"

namespace bonemill {
namespace {

SampleVolume rotatedSample() {
    SampleVolume sample;
    sample.directions = (Eigen::AngleAxisd(0.5, Eigen::Vector3d(1, 2, 3).normalized())).toRotationMatrix();
    return sample;
}

SampleVolume leftHandedSample() {
    SampleVolume sample = rotatedSample();
    sample.directions.col(0) = -sample.directions.col(0);
    return sample;
}

// Its axes are in another order: posterior, inferior, right.
SampleVolume permutedSample() {
    SampleVolume sample;
    sample.directions << 0, 0, -1, 1, 0, 0, 0, -1, 0;
    return sample;
}

const Storage kStorages[] = {{false, false, false}, {true, false, false}, {false, true, false},
                             {true, true, false},   {false, false, true}, {false, true, true}};

void expectProperRotation(const RawVolume& raw) {
    EXPECT_NEAR(raw.geometry.X_WV.rotation.toRotationMatrix().determinant(), 1, 1e-12);
}

TEST(Nrrd, everyStorageAndEveryHandednessKeepsItsPlaces) {
    const test::TemporaryFolder folder;
    for (const auto& sample : {SampleVolume(), rotatedSample(), leftHandedSample(), permutedSample()})
        for (const Storage& storage : kStorages) {
            const auto path = folder / (storage.is_detached ? "a.nhdr" : "a.nrrd");
            writeNrrdFile(path, sample, storage);
            const RawVolume raw = importVolume(path);
            EXPECT_NO_THROW(expectSamePlaces(raw, sample));
            expectProperRotation(raw);
        }
}

TEST(Nrrd, rightAnteriorSuperiorBecomesLps) {
    const test::TemporaryFolder folder;
    const SampleVolume lps = rotatedSample();
    SampleVolume ras = lps;
    const Eigen::Vector3d flip(-1, -1, 1);
    ras.directions = flip.asDiagonal() * lps.directions;
    ras.origin_mm = flip.asDiagonal() * lps.origin_mm;
    writeNrrdFile(folder / "a.nrrd", ras, {}, "right-anterior-superior");
    EXPECT_NO_THROW(expectSamePlaces(importVolume(folder / "a.nrrd"), lps));
}

TEST(Nrrd, aSpaceThatIsNoPatientsIsToldApart) {
    const test::TemporaryFolder folder;
    for (const auto& [space, lacks] :
         {std::pair("left-posterior-superior", false), std::pair("LPS", false), std::pair("RAS", false),
          std::pair("scanner-xyz", true), std::pair("3D-right-handed", true)}) {
        writeNrrdFile(folder / "a.nrrd", SampleVolume(), {}, space);
        EXPECT_EQ(importVolume(folder / "a.nrrd").lacks_patient_axes, lacks) << space;
    }
}

TEST(Nifti, withoutQformAndSformNothingIsKnownOfThePatient) {
    const test::TemporaryFolder folder;
    writeNiftiFile(folder / "a.nii", SampleVolume(), {});
    EXPECT_FALSE(importVolume(folder / "a.nii").lacks_patient_axes);
    std::string bytes = readBytes(folder / "a.nii");
    std::fill_n(bytes.begin() + 252, 4, '\0');  // qform_code and sform_code
    writeBytes(folder / "a.nii", bytes);
    EXPECT_TRUE(importVolume(folder / "a.nii").lacks_patient_axes);
}

TEST(Nrrd, leftHandedFileIsSaidToBeFlipped) {
    const test::TemporaryFolder folder;
    writeNrrdFile(folder / "a.nrrd", leftHandedSample(), {});
    EXPECT_NE(importVolume(folder / "a.nrrd").description.find("reversed"), std::string::npos);
}

TEST(Nrrd, spaceUnitsAreHonoured) {
    const test::TemporaryFolder folder;
    SampleVolume sample;
    writeNrrdFile(folder / "a.nrrd", sample, {});
    std::string bytes = readBytes(folder / "a.nrrd");
    bytes.insert(bytes.find("endian:"), "space units: \"cm\" \"cm\" \"cm\"\n");
    writeBytes(folder / "b.nrrd", bytes);
    sample.spacing_mm *= 10;
    sample.origin_mm *= 10;
    EXPECT_NO_THROW(expectSamePlaces(importVolume(folder / "b.nrrd"), sample));
    bytes.replace(bytes.find("\"cm\""), 4, "\"parsec\"");
    writeBytes(folder / "c.nrrd", bytes);
    expectUserError([&] { importVolume(folder / "c.nrrd"); }, {"c.nrrd", "parsec", "mm"});
}

TEST(Nrrd, oldFileWithSpacingsOnlyIsRead) {
    const test::TemporaryFolder folder;
    SampleVolume sample;
    sample.origin_mm.setZero();
    writeNrrdFile(folder / "a.nrrd", sample, {});
    const std::string bytes = readBytes(folder / "a.nrrd");
    const std::string data = bytes.substr(bytes.find("\n\n") + 2);
    writeBytes(folder / "b.nrrd",
               "NRRD0001\ntype: short\ndimension: 3\nsizes: 5 4 3\nspacings: 0.5 0.75 1.25\nendian: little\n"
               "encoding: raw\n\n" +
                   data);
    EXPECT_NO_THROW(expectSamePlaces(importVolume(folder / "b.nrrd"), sample));
}

TEST(Nifti, everyStorageAndEveryHandednessKeepsItsPlaces) {
    const test::TemporaryFolder folder;
    for (const auto& sample : {SampleVolume(), rotatedSample(), leftHandedSample(), permutedSample()})
        for (const Storage& storage : kStorages) {
            if (storage.is_detached) continue;
            const auto path = folder / (storage.is_compressed ? "a.nii.gz" : "a.nii");
            writeNiftiFile(path, sample, storage);
            const RawVolume raw = importVolume(path);
            EXPECT_NO_THROW(expectSamePlaces(raw, sample, 1e-8));  // the header holds float
            expectProperRotation(raw);
        }
}

TEST(MetaImage, everyStorageAndEveryHandednessKeepsItsPlaces) {
    const test::TemporaryFolder folder;
    for (const auto& sample : {SampleVolume(), rotatedSample(), leftHandedSample(), permutedSample()})
        for (const Storage& storage : kStorages) {
            const auto path = folder / (storage.is_detached ? "a.mhd" : "a.mha");
            writeMetaImageFile(path, sample, storage);
            const RawVolume raw = importVolume(path);
            EXPECT_NO_THROW(expectSamePlaces(raw, sample));
            expectProperRotation(raw);
        }
}

TEST(Formats, permutedAxesGiveAnExactRotation) {
    const test::TemporaryFolder folder;
    writeNrrdFile(folder / "a.nrrd", permutedSample(), {});
    const Eigen::Matrix3d R = importVolume(folder / "a.nrrd").geometry.X_WV.rotation.toRotationMatrix();
    const Eigen::Matrix3d rounded = R.array().round();
    EXPECT_LT((R - rounded).cwiseAbs().maxCoeff(), 1e-15);
}

TEST(Formats, nonFiniteValuesPassAndAreCounted) {
    const test::TemporaryFolder folder;
    VolumeGeometry geometry;
    geometry.dims = {3, 3, 3};
    geometry.spacing.setConstant(1e-3);
    std::vector<float> values(27, 1.0f);
    values[4] = std::numeric_limits<float>::quiet_NaN();
    values[5] = std::numeric_limits<float>::infinity();
    writeNrrd(folder / "a.nrrd", geometry, std::span<const float>(values));
    const RawVolume raw = importVolume(folder / "a.nrrd");
    EXPECT_TRUE(std::isnan(raw.values[4]));
    EXPECT_TRUE(std::isinf(raw.values[5]));
    EXPECT_NE(raw.description.find("2 values are not finite"), std::string::npos) << raw.description;
}

}  // namespace
}  // namespace bonemill
