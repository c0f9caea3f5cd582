#include "render_client/hand/controls/picture_name.h"

#include <gtest/gtest.h>

#include <cstdlib>
#include <fstream>

#include "tests/support/temporary_folder.h"

namespace bonemill {
namespace {

class PictureName : public testing::Test {
  protected:
    void SetUp() override {
        setenv("TZ", "UTC", 1);
        tzset();
    }
    test::TemporaryFolder folder_;
};

constexpr std::time_t kTime = 1795868130;  // 2026-11-28 12:15:30 UTC

TEST_F(PictureName, SaysWhenAndWhat) {
    EXPECT_EQ(pictureName("somewhere", "tooth_corridor", kTime),
              "somewhere/bonemill_2026-11-28_121530_tooth_corridor.png");
    EXPECT_EQ(pictureName("", "", kTime), "bonemill_2026-11-28_121530.png");
}

TEST_F(PictureName, ASceneCannotLeaveTheFolder) {
    EXPECT_EQ(pictureName("here", "../ö a", kTime), "here/bonemill_2026-11-28_121530_______a.png");
}

TEST_F(PictureName, NothingIsWrittenOver) {
    const std::filesystem::path first = pictureName(folder_.path(), "tooth", kTime);
    std::ofstream(first) << "a picture";
    const std::filesystem::path second = pictureName(folder_.path(), "tooth", kTime);
    EXPECT_EQ(second.filename(), "bonemill_2026-11-28_121530_tooth_2.png");
    EXPECT_LT(first, second) << "the newest one is the last";
}

}  // namespace
}  // namespace bonemill
