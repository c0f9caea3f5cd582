// Where the voxels of NIfTI, MetaImage and DICOM files lie, against a table of sides.
#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <cstring>

#include "tests/unit/haptic_server/scans/import/dicom_bytes.h"
#include "tests/unit/haptic_server/scans/import/dicom_seg_bytes.h"
#include "tests/unit/haptic_server/scans/import/patient_sides.h"

namespace bonemill {
namespace {

constexpr size_t kUnits = 123, kQform = 252, kSform = 254, kQuatern = 256, kQfac = 76;

template <class T>
void put(std::string& bytes, size_t offset, T value) {
    std::memcpy(bytes.data() + offset, &value, sizeof value);
}

// By the method 2 of nifti1.h: a turn of the axes to right, front and head, and which way the third one goes.
std::string withQform(std::string bytes, const SampleVolume& meant, int code) {
    const SampleVolume ras = inSpace(meant, "RAS");
    Eigen::Matrix3d R = ras.directions;
    const bool is_left_handed = R.determinant() < 0;
    if (is_left_handed) R.col(2) = -R.col(2);
    Eigen::Quaterniond q(R);
    if (q.w() < 0) q.coeffs() = -q.coeffs();
    put(bytes, kQform, int16_t(code));
    put(bytes, kQfac, is_left_handed ? -1.0f : 1.0f);
    for (size_t n = 0; n < 3; ++n) {
        put(bytes, kQuatern + 4 * n, float(q.vec()[int(n)]));
        put(bytes, kQuatern + 12 + 4 * n, float(ras.origin_mm[int(n)]));
    }
    return bytes;
}

// Both forms have codes of 1 to 5: scanner, aligned, Talairach, MNI, another template.
TEST_F(Places, ofNiftiInBothForms) {
    for (const std::string& code : allOrientations()) {
        SCOPED_TRACE(code);
        const SampleVolume sample = sampleTo(code);
        const std::string bytes = niftiBytes(sample);
        for (int form = 1; form <= 5; ++form) {
            std::string sform = bytes;
            put(sform, kSform, int16_t(form));
            writeBytes(folder_ / "a.nii", sform);
            expectRead("a.nii", sample, 1e-8);  // the header holds float
            std::string qform = withQform(bytes, sample, form);
            put(qform, kSform, int16_t(0));
            std::fill(qform.begin() + 280, qform.begin() + 328, '\x11');  // an sform that does not count
            writeBytes(folder_ / "a.nii", qform);
            expectRead("a.nii", sample, 1e-8);
            EXPECT_FALSE(importVolumeHere(folder_ / "a.nii").lacks_patient_axes);
        }
        writeBytes(folder_ / "a.nii", withQform(bytes, sample, 1));  // both, and they agree
        expectRead("a.nii", sample, 1e-8);
        EXPECT_EQ(importVolumeHere(folder_ / "a.nii").description.find("qform"), std::string::npos);
    }
}

TEST_F(Places, ofNiftiByItsVoxelsAloneAreNotThePatients) {
    std::string bytes = niftiBytes(sampleTo("RAI"));
    put(bytes, kSform, int16_t(0));
    for (const auto& [unit, mm] : {std::pair('\0', 1.0), {'\1', 1000.0}, {'\2', 1.0}, {'\3', 1e-3}}) {
        bytes[kUnits] = unit;
        writeBytes(folder_ / "a.nii", bytes);
        SampleVolume meant;
        meant.spacing_mm *= mm;
        meant.origin_mm.setZero();
        expectRead("a.nii", meant, 1e-6 * mm);
        const RawVolume raw = importVolumeHere(folder_ / "a.nii");
        EXPECT_TRUE(raw.lacks_patient_axes);
        EXPECT_NE(raw.description.find("left and right"), std::string::npos) << raw.description;
    }
    bytes[kUnits] = '\5';
    expectRefused("a.nii", bytes, {"xyzt_units"});
}

TEST_F(Places, ofNiftiOfWhichTheSformHasOtherVoxelsAreRefused) {
    std::string bytes = niftiBytes(SampleVolume());
    put(bytes, 80, 1.0f);
    expectRefused("a.nii", bytes,
                  {"sform makes voxels of 0.5 x 0.75 x 1.25 mm", "pixdim says 1 x 0.75 x 1.25"});
}

// ITK's letters name the sides where axes begin; MetaIO's documentation means those where they end.
TEST_F(Places, ofMetaImageByItsMatrix) {
    for (const std::string& code : allOrientations()) {
        SCOPED_TRACE(code);
        const std::string bytes = metaBytes(sampleTo(code));
        expectRead("a.mha", sampleTo(code));
        EXPECT_TRUE(importVolumeHere(folder_ / "a.mha").lacks_patient_axes);
        int agreeing = 0, contradicting = 0;
        for (const std::string& said : allOrientations()) {
            const Eigen::Matrix3d axes = axesTo(said);
            const bool agrees = axes == axesTo(code) || axes == -axesTo(code);
            if (!agrees && ++contradicting % 7 != 0) continue;  // a few of them will do
            const std::string text =
                replaced(bytes, "DimSize", "AnatomicalOrientation = " + said + "\nDimSize");
            if (!agrees) {
                expectRefused("b.mha", text, {"AnatomicalOrientation " + said, "TransformMatrix"});
                continue;
            }
            ++agreeing;
            writeBytes(folder_ / "b.mha", text);
            expectRead("b.mha", sampleTo(code));
            EXPECT_FALSE(importVolumeHere(folder_ / "b.mha").lacks_patient_axes);
        }
        EXPECT_EQ(agreeing, 2);
    }
}

TEST_F(Places, ofMetaImageByAnyOfItsNames) {
    const SampleVolume sample = sampleTo("PIR");
    const std::string bytes = metaBytes(sample);
    for (const char* matrix : {"TransformMatrix", "Rotation", "Orientation"})
        for (const char* origin : {"Offset", "Position", "Origin"})
            for (const char* spacing : {"ElementSpacing", "ElementSize"}) {
                SCOPED_TRACE(std::string(matrix) + " " + origin + " " + spacing);
                std::string text = replaced(bytes, "TransformMatrix", matrix);
                text = replaced(replaced(text, "Offset", origin), "ElementSpacing", spacing);
                writeBytes(folder_ / "b.mha", text);
                expectRead("b.mha", sample);
            }
    writeBytes(folder_ / "b.mha", replaced(bytes, "ElementSpacing", "ElementSize = 9 9 9\nElementSpacing"));
    expectRead("b.mha", sample);
    writeBytes(folder_ / "b.mha", replaced(bytes, "DimSize", "Position = 10 -20 30\nDimSize"));
    expectRead("b.mha", sample);
    expectRefused("b.mha", replaced(bytes, "DimSize", "Position = 10 20 30\nDimSize"),
                  {"Offset", "Position"});
    expectRefused("b.mha", replaced(bytes, "DimSize", "Rotation = 1 0 0 0 1 0 0 0 1\nDimSize"),
                  {"TransformMatrix", "Rotation"});
    expectRefused("b.mha", replaced(metaBytes(SampleVolume()), "TransformMatrix = 1", "TransformMatrix = 2"),
                  {"unit vectors"});
    expectRefused(
        "b.mha",
        "ObjectType = Image\nNDims = 3\nBinaryData = True\nAnatomicalOrientation = ASL\nElementSpacing "
        "= 1 1 1\nDimSize = 5 4 3\nElementType = MET_SHORT\nElementDataFile = LOCAL\n" +
            std::string(120, 'x'),
        {"AnatomicalOrientation ASL", "TransformMatrix"});
}

// Slices are files in the order of their names, which may run against their normal.
TEST_F(Places, ofDicomSlicesAndFrames) {
    for (const std::string& code : allOrientations()) {
        SCOPED_TRACE(code);
        const SampleVolume sample = sampleTo(code);
        const std::vector<int16_t> values = sample.values();
        DicomImage image;
        image.orientation =
            texts(sample.directions.col(0), "\\") + "\\" + texts(sample.directions.col(1), "\\");
        image.pixel_spacing = "0.75\\0.5";  // between rows first
        DicomImage frames = image;
        std::filesystem::create_directory(folder_ / "slices");
        for (int k = 0; k < sample.dims.z(); ++k) {
            const size_t size = size_t(sample.dims.x() * sample.dims.y());
            image.pixels.assign(values.begin() + std::ptrdiff_t(size) * k,
                                values.begin() + std::ptrdiff_t(size) * (k + 1));
            image.sop_uid = "1.2.3.4." + std::to_string(k);
            image.position =
                texts(sample.origin_mm + sample.directions.col(2) * sample.spacing_mm.z() * k, "\\");
            writeDicomFile(folder_ / ("slices/" + std::to_string(k)), image);
            frames.frame_positions.push_back(image.position);
            frames.pixels.insert(frames.pixels.end(), image.pixels.begin(), image.pixels.end());
        }
        writeDicomFile(folder_ / "frames.dcm", frames);
        expectRead("slices", sample);
        expectRead("frames.dcm", sample);
    }
}

// Each voxel is a segment of its own.
TEST_F(Places, ofDicomSegments) {
    for (const std::string& code : allOrientations()) {
        SCOPED_TRACE(code);
        const SampleVolume sample = sampleTo(code);
        DicomSegmentation file;
        file.rows = sample.dims.y(), file.columns = sample.dims.x();
        file.orientation =
            texts(sample.directions.col(0), "\\") + "\\" + texts(sample.directions.col(1), "\\");
        file.pixel_spacing = "0.75\\0.5";
        file.spacing_between = "1.25";
        const std::vector<int16_t> values = sample.values();
        for (size_t n = 0; n < values.size(); ++n) {
            const size_t size = size_t(file.rows * file.columns);
            DicomSegmentation::Frame frame;
            frame.segment = values[n] + 1;
            const Eigen::Vector3d slice = sample.directions.col(2) * sample.spacing_mm.z() * double(n / size);
            frame.position = texts(Eigen::Vector3d(sample.origin_mm + slice), "\\");
            frame.values.assign(size, 0);
            frame.values[n % size] = 1;
            file.segments.push_back({frame.segment, "s" + std::to_string(values[n])});
            file.frames.push_back(frame);
        }
        writeDicomSeg(folder_ / "a.dcm", file);
        RawVolume raw = importVolumeHere(folder_ / "a.dcm");
        std::vector<float> numbers;
        for (size_t n = 0; n < raw.values.size(); ++n) numbers.push_back(raw.values[n] - 1);
        raw.values = RawValues();
        raw.values.append(std::span<const float>(numbers));
        EXPECT_NO_THROW(expectSamePlaces(raw, sample));
    }
}

}  // namespace
}  // namespace bonemill
