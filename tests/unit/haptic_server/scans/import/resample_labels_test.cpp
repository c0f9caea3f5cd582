#include <gtest/gtest.h>

#include <cmath>

#include "haptic_server/scans/densify/voxel_materials.h"
#include "tests/unit/haptic_server/scans/import/expect_user_error.h"
#include "tests/unit/haptic_server/scans/import/grid_scan.h"

namespace bonemill {
namespace {

VolumeGeometry gridOf(const Eigen::Vector3i& dims, const Eigen::Vector3d& spacing) {
    VolumeGeometry grid;
    grid.dims = dims;
    grid.spacing = spacing;
    return grid;
}

RawVolume numbered(const VolumeGeometry& grid) {
    RawVolume raw;
    raw.geometry = grid;
    std::vector<float> numbers;
    for (size_t n = 0; n < grid.voxelCount(); ++n) numbers.push_back(float(n + 1));
    raw.values.append(std::span<const float>(numbers));
    return raw;
}

// Material n is that of label n.
std::vector<MaterialRule> oneOfEach(uint32_t labels) {
    std::vector<MaterialRule> rules;
    for (uint32_t label = 1; label <= labels; ++label) rules.push_back({.labels = {label}});
    return rules;
}

bool areValuesOf(const std::vector<MaterialId>& ids, const RawVolume& raw) {
    for (size_t n = 0; n < ids.size(); ++n)
        if (ids[n] != raw.values[n]) return false;
    return ids.size() == raw.values.size();
}

TEST(ResampledLabels, OfTheSameVoxelsAreTheSame) {
    const RawVolume labels = numbered(gridOf({4, 3, 2}, {1e-3, 2e-3, 3e-3}));
    const ResampledLabels same = resampleLabels(labels, oneOfEach(24), labels.geometry, "l.nrrd");
    EXPECT_TRUE(areValuesOf(same.ids, labels));
    EXPECT_TRUE(same.is_exact);
    EXPECT_EQ(same.covered, 1);
}

// The voxels are the same, with axes in another order and direction: along -y, along x and along z.
TEST(ResampledLabels, MayBeStoredAnotherWayRound) {
    const RawVolume scan = numbered(gridOf({4, 3, 2}, {1e-3, 2e-3, 3e-3}));
    RawVolume labels;
    labels.geometry = gridOf({3, 4, 2}, {2e-3, 1e-3, 3e-3});
    Eigen::Matrix3d axes;
    axes << 0, 1, 0, -1, 0, 0, 0, 0, 1;
    labels.geometry.X_WV.rotation = Eigen::Quaterniond(axes);
    labels.geometry.X_WV.position = {0, 2 * 2e-3, 0};
    std::vector<float> turned(24);
    for (int k = 0; k < 2; ++k)
        for (int j = 0; j < 3; ++j)
            for (int i = 0; i < 4; ++i)
                turned[size_t((2 - j) + 3 * (i + 4 * k))] = scan.values[size_t(i + 4 * (j + 3 * k))];
    labels.values.append(std::span<const float>(turned));
    const ResampledLabels back = resampleLabels(labels, oneOfEach(24), scan.geometry, "l.nrrd");
    EXPECT_TRUE(areValuesOf(back.ids, scan));
    EXPECT_TRUE(back.is_exact);
}

// Two halves with a slanted border, on a grid that is turned, moved and of another size.
TEST(ResampledLabels, AreRightButForAVoxelAtTheBorder) {
    const VolumeGeometry scan = gridOf({40, 36, 30}, {1e-3, 1e-3, 1.5e-3});
    VolumeGeometry grid = gridOf({110, 100, 110}, {0.6e-3, 0.6e-3, 0.6e-3});
    grid.X_WV.rotation = Eigen::AngleAxisd(0.1, Eigen::Vector3d(1, 2, -1).normalized());
    grid.X_WV.position = {-8e-3, -8e-3, -8e-3};
    const Eigen::Vector3d normal = Eigen::Vector3d(1, -2, 0.5).normalized();
    const double at = normal.dot(placeOfVoxel(scan, scan.dims / 2));
    const RawVolume labels =
        scanOf(grid, [&](const Eigen::Vector3d& p) { return normal.dot(p) > at ? 7.0 : 3.0; });
    const ResampledLabels out = resampleLabels(labels, oneOfEach(7), scan, "labels.nrrd");
    EXPECT_FALSE(out.is_exact);
    EXPECT_EQ(out.covered, 1);
    forEachIndex({Eigen::Vector3i::Zero(), scan.dims.array() - 1}, [&](const Eigen::Vector3i& v) {
        const double beyond = normal.dot(placeOfVoxel(scan, v)) - at;
        if (std::abs(beyond) < 0.6e-3) return;  // either may be right
        ASSERT_EQ(out.ids[indexOf(scan, v)], beyond > 0 ? 7 : 3) << v.transpose();
    });
}

// A nerve (labels 1 and 2) and a canal (2, 3 and 5) overlap in 2.
TEST(ResampledLabels, ThatOverlapKeepTheirShapeEach) {
    const VolumeGeometry file = gridOf({2, 2, 2}, Eigen::Vector3d::Constant(1e-3));
    VolumeGeometry middle = file;
    middle.dims = {1, 1, 1};
    middle.X_WV.position.setConstant(0.5e-3);
    const auto idOf = [&](const std::vector<uint8_t>& corners, const std::vector<MaterialRule>& rules) {
        RawVolume labels;
        labels.geometry = file;
        labels.values.append(std::span<const uint8_t>(corners));
        return int(resampleLabels(labels, rules, middle, "l").ids[0]);
    };
    const std::vector<MaterialRule> nerve_first = {{.labels = {1, 2}}, {.labels = {2, 3, 5}}};
    EXPECT_EQ(idOf({1, 1, 1, 2, 3, 3, 5, 5}, nerve_first), 2)
        << "five of eight are canal, though no label has as many as the nerve's own";
    EXPECT_EQ(idOf({1, 1, 1, 2, 2, 3, 0, 0}, nerve_first), 1) << "five of eight are nerve";
    EXPECT_EQ(idOf({1, 1, 2, 2, 2, 3, 3, 0}, nerve_first), 2) << "both have five: the later wins";
    EXPECT_EQ(idOf({1, 1, 1, 1, 2, 2, 2, 0}, {{.labels = {4}}, {.labels = {2, 1}}}), 2)
        << "one structure of two labels";
    EXPECT_EQ(idOf({1, 1, 1, 3, 3, 0, 0, 4}, oneOfEach(4)), 1) << "none has half: the largest share";
    EXPECT_EQ(idOf({1, 1, 1, 1, 3, 3, 3, 3}, oneOfEach(4)), 3) << "of two alike the larger label";
}

TEST(ResampledLabels, AreNoneWhereTheirFileEnds) {
    const VolumeGeometry scan = gridOf({10, 4, 4}, Eigen::Vector3d::Constant(1e-3));
    VolumeGeometry part = scan;
    part.dims.x() = 4;
    part.X_WV.position.x() = 3e-3;
    const RawVolume labels = scanOf(part, [](const Eigen::Vector3d&) { return 5.0; });
    const ResampledLabels out = resampleLabels(labels, oneOfEach(5), scan, "part.nrrd");
    for (int i = 0; i < 10; ++i) EXPECT_EQ(out.ids[size_t(i)], i >= 3 && i < 7 ? 5 : 0) << i;
    EXPECT_DOUBLE_EQ(out.covered, 0.4);
    EXPECT_FALSE(out.is_exact);
}

TEST(ResampledLabels, MustMeetTheScanAndBeWholeNumbers) {
    const VolumeGeometry scan = gridOf({4, 3, 2}, {1e-3, 2e-3, 3e-3});
    RawVolume aside = numbered(scan);
    aside.geometry.X_WV.position.x() = 20e-3;
    expectUserError([&] { resampleLabels(aside, {}, scan, "labels.nrrd"); },
                    {"labels.nrrd", "lies beside the volume"});
    const RawVolume halves = scanOf(scan, [](const Eigen::Vector3d&) { return 1.5; });
    expectUserError([&] { resampleLabels(halves, {}, scan, "labels.nrrd"); },
                    {"labels.nrrd", "no whole numbers"});
}

}  // namespace
}  // namespace bonemill
