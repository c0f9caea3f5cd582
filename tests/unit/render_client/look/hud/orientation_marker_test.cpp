#include <gtest/gtest.h>

#include <algorithm>
#include <numbers>

#include "common/geometry/view_axes.h"
#include "render_client/look/hud/hud_signs.h"

namespace bonemill {
namespace {

OrientationAxes seenFrom(double azimuth, double elevation) {
    return {viewAxes(azimuth, elevation, Eigen::Vector3d::UnitZ()).transpose().cast<float>(), true};
}

OrientationEnd endOf(const OrientationAxes& axes, char letter) {
    const auto ends = orientationEnds(axes);
    return *std::ranges::find(ends, letter, &OrientationEnd::letter);
}

// The eye in front of the patient sees the patient's right on its left, as a physician does.
TEST(OrientationMarker, FromTheFrontThePatientsRightIsAtTheLeft) {
    const OrientationAxes front = seenFrom(0, 0);
    EXPECT_NEAR(endOf(front, 'R').towards.x(), -1, 1e-6);
    EXPECT_NEAR(endOf(front, 'L').towards.x(), 1, 1e-6);
    EXPECT_NEAR(endOf(front, 'S').towards.y(), 1, 1e-6);
    EXPECT_NEAR(endOf(front, 'I').towards.y(), -1, 1e-6);
    EXPECT_NEAR(endOf(front, 'A').nearness, 1, 1e-6);
    EXPECT_NEAR(endOf(front, 'P').nearness, -1, 1e-6);
}

TEST(OrientationMarker, FromTheLeftTheFaceLooksToTheLeft) {
    const OrientationAxes left = seenFrom(std::numbers::pi / 2, 0);
    EXPECT_NEAR(endOf(left, 'L').nearness, 1, 1e-6);
    EXPECT_NEAR(endOf(left, 'A').towards.x(), -1, 1e-6);
    EXPECT_NEAR(endOf(left, 'P').towards.x(), 1, 1e-6);
}

TEST(OrientationMarker, FromAboveTheNoseIsBelow) {
    const OrientationAxes above = seenFrom(0, std::numbers::pi / 2);
    EXPECT_NEAR(endOf(above, 'S').nearness, 1, 1e-3);
    EXPECT_NEAR(endOf(above, 'A').towards.y(), -1, 1e-3);
}

TEST(OrientationMarker, TheFarthestEndComesFirst) {
    const auto ends = orientationEnds(seenFrom(0.4, 0.3));
    ASSERT_EQ(ends.size(), 6u);
    EXPECT_TRUE(std::ranges::is_sorted(ends, {}, &OrientationEnd::nearness));
}

TEST(OrientationMarker, WithoutAPatientItNamesTheVolumesAxes) {
    OrientationAxes axes = seenFrom(0, 0);
    axes.are_patients = false;
    ASSERT_EQ(orientationEnds(axes).size(), 3u);
    EXPECT_NEAR(endOf(axes, 'x').towards.x(), 1, 1e-6);
    EXPECT_NEAR(endOf(axes, 'z').towards.y(), 1, 1e-6);
    EXPECT_NEAR(endOf(axes, 'y').nearness, -1, 1e-6);
}

TEST(OrientationMarker, StaysInTheLowerRightCornerAndIsSmall) {
    const FontAtlas font(11);
    HudCanvas canvas(font);
    const PictureSize picture{1280, 800};
    layOutOrientation(canvas, seenFrom(0.6, 0.4), picture);
    ASSERT_FALSE(canvas.vertices().empty());
    for (const auto& vertex : canvas.vertices()) {
        EXPECT_GT(vertex.x, 1280 * 0.9f);
        EXPECT_LT(vertex.x, 1280);
        EXPECT_GT(vertex.y, 800 * 0.8f);
        EXPECT_LT(vertex.y, 800 - 3 * font.pixelHeight()) << "the scale bar is there";
    }
}

TEST(OrientationMarker, ASmallPictureHasNone) {
    const FontAtlas font(11);
    HudCanvas canvas(font);
    layOutOrientation(canvas, seenFrom(0.6, 0.4), {200, 200});
    EXPECT_TRUE(canvas.vertices().empty());
}

// The two letters of an axis that points at the eye would lie over each other: the near one is written.
TEST(OrientationMarker, ALetterBehindAnotherIsNotWritten) {
    const FontAtlas font(11);
    HudCanvas straight(font), oblique(font);
    layOutOrientation(straight, seenFrom(0, 0), {1280, 800});
    layOutOrientation(oblique, seenFrom(0.6, 0.5), {1280, 800});
    const auto letters = [](const HudCanvas& canvas) {  // each is there with its rim, twice
        return std::ranges::count_if(canvas.vertices(), [](const auto& v) { return v.radius < 0; }) / (3 * 6);
    };
    EXPECT_EQ(letters(oblique), 6);
    EXPECT_EQ(letters(straight), 5);
}

}  // namespace
}  // namespace bonemill
