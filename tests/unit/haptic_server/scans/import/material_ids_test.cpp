#include <gtest/gtest.h>

#include <cmath>

#include "haptic_server/scans/labels/labels.h"

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
    EXPECT_EQ(materialIds(raw, rules), (Ids{0, 1, 1, 2, 2, 1, 0}));
    const std::vector<MaterialRule> low = {{.has_range = true, .from = {}, .below = 0.0, .labels = {}}};
    EXPECT_EQ(materialIds(raw, low), (Ids{1, 0, 0, 0, 0, 0, 0}));
}

TEST(MaterialIds, labelsAndRangesMix) {
    const RawVolume raw = rawOf({6, 1, 1}, {0, 500, 500, 0, 900, 0});
    const std::vector<MaterialRule> rules = {
        {.labels = {9}}, {.has_range = true, .from = 400.0, .below = {}, .labels = {}}, {.labels = {3, 7}}};
    EXPECT_EQ(materialIds(raw, rules, {3, 3, 0, 1, 1, 3}), (Ids{3, 3, 2, 1, 2, 3}));
}

}  // namespace
}  // namespace bonemill
