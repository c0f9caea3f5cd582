// What people draw and write is where it was drawn, in front of the bone and never through it; quick drawing
// shows the same.
#include <gtest/gtest.h>

#include "tests/gl/golden.h"
#include "tests/gl/view_mode.h"

namespace bonemill::test {
namespace {

using Eigen::Vector3d;

constexpr uint32_t kDrawnColour = 0x3fa7ff;

class RemarkPicture : public ViewMode {
  protected:
    RemarkPicture() { begin(); }
    void begin() {
        lookFromTheLeft();
        showSphere();
    }
    // A point of the sphere, as seen from its left: to the right and up, in radii.
    static Vector3d onSphere(double right, double up, bool is_behind = false) {
        const double near = std::sqrt(1 - right * right - up * up);
        return kSphereCenter + kSphereRadius * Vector3d(is_behind ? -near : near, right, up);
    }
    static void addPoint(topics::Remark& remark, const Vector3d& p_W) {
        for (const double value : p_W) remark.add_points_m(float(value));
    }
    static topics::Remark arc(double up, bool is_behind = false) {
        topics::Remark remark;
        remark.set_number(1);
        remark.set_color(kDrawnColour);
        for (int n = -10; n <= 10; ++n) addPoint(remark, onSphere(0.06 * n, up, is_behind));
        return remark;
    }
    static topics::Remark note() {
        topics::Remark remark;
        remark.set_number(2);
        remark.set_note("mind the nerve");
        addPoint(remark, onSphere(-0.3, -0.45));
        return remark;
    }
    bool isBlue(const Picture& picture, const Vector3d& p_W) const {
        const Pixel at = project(scene_->camera().view(), p_W, kWidth, kHeight);
        const auto rgb = picture.at(int(at.x), int(at.y));
        return rgb[2] > rgb[0] + 40;
    }
};

TEST_F(RemarkPicture, StrokesAndNotesLookAsTheyDid) {
    scene_->setRemarks({{0, arc(0.3)}, {1, note()}, {2, arc(0.1, true)}});
    EXPECT_EQ(goldenProblem(draw(), "remarks"), "");
}

TEST_F(RemarkPicture, TheComparisonSeesALineThatIsMissing) {
    scene_->setRemarks({{1, note()}});
    EXPECT_TRUE(compare(draw(), readGolden("remarks")).isVisible());
    scene_->setRemarks({{0, arc(0.3)}});
    EXPECT_TRUE(compare(draw(), readGolden("remarks")).isVisible());
}

TEST_F(RemarkPicture, AStrokeLiesOnTheBoneInTheColourItWasDrawn) {
    const Picture bare = draw();
    scene_->setRemarks({{0, arc(0.3)}});
    const Picture drawn = draw();
    for (const double right : {-0.57, -0.2, 0.0, 0.33, 0.57}) {
        EXPECT_FALSE(isBlue(bare, onSphere(right, 0.3)));
        EXPECT_TRUE(isBlue(drawn, onSphere(right, 0.3))) << right;
        EXPECT_FALSE(isBlue(drawn, onSphere(right, 0.2))) << right;
    }
    scene_->settings().is_transparent = true;
    EXPECT_TRUE(isBlue(draw(), onSphere(0, 0.3))) << "also on transparent bone";
    scene_->settings().is_transparent = false;
    scene_->settings().show_remarks = false;
    EXPECT_EQ(countDifferent(draw(), bare), 0u);
    scene_->settings().show_remarks = true;
    scene_->setRemarks({});
    EXPECT_EQ(countDifferent(draw(), bare), 0u) << "erased";
    Stroke stroke{{}, strokeColour(kDrawnColour)};
    for (const double right : {-0.1, 0.0, 0.1}) stroke.points_W.push_back(onSphere(right, 0.3).cast<float>());
    scene_->setDrawn(stroke);
    EXPECT_TRUE(isBlue(draw(), onSphere(0.05, 0.3))) << "it is being drawn";
}

TEST_F(RemarkPicture, BoneHidesWhatIsBehindIt) {
    const Picture bare = draw();
    scene_->setRemarks({{0, arc(0.3, true)}});
    EXPECT_EQ(countDifferent(draw(), bare), 0u);
    for (const NodeMesh& node : sphereNodes()) scene_->setNode(emptyNode(node.leaf));
    EXPECT_TRUE(isBlue(draw(), onSphere(0, 0.3, true))) << "it stays when the bone is gone";
}

TEST_F(RemarkPicture, ACutTakesTheStrokeWithTheBone) {
    scene_->setRemarks({{0, arc(0.3)}});
    scene_->settings().cuts[0] = {true, 0.6, false};
    const Picture cut = draw();
    scene_->setRemarks({});
    EXPECT_EQ(countDifferent(draw(), cut), 0u);
}

TEST_F(RemarkPicture, QuickDrawingShowsTheSame) {
    scene_->settings().quality = Quality::kQuick;
    const auto expectWhole = [this](const char* when) {
        const Picture kept = draw();
        scene_->drawWholeNext();
        EXPECT_TRUE(draw() == kept) << when;
        return kept;
    };
    draw();
    scene_->setRemarks({{0, arc(0.3)}});
    EXPECT_TRUE(isBlue(expectWhole("drawn"), onSphere(0, 0.3)));
    Stroke stroke{{}, strokeColour(kDrawnColour)};
    for (int n = 0; n < 6; ++n) {
        stroke.points_W.push_back(onSphere(0.1 * n, -0.2).cast<float>());
        scene_->setDrawn(stroke);
        expectWhole("while another one is drawn");
    }
    for (size_t n = 0; n < sphereNodes().size(); n += 2) scene_->setNode(emptyNode(sphereNodes()[n].leaf));
    expectWhole("milled");
    scene_->setDrawn({});
    expectWhole("not drawn any more");
    scene_->setRemarks({});
    EXPECT_FALSE(isBlue(expectWhole("erased"), onSphere(0, 0.3)));
}

}  // namespace
}  // namespace bonemill::test
