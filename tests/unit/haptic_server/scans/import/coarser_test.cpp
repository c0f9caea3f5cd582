#include <gtest/gtest.h>

#include <span>
#include <vector>

#include "haptic_server/scans/densify/region.h"

namespace bonemill {
namespace {

template <class T>
RawVolume scanOf(const Eigen::Vector3i& dims, const std::vector<T>& values) {
    RawVolume scan;
    scan.geometry.dims = dims;
    scan.geometry.spacing = {1e-3, 2e-3, 3e-3};
    scan.geometry.X_WV.position = {0.1, 0.2, 0.3};
    scan.geometry.X_WV.rotation = Eigen::AngleAxisd(M_PI / 2, Eigen::Vector3d::UnitZ());
    scan.values.append(std::span<const T>(values));
    return scan;
}

TEST(Coarser, EachVoxelIsTheMeanOfThoseThatItCovers) {
    const RawVolume out = coarser(scanOf<int16_t>({4, 2, 2}, {0, 1, 10, 11,    //
                                                              2, 3, -30, -30,  //
                                                              4, 5, -30, -30,  //
                                                              6, 8, -30, -30}),
                                  2);
    EXPECT_EQ(out.geometry.dims, Eigen::Vector3i(2, 1, 1));
    EXPECT_EQ(out.values.type(), 1u) << "integers stay integers";
    EXPECT_EQ(out.values[0], 4);    // 3.625
    EXPECT_EQ(out.values[1], -20);  // -19.875
}

TEST(Coarser, AtTheUpperEndsItIsTheMeanOfWhatIsThere) {
    const RawVolume out = coarser(scanOf<uint8_t>({3, 3, 3}, {1, 1, 5, 1, 1, 5, 3, 3, 7,  //
                                                              1, 1, 5, 1, 1, 5, 3, 3, 7,  //
                                                              2, 2, 6, 2, 2, 6, 4, 4, 8}),
                                  2);
    EXPECT_EQ(out.geometry.dims, Eigen::Vector3i(2, 2, 2));
    const int expected[] = {1, 5, 3, 7, 2, 6, 4, 8};
    for (size_t n = 0; n < 8; ++n) EXPECT_EQ(out.values[n], expected[n]) << n;
}

TEST(Coarser, ItLiesInTheMiddleOfWhatItCovers) {
    const RawVolume scan = scanOf<float>({6, 6, 6}, std::vector<float>(216, 0.5f));
    const RawVolume out = coarser(scan, 3);
    EXPECT_TRUE(out.geometry.spacing.isApprox(Eigen::Vector3d(3e-3, 6e-3, 9e-3)));
    const Eigen::Vector3d middle = scan.geometry.X_WV * Eigen::Vector3d(1e-3, 2e-3, 3e-3);
    EXPECT_TRUE(out.geometry.X_WV.position.isApprox(middle));
    EXPECT_TRUE(out.geometry.X_WV.rotation.isApprox(scan.geometry.X_WV.rotation));
    EXPECT_EQ(out.values[0], 0.5f);
}

}  // namespace
}  // namespace bonemill
