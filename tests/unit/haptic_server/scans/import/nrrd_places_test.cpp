// Where the voxels of NRRD files and segmentations lie, in all their spaces, against a table of sides.
#include <gtest/gtest.h>

#include <cmath>

#include "haptic_server/core/volume/index_box.h"
#include "haptic_server/scans/densify/voxel_materials.h"
#include "tests/unit/haptic_server/scans/import/expect_user_error.h"
#include "tests/unit/haptic_server/scans/import/patient_sides.h"
#include "tests/unit/haptic_server/scans/import/seg_nrrd.h"

namespace bonemill {
namespace {

struct NrrdSpace {
    const char *name, *sides;
};

// As the format's definition has them. A scanner's own axes and those of nobody are taken as they are.
constexpr NrrdSpace kSpaces[] = {{"right-anterior-superior", "RAS"},
                                 {"RAS", "RAS"},
                                 {"left-anterior-superior", "LAS"},
                                 {"LAS", "LAS"},
                                 {"las", "LAS"},
                                 {"left-posterior-superior", "LPS"},
                                 {"LPS", "LPS"},
                                 {"scanner-xyz", "LPS"},
                                 {"3D-right-handed", "LPS"}};

TEST_F(Places, ofNrrdInEverySpace) {
    for (const std::string& code : allOrientations())
        for (const NrrdSpace& space : kSpaces) {
            SCOPED_TRACE(code + " in " + space.name);
            writeNrrd(sampleTo(code), space.name, space.sides);
            expectRead("a.nrrd", sampleTo(code));
            EXPECT_NO_THROW(expectSamePlaces(readPlainNrrd(folder_ / "a.nrrd", {}), sampleTo(code)));
        }
}

// Vectors have a fourth number then, and a fourth axis may be there, of one moment.
TEST_F(Places, ofNrrdInEverySpaceWithTime) {
    for (const std::string& code : allOrientations())
        for (const NrrdSpace& space :
             {NrrdSpace{"right-anterior-superior-time", "RAS"}, NrrdSpace{"RAST", "RAS"},
              NrrdSpace{"left-anterior-superior-time", "LAS"}, NrrdSpace{"LAST", "LAS"},
              NrrdSpace{"left-posterior-superior-time", "LPS"}, NrrdSpace{"LPST", "LPS"},
              NrrdSpace{"scanner-xyz-time", "LPS"}, NrrdSpace{"3D-right-handed-time", "LPS"}}) {
            SCOPED_TRACE(code + " in " + space.name);
            const SampleVolume sample = inSpace(sampleTo(code), space.sides);
            writeNrrd(sampleTo(code), space.name, space.sides);
            std::string directions = "space directions:";
            for (int a = 0; a < 3; ++a)
                directions += " (" + texts(sample.directions.col(a) * sample.spacing_mm[a], ",") + ",0)";
            std::string bytes = readBytes(folder_ / "a.nrrd");
            const size_t begin = bytes.find("space directions:"), end = bytes.find("\nspace origin");
            bytes.replace(begin, end - begin, directions + " (0,0,0,1)");
            bytes = replaced(bytes, texts(sample.origin_mm, ",") + ")",
                             texts(sample.origin_mm, ",") + ",0)\nkinds: domain domain domain time");
            bytes = replaced(bytes, "dimension: 3", "dimension: 4");
            writeBytes(folder_ / "a.nrrd", replaced(bytes, "sizes: 5 4 3", "sizes: 5 4 3 1"));
            expectRead("a.nrrd", sampleTo(code));
        }
}

TEST_F(Places, ofNrrdInASpaceThatIsNoneAreRefused) {
    for (const char* space :
         {"left-posterior-inferior", "RPI", "LPST-time", "2D", "3D-left-handed", "3D-left-handed-time"}) {
        SCOPED_TRACE(space);
        writeNrrd(SampleVolume(), space, "LPS");
        expectUserError([&] { importVolumeHere(folder_ / "a.nrrd"); }, {"space", "left-posterior-superior"});
        expectUserError([&] { readPlainNrrd(folder_ / "a.nrrd", {}); }, {"space", "left-posterior-superior"});
    }
    writeNrrd(SampleVolume(), "3D-left-handed", "LPS");
    const std::string bytes = readBytes(folder_ / "a.nrrd");
    expectRefused("a.nrrd", bytes, {"3d-left-handed", "mirror image"});
    expectRefused("a.nrrd", replaced(bytes, "space: 3D-left-handed", "space: LPS\nspace: RAS"),
                  {"space twice"});
    const size_t begin = bytes.find("space directions"), end = bytes.find("endian");
    std::string spaced = bytes;
    spaced.replace(begin, end - begin, "spacings: 1 1 1\n");
    expectRefused("a.nrrd", replaced(spaced, "3D-left-handed", "LAS"), {"las", "write its space directions"});
}

TEST_F(Places, ofNrrdWithoutDirectionsBeginWhereItsAxesDo) {
    const std::string head = "NRRD0001\ntype: short\ndimension: 3\nsizes: 5 4 3\nspacings: 0.5 0.75 1.25\n";
    const std::string tail = "endian: little\nencoding: raw\n\n";
    writeNrrd(SampleVolume(), "LPS", "LPS");
    const std::string bytes = readBytes(folder_ / "a.nrrd");
    const std::string data = bytes.substr(bytes.find("\n\n") + 2);
    SampleVolume nodes, cells;
    cells.origin_mm += cells.spacing_mm / 2;
    for (const auto& [centers, meant] :
         {std::pair("node node node", nodes), std::pair("cell cell cell", cells)}) {
        writeBytes(folder_ / "b.nrrd",
                   head + "axis mins: 10 -20 30\ncenters: " + centers + "\n" + tail + data);
        expectRead("b.nrrd", meant);
        EXPECT_NO_THROW(expectSamePlaces(readPlainNrrd(folder_ / "b.nrrd", {}), meant));
    }
}

// The sample has 5 x 4 x 3 voxels.
TEST_F(Places, ofNrrdOfWhichTheExtentsContradictTheSpacingsAreRefused) {
    struct Extents {
        const char *centers, *maxs;
        bool agree;
    };
    for (const Extents& extents :
         {Extents{"centers: node node node\n", "4 6 8", true},
          Extents{"centers: cell cell cell\n", "5 8 12", true}, Extents{"", "4 8 nan", true},
          Extents{"centers: node node node\n", "5 8 12", false},
          Extents{"centers: cell cell cell\n", "4 6 8", false}, Extents{"", "-4 6 8", false},
          Extents{"", "4 6 4", false}}) {
        const std::string head =
            "NRRD0004\ntype: uint8\ndimension: 3\nsizes: 5 4 3\nspacings: 1 2 4\naxis mins: 0 0 0\naxis "
            "maxs: ";
        writeBytes(folder_ / "b.nrrd",
                   head + extents.maxs + "\n" + extents.centers + "encoding: raw\n\n" + std::string(60, 'x'));
        SCOPED_TRACE(extents.centers + std::string(extents.maxs));
        if (extents.agree)
            EXPECT_NO_THROW(importVolumeHere(folder_ / "b.nrrd"));
        else
            expectUserError([&] { importVolumeHere(folder_ / "b.nrrd"); },
                            {"b.nrrd", "axis maxs", "contradict", "spacings"});
    }
}

// A label map lies where it says on a scan that is stored another way.
TEST_F(Places, ofLabelsOnAScanOfOtherAxes) {
    writeNrrd(sampleTo("LPS"), "LPS", "LPS");
    const RawVolume scan = importVolumeHere(folder_ / "a.nrrd");
    constexpr int kMaterials = 117;  // two labels are of each
    std::vector<MaterialRule> rules(kMaterials);
    std::vector<MaterialId> meant;
    for (uint32_t label = 1; label <= 2 * kMaterials; ++label)
        rules[(label - 1) % kMaterials].labels.push_back(label);
    for (size_t n = 0; n < scan.values.size(); ++n) {
        const int label = int(scan.values[n]);
        meant.push_back(label == 0 ? kNoMaterial : MaterialId((label - 1) % kMaterials + 1));
    }
    for (const std::string& code : allOrientations())
        for (const NrrdSpace& space : {kSpaces[0], kSpaces[2], kSpaces[5]}) {
            SCOPED_TRACE(code + " in " + space.name);
            SampleVolume labels = sampleTo(code);
            // The same voxels, counted from another corner.
            for (int a = 0; a < 3; ++a) {
                const Eigen::Vector3d axis = labels.directions.col(a);
                Eigen::Index along = 0;
                axis.cwiseAbs().maxCoeff(&along);
                labels.dims[a] = SampleVolume().dims[along];
                labels.spacing_mm[a] = SampleVolume().spacing_mm[along];
                if (axis[along] < 0) labels.origin_mm[along] += labels.spacing_mm[a] * (labels.dims[a] - 1);
            }
            writeNrrd(labels, space.name, space.sides);
            RawVolume map = importVolumeHere(folder_ / "a.nrrd");
            std::vector<float> values;  // of a voxel what the scan has there
            for (size_t n = 0; n < map.values.size(); ++n) {
                const Eigen::Vector3d from_first =
                    1e3 * labels.place(map.values[n]) - SampleVolume().origin_mm;
                const Eigen::Vector3d index = from_first.cwiseQuotient(SampleVolume().spacing_mm);
                values.push_back(float(std::lround(index.dot(Eigen::Vector3d(1, 10, 100)))));
            }
            map.values = RawValues();
            map.values.append(std::span<const float>(values));
            const ResampledLabels on_scan = resampleLabels(map, rules, scan.geometry, "a.nrrd");
            EXPECT_TRUE(on_scan.is_exact);
            EXPECT_EQ(on_scan.ids, meant);
        }
}

// 3D Slicer's label maps; of two layers the axis of the layers comes first.
TEST_F(Places, ofSegmentsInEverySpace) {
    for (const std::string& code : allOrientations())
        for (const NrrdSpace& space :
             {NrrdSpace{"left-posterior-superior", "LPS"}, NrrdSpace{"right-anterior-superior", "RAS"},
              NrrdSpace{"left-anterior-superior", "LAS"}})
            for (const int layers : {1, 2}) {
                SCOPED_TRACE(code + " in " + space.name + ", layers: " + std::to_string(layers));
                const SampleVolume sample = inSpace(sampleTo(code), space.sides);
                std::string directions;
                for (int a = 0; a < 3; ++a)
                    directions += " (" + texts(sample.directions.col(a) * sample.spacing_mm[a], ",") + ")";
                SegmentsFile file{.dims = sample.dims, .layers = layers};
                file.label = [](const Eigen::Vector3i& v, int layer) {
                    return layer == 0 && v == Eigen::Vector3i(3, 1, 2);
                };
                file.segments = segmentLines(0, "nerve", 1, 0) + segmentLines(1, "canal", 1, layers - 1);
                writeSegNrrd(folder_ / "a.seg.nrrd", file);
                std::string bytes = readBytes(folder_ / "a.seg.nrrd");
                bytes = replaced(bytes, "left-posterior-superior", space.name);
                const size_t begin = bytes.find(" (1"), end = bytes.find("\nkinds");
                bytes.replace(begin, end - begin, directions);
                bytes = replaced(bytes, "(0,0,0)", "(" + texts(sample.origin_mm, ",") + ")");
                writeBytes(folder_ / "a.seg.nrrd", bytes);
                const RawVolume raw = importVolumeHere(folder_ / "a.seg.nrrd");
                std::vector<Eigen::Vector3d> found;
                forEachIndex(
                    {Eigen::Vector3i::Zero(), raw.geometry.dims.array() - 1}, [&](const Eigen::Vector3i& v) {
                        if (raw.values[size_t(v.x() + raw.geometry.dims.x() *
                                                          (v.y() + raw.geometry.dims.y() * v.z()))] != 0)
                            found.push_back(raw.geometry.X_WV *
                                            raw.geometry.spacing.cwiseProduct(v.cast<double>()));
                    });
                ASSERT_EQ(found.size(), 1u);
                EXPECT_LT((found[0] - sampleTo(code).place(3 + 10 + 200)).norm(), 1e-9);
            }
}

}  // namespace
}  // namespace bonemill
