#include <gtest/gtest.h>

#include "haptic_server/scans/dicom/dicom_series.h"

namespace bonemill {
namespace {

std::vector<DicomSlice> sliced(const char* uid, int count, double step_mm, const char* kernel) {
    std::vector<DicomSlice> slices;
    for (int k = 0; k < count; ++k) {
        DicomSlice slice;
        slice.path = std::to_string(k);
        slice.series_uid = uid;
        slice.modality = "CT";
        slice.columns = slice.rows = 8;
        slice.position_mm = {0, 0, k * step_mm};
        slice.traits.kernel = kernel;
        slices.push_back(slice);
    }
    return slices;
}

class BoneSeries : public testing::Test {
  protected:
    void add(const std::vector<DicomSlice>& slices) {
        slices_.insert(slices_.end(), slices.begin(), slices.end());
    }
    std::string recommended() {
        stacks_ = stacksOf(slices_, [](const auto&, const auto&) { return true; });
        const BoneRecommendation best = recommendForBone(stacks_);
        why_ = best.why;
        return best.stack ? best.stack->slices.front().series_uid : "";
    }
    std::string why_;

  private:
    std::vector<DicomSlice> slices_;
    std::vector<DicomStack> stacks_;
};

TEST_F(BoneSeries, KernelsOfAllMakersAreKnown) {
    for (const char* kernel : {"BONE", "BONEPLUS", "B60s", "B70f", "B80f", "H60s", "H70h", "Br64d\\3",
                               "Hr68d", "U90u", "YA", "YB", "FC30", "FC81", "Bone+"})
        EXPECT_TRUE(isBoneKernel(kernel)) << kernel;
    for (const char* kernel : {"", "STANDARD", "SOFT", "B30f", "B50f", "H31s", "Br40d", "FC08", "FC13", "B",
                               "B7", "C", "LUNG", "600", "H90"})
        EXPECT_FALSE(isBoneKernel(kernel)) << kernel;
}

TEST_F(BoneSeries, aBoneKernelGoesBeforeThinnerAndMoreSlices) {
    add(sliced("soft", 40, 0.6, "B30f"));
    add(sliced("bone", 20, 1, "B70f"));
    EXPECT_EQ(recommended(), "bone");
    EXPECT_NE(why_.find("bone kernel B70f"), std::string::npos) << why_;
    EXPECT_NE(why_.find("slices 1 mm apart"), std::string::npos) << why_;
}

TEST_F(BoneSeries, aBoneKernelOfThickSlicesDoesNot) {
    add(sliced("soft", 40, 0.6, "B30f"));
    add(sliced("bone", 20, 5, "B70f"));
    EXPECT_EQ(recommended(), "soft");
}

TEST_F(BoneSeries, ThinnestThenMost) {
    add(sliced("thick", 60, 1, "B70f"));
    add(sliced("thin", 20, 0.6, "B70f"));
    EXPECT_EQ(recommended(), "thin");
    add(sliced("long", 30, 0.6, "B70f"));
    EXPECT_EQ(recommended(), "long");
}

TEST_F(BoneSeries, ctGoesBeforeAllElseButNotAsAScout) {
    auto magnetic = sliced("mr", 60, 0.5, "");
    for (DicomSlice& slice : magnetic) slice.modality = "MR";
    add(magnetic);
    add(sliced("scout", 2, 0.5, "B70f"));
    auto localizer = sliced("localizer", 20, 0.5, "B70f");
    for (DicomSlice& slice : localizer) slice.traits.image_type = "ORIGINAL\\PRIMARY\\LOCALIZER";
    add(localizer);
    EXPECT_EQ(recommended(), "mr");
    EXPECT_NE(why_.find("no CT"), std::string::npos) << why_;
    add(sliced("ct", 10, 3, "B30f"));
    EXPECT_EQ(recommended(), "ct");
}

TEST_F(BoneSeries, whatCannotBeUsedIsNotRecommended) {
    auto gap = sliced("gap", 20, 1, "B70f");
    gap.erase(gap.begin() + 5, gap.begin() + 10);
    add(gap);
    EXPECT_EQ(recommended(), "");
}

}  // namespace
}  // namespace bonemill
