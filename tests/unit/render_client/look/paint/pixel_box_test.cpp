#include <gtest/gtest.h>

#include <random>

#include "render_client/look/camera/camera.h"
#include "render_client/look/paint/pixel_tiles.h"

namespace bonemill {
namespace {

constexpr int kWidth = 400, kHeight = 300;

class PixelBoxTest : public testing::Test {
  protected:
    PixelBoxTest() {
        const auto view = camera_.view();
        clip_from_W_ = view.clipFromCamera(double(kWidth) / kHeight, {0.01, 1}) * view.X_CW();
    }
    // Here x and y are pixels, and w > 0 is in front of the eye.
    Eigen::Vector2f pixelOf(const Eigen::Vector3f& p_W) const {
        const Eigen::Vector4f clip = clip_from_W_ * p_W.homogeneous();
        return {(clip.x() / clip.w() + 1) / 2 * kWidth, (clip.y() / clip.w() + 1) / 2 * kHeight};
    }

    OrbitCamera camera_;
    Eigen::Matrix4f clip_from_W_;
};

TEST_F(PixelBoxTest, HoldsEveryPointOfTheBox) {
    std::mt19937 random(3);
    std::uniform_real_distribution<float> place(-0.05f, 0.05f), share(0, 1);
    for (int n = 0; n < 300; ++n) {
        const Eigen::Vector3f corner(place(random), place(random), place(random));
        const Eigen::AlignedBox3f box(corner, corner + Eigen::Vector3f(0.01f, 0.003f, 0.02f));
        const PixelBox pixels = PixelBox::around(box, clip_from_W_, kWidth, kHeight);
        for (int m = 0; m < 20; ++m) {
            const Eigen::Vector3f p = box.min() + box.sizes().cwiseProduct(Eigen::Vector3f(
                                                      share(random), share(random), share(random)));
            const Eigen::Vector2f at = pixelOf(p);
            if (at.x() < 0 || at.y() < 0 || at.x() >= kWidth || at.y() >= kHeight) continue;
            EXPECT_TRUE(at.x() >= float(pixels.x0) && at.x() <= float(pixels.x1) &&
                        at.y() >= float(pixels.y0) && at.y() <= float(pixels.y1));
        }
    }
}

TEST_F(PixelBoxTest, IsTheWholePictureForABoxAtTheEye) {
    const Eigen::Vector3f eye = camera_.eye_W().cast<float>();
    const Eigen::AlignedBox3f box(eye - Eigen::Vector3f::Constant(0.01f),
                                  eye + Eigen::Vector3f::Constant(0.01f));
    EXPECT_EQ(PixelBox::around(box, clip_from_W_, kWidth, kHeight), PixelBox::whole(kWidth, kHeight));
}

TEST_F(PixelBoxTest, IsEmptyBesideThePicture) {
    const Eigen::Vector3f far_right = (camera_.target_W + camera_.view().R_WC.col(0)).cast<float>();
    const Eigen::AlignedBox3f box(far_right, far_right + Eigen::Vector3f::Constant(0.001f));
    EXPECT_TRUE(PixelBox::around(box, clip_from_W_, kWidth, kHeight).isEmpty());
    EXPECT_TRUE(PixelBox::around({}, clip_from_W_, kWidth, kHeight).isEmpty());
}

TEST(PixelBox, ZoomMakesTheBoxFillClipSpace) {
    const PixelBox box{100, 30, 180, 90};
    const Eigen::Matrix4f zoom = box.zoom(kWidth, kHeight);
    const auto ndcOf = [](int x, int y) {
        return Eigen::Vector4f(2.0f * float(x) / kWidth - 1, 2.0f * float(y) / kHeight - 1, 0.3f, 1);
    };
    EXPECT_TRUE((zoom * ndcOf(box.x0, box.y0)).isApprox(Eigen::Vector4f(-1, -1, 0.3f, 1), 1e-5f));
    EXPECT_TRUE((zoom * ndcOf(box.x1, box.y1)).isApprox(Eigen::Vector4f(1, 1, 0.3f, 1), 1e-5f));
}

TEST(PixelBox, JoinsAndCuts) {
    const PixelBox a{0, 0, 10, 10}, b{5, 8, 20, 12};
    EXPECT_EQ(a.joined(b), (PixelBox{0, 0, 20, 12}));
    EXPECT_EQ(a.joined({}), a);
    EXPECT_EQ(PixelBox{}.joined(b), b);
    EXPECT_EQ(a.within(b), (PixelBox{5, 8, 10, 10}));
    EXPECT_TRUE(a.within({30, 30, 40, 40}).isEmpty());
}

}  // namespace
}  // namespace bonemill
