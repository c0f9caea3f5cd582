#include "haptic_server/volume/import/material_ids.h"

#include <gtest/gtest.h>

#include <cmath>

#include "haptic_server/volume/import/physical_frame.h"
#include "tests/unit/volume_import/expect_user_error.h"

namespace bonemill {
namespace {

using Ids = std::vector<MaterialId>;

RawVolume rawOf(const Eigen::Vector3i& dims, std::vector<float> values) {
    RawVolume raw;
    raw.geometry.dims = dims;
    raw.geometry.spacing = {1e-3, 2e-3, 3e-3};
    raw.values.append(std::move(values));
    return raw;
}

TEST(MaterialIds, rangesIncludeTheirLowerEndOnlyAndTheLaterOneWins) {
    const RawVolume raw = rawOf({7, 1, 1}, {-5, 0, 99, 100, 150, 200, NAN});
    const std::vector<MaterialRule> rules = {
        {.has_range = true, .from = 0.0, .below = {}, .labels = {}},
        {.has_range = true, .from = 100.0, .below = 200.0, .labels = {}}};
    EXPECT_EQ(materialIds(raw, rules, nullptr, ""), (Ids{0, 1, 1, 2, 2, 1, 0}));
    const std::vector<MaterialRule> low = {{.has_range = true, .from = {}, .below = 0.0, .labels = {}}};
    EXPECT_EQ(materialIds(raw, low, nullptr, ""), (Ids{1, 0, 0, 0, 0, 0, 0}));
}

TEST(MaterialIds, labelsAndRangesMix) {
    const RawVolume raw = rawOf({6, 1, 1}, {0, 500, 500, 0, 900, 0});
    const RawVolume labels = rawOf({6, 1, 1}, {7, 7, 0, 9, 9, 3});
    const std::vector<MaterialRule> rules = {
        {.labels = {9}}, {.has_range = true, .from = 400.0, .below = {}, .labels = {}}, {.labels = {3, 7}}};
    EXPECT_EQ(materialIds(raw, rules, &labels, "l.nrrd"), (Ids{3, 3, 2, 1, 2, 3}));
}

// The voxels are the same, with axes in another order and direction.
TEST(MaterialIds, labelsMayBeStoredAnotherWayRound) {
    const Eigen::Vector3i dims(4, 3, 2);
    std::vector<float> numbers(24), turned(24);
    for (int n = 0; n < 24; ++n) numbers[size_t(n)] = float(n + 1);
    const RawVolume raw = rawOf(dims, numbers);
    // The labels' axes are along -y, along x and along z, that is a rotation about z by 90°.
    RawVolume labels;
    labels.geometry.dims = {3, 4, 2};
    labels.geometry.spacing = {2e-3, 1e-3, 3e-3};
    Eigen::Matrix3d axes;
    axes << 0, 1, 0, -1, 0, 0, 0, 0, 1;
    labels.geometry.X_WV.rotation = Eigen::Quaterniond(axes);
    labels.geometry.X_WV.position = {0, 2 * 2e-3, 0};
    for (int k = 0; k < 2; ++k)
        for (int j = 0; j < 3; ++j)
            for (int i = 0; i < 4; ++i)
                turned[size_t((2 - j) + 3 * (i + 4 * k))] = numbers[size_t(i + 4 * (j + 3 * k))];
    labels.values.append(std::move(turned));
    std::vector<MaterialRule> rules;
    for (uint32_t n = 1; n <= 24; ++n) rules.push_back({.labels = {n}});
    Ids expected(24);
    for (size_t n = 0; n < 24; ++n) expected[n] = MaterialId(n + 1);
    EXPECT_EQ(materialIds(raw, rules, &labels, "l.nrrd"), expected);
}

TEST(MaterialIds, otherGridsAreRefused) {
    const RawVolume raw = rawOf({4, 3, 2}, std::vector<float>(24, 1));
    const std::vector<MaterialRule> rules = {{.labels = {1}}};
    const auto refused = [&](const RawVolume& labels, std::initializer_list<std::string> words) {
        expectUserError([&] { materialIds(raw, rules, &labels, "l.nrrd"); }, words);
    };
    refused(rawOf({4, 3, 3}, std::vector<float>(36, 1)),
            {"l.nrrd has 4 x 3 x 3 voxels, the volume 4 x 3 x 2"});
    refused(rawOf({3, 4, 2}, std::vector<float>(24, 1)),
            {"l.nrrd has 3 x 4 x 2 voxels, the volume 4 x 3 x 2"});
    RawVolume labels = rawOf({4, 3, 2}, std::vector<float>(24, 1));
    labels.geometry.X_WV.position.x() = 0.8e-3;
    refused(labels, {"lies up to 0.8 voxels beside the volume", "same grid"});
    labels = rawOf({4, 3, 2}, std::vector<float>(24, 1));
    labels.geometry.spacing.x() = 2e-3;
    refused(labels, {"voxels of another size", "same grid"});
    labels = rawOf({4, 3, 2}, std::vector<float>(24, 1.5f));
    refused(labels, {"no whole numbers"});
    EXPECT_EQ(materialIds(raw, rules, &raw, "l.nrrd"), Ids(24, 1));
}

}  // namespace
}  // namespace bonemill
