// Every sample of NRRD, NIfTI and MetaImage must lie where the format's definition puts it.
#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "haptic_server/scans/import/import_volume.h"
#include "tests/support/temporary_folder.h"
#include "tests/support/write_nrrd.h"
#include "tests/unit/haptic_server/scans/import/expect_user_error.h"
#include "tests/unit/haptic_server/scans/import/volume_files.h"

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

// The sample's values plus 1 as that type, which the file scales back by a half and an intercept.
template <class T>
void writeScaledNifti(const std::filesystem::path& path, int16_t datatype) {
    const SampleVolume sample;
    writeNiftiFile(path, sample, {});
    std::string bytes = readBytes(path).substr(0, 352);
    const auto put = [&bytes](size_t offset, auto value) {
        std::memcpy(bytes.data() + offset, &value, sizeof value);
    };
    put(70, datatype), put(72, int16_t(8 * sizeof(T))), put(112, 4.0f), put(116, -1000.0f);
    for (const int16_t value : sample.values()) {
        const T stored = T(value / 4);
        bytes.append(reinterpret_cast<const char*>(&stored), sizeof stored);
    }
    writeBytes(path, bytes);
}

TEST(Nifti, valuesOfEveryTypeAreScaled) {
    const test::TemporaryFolder folder;
    const auto expectScaled = [&](const char* name) {
        const RawVolume raw = importVolume(folder / name);
        const std::vector<int16_t> values = SampleVolume().values();
        ASSERT_EQ(raw.values.size(), values.size()) << name;
        for (size_t n = 0; n < values.size(); ++n)
            ASSERT_EQ(raw.values[n], float(values[n] / 4 * 4 - 1000)) << name << ", sample " << n;
    };
    writeScaledNifti<uint8_t>(folder / "u8.nii", 2), expectScaled("u8.nii");
    writeScaledNifti<int8_t>(folder / "i8.nii", 256), expectScaled("i8.nii");
    writeScaledNifti<int16_t>(folder / "i16.nii", 4), expectScaled("i16.nii");
    writeScaledNifti<uint16_t>(folder / "u16.nii", 512), expectScaled("u16.nii");
    writeScaledNifti<int32_t>(folder / "i32.nii", 8), expectScaled("i32.nii");
    writeScaledNifti<uint32_t>(folder / "u32.nii", 768), expectScaled("u32.nii");
    writeScaledNifti<int64_t>(folder / "i64.nii", 1024), expectScaled("i64.nii");
    writeScaledNifti<uint64_t>(folder / "u64.nii", 1280), expectScaled("u64.nii");
    writeScaledNifti<float>(folder / "f32.nii", 16), expectScaled("f32.nii");
    writeScaledNifti<double>(folder / "f64.nii", 64), expectScaled("f64.nii");
}

TEST(Nifti, aScaleThatIsNoNumberIsRefused) {
    const test::TemporaryFolder folder;
    writeNiftiFile(folder / "a.nii", SampleVolume(), {});
    std::string bytes = readBytes(folder / "a.nii");
    const float infinity = std::numeric_limits<float>::infinity(),
                nan = std::numeric_limits<float>::quiet_NaN();
    std::memcpy(bytes.data() + 112, &infinity, 4);
    writeBytes(folder / "a.nii", bytes);
    expectUserError([&] { importVolume(folder / "a.nii"); }, {"a.nii", "scl_slope"});
    writeNiftiFile(folder / "b.nii", SampleVolume(), {});
    bytes = readBytes(folder / "b.nii");
    std::memcpy(bytes.data() + 116, &nan, 4);
    writeBytes(folder / "b.nii", bytes);
    expectUserError([&] { importVolume(folder / "b.nii"); }, {"b.nii", "scl_inter"});
}

// The file's sform goes, and a qform of the same place comes: no turn, and the first two axes reversed by a
// half turn about the third.
std::string withQform(std::string bytes, const SampleVolume& sample, bool keeps_sform) {
    const auto put = [&bytes](size_t offset, auto value) {
        std::memcpy(bytes.data() + offset, &value, sizeof value);
    };
    put(252, int16_t(1)), put(254, int16_t(keeps_sform));
    put(256, 0.0f), put(260, 0.0f), put(264, 1.0f);
    put(268, float(-sample.origin_mm.x())), put(272, float(-sample.origin_mm.y()));
    put(276, float(sample.origin_mm.z()));
    return bytes;
}

TEST(Nifti, theQformIsTakenWhereThereIsNoSform) {
    const test::TemporaryFolder folder;
    const SampleVolume sample;
    writeNiftiFile(folder / "a.nii", sample, {});
    writeBytes(folder / "b.nii", withQform(readBytes(folder / "a.nii"), sample, false));
    EXPECT_NO_THROW(expectSamePlaces(importVolume(folder / "b.nii"), sample, 1e-8));
}

TEST(Nifti, theSformIsTakenAndADisagreeingQformIsTold) {
    const test::TemporaryFolder folder;
    SampleVolume sample;
    writeNiftiFile(folder / "a.nii", sample, {});
    const std::string bytes = readBytes(folder / "a.nii");
    writeBytes(folder / "same.nii", withQform(bytes, sample, true));
    EXPECT_EQ(importVolume(folder / "same.nii").description.find("qform"), std::string::npos);
    SampleVolume elsewhere = sample;
    elsewhere.origin_mm.z() += 7;
    writeBytes(folder / "b.nii", withQform(bytes, elsewhere, true));
    const RawVolume raw = importVolume(folder / "b.nii");
    EXPECT_NO_THROW(expectSamePlaces(raw, sample, 1e-8));
    EXPECT_NE(raw.description.find("up to 7.0 mm apart: the sform is taken"), std::string::npos)
        << raw.description;
}

TEST(Nifti, aShearedSformIsRefused) {
    const test::TemporaryFolder folder;
    SampleVolume sample;
    sample.directions.col(2) = Eigen::Vector3d(0, 0.5, std::sqrt(0.75));
    writeNiftiFile(folder / "a.nii", sample, {});
    expectUserError([&] { importVolume(folder / "a.nii"); }, {"a.nii", "not perpendicular"});
    writeBytes(folder / "b.nii", withQform(readBytes(folder / "a.nii"), sample, true));
    expectUserError([&] { importVolume(folder / "b.nii"); }, {"b.nii", "not perpendicular"});
}

TEST(Nifti, lengthsInMetresAndMicrometresAreTurnedIntoOurs) {
    const test::TemporaryFolder folder;
    for (const auto& [code, mm] : {std::pair('\1', 1000.0), std::pair('\3', 1e-3)})
        for (const double smaller : {10.0, mm}) {
            SampleVolume stored, meant;
            stored.spacing_mm /= smaller, stored.origin_mm /= smaller;
            meant.spacing_mm = mm * stored.spacing_mm, meant.origin_mm = mm * stored.origin_mm;
            writeNiftiFile(folder / "a.nii", stored, {});
            std::string bytes = readBytes(folder / "a.nii");
            bytes[123] = code;
            writeBytes(folder / "a.nii", bytes);
            EXPECT_NO_THROW(expectSamePlaces(importVolume(folder / "a.nii"), meant, 1e-6 * mm / smaller * 10))
                << mm << " " << smaller;
        }
}

TEST(Formats, aVoxelOfNoSizeIsRefused) {
    const test::TemporaryFolder folder;
    writeNrrdFile(folder / "a.nrrd", SampleVolume(), {});
    const std::string bytes = readBytes(folder / "a.nrrd");
    const std::string data = bytes.substr(bytes.find("\n\n") + 2);
    const std::string head =
        "NRRD0004\ntype: short\ndimension: 3\nsizes: 5 4 3\nendian: little\nencoding: raw\n";
    writeBytes(folder / "none.nrrd", head + "\n" + data);
    expectUserError([&] { importVolume(folder / "none.nrrd"); }, {"none.nrrd", "voxels' size", "spacings"});
    writeBytes(folder / "nan.nrrd", head + "spacings: 0.5 0.5 nan\n\n" + data);
    expectUserError([&] { importVolume(folder / "nan.nrrd"); }, {"nan.nrrd", "spacings"});
    writeMetaImageFile(folder / "a.mha", SampleVolume(), {});
    std::string meta = readBytes(folder / "a.mha");
    const size_t at = meta.find("ElementSpacing");
    writeBytes(folder / "none.mha", meta.erase(at, meta.find('\n', at) + 1 - at));
    expectUserError([&] { importVolume(folder / "none.mha"); }, {"none.mha", "ElementSpacing"});
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
