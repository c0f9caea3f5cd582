#include "render_client/look/visual_effects/surface_film.h"

#include <gtest/gtest.h>

#include <algorithm>

namespace bonemill {
namespace {

constexpr float kCell = 2e-4f;

Eigen::AlignedBox3f around(const std::vector<Eigen::AlignedBox3f>& boxes) {
    Eigen::AlignedBox3f all;
    for (const auto& box : boxes) all.extend(box);
    return all;
}

bool isIn(const Eigen::Vector3f& p_V, const std::vector<Eigen::AlignedBox3f>& boxes) {
    return std::ranges::any_of(boxes, [&](const auto& box) { return box.contains(p_V); });
}

TEST(SurfaceFilm, holdsNothingBeforeItIsPlaced) {
    SurfaceFilm film(kCell);
    film.add(SurfaceFilm::kBlood, {0, 0, 0}, 1, kCell);
    EXPECT_EQ(film.at(SurfaceFilm::kBlood, {0, 0, 0}), 0);
    EXPECT_TRUE(film.shownBox().isEmpty());
}

TEST(SurfaceFilm, keepsWhatTheGridStillHoldsAndForgetsTheRest) {
    SurfaceFilm film(kCell);
    film.centreOn({0, 0, 0});
    const Eigen::Vector3f left(-25 * kCell, 0, 0), right(25 * kCell, 0, 0);
    for (const auto& p : {left, right}) film.add(SurfaceFilm::kWater, p, 1, 2 * kCell);
    const float before = film.at(SurfaceFilm::kWater, right);
    ASSERT_GT(before, 0.5f);
    film.centreOn({20 * kCell, 0, 0});
    EXPECT_EQ(film.at(SurfaceFilm::kWater, right), before);
    EXPECT_FALSE(film.holds(left));
    film.centreOn({0, 0, 0});
    EXPECT_EQ(film.at(SurfaceFilm::kWater, left), 0);
    EXPECT_EQ(film.at(SurfaceFilm::kBlood, right), 0);
}

TEST(SurfaceFilm, saysWhereItChanged) {
    SurfaceFilm film(kCell);
    film.centreOn({0, 0, 0});
    film.takeChanged();
    film.takeChangedSlices();
    const Eigen::Vector3f p(3.5f * kCell, 0.5f * kCell, -0.5f * kCell);
    film.add(SurfaceFilm::kBlood, p, 0.5f, kCell);
    const Eigen::AlignedBox3f changed = around(film.takeChanged());
    EXPECT_TRUE(changed.contains(p));
    EXPECT_LT(changed.sizes().maxCoeff(), 6 * kCell);
    const auto slices = film.takeChangedSlices();
    EXPECT_TRUE(slices[SurfaceFilm::kCells - 1]);  // z = -1, wrapped
    EXPECT_LE(slices.count(), 3u);
    EXPECT_TRUE(film.takeChanged().empty());
}

TEST(SurfaceFilm, saysOfPlacesFarApartThatOnlyTheyChanged) {
    SurfaceFilm film(kCell);
    film.centreOn({0, 0, 0});
    film.takeChanged();
    const Eigen::Vector3f left(-20 * kCell, 0, 0), right(20 * kCell, 0, 0);
    for (const auto& p : {left, right}) film.add(SurfaceFilm::kBlood, p, 1, kCell);
    const auto changed = film.takeChanged();
    EXPECT_TRUE(isIn(left, changed));
    EXPECT_TRUE(isIn(right, changed));
    EXPECT_FALSE(isIn(Eigen::Vector3f(5 * kCell, 0, 0), changed));
}

TEST(SurfaceFilm, saysWhatTheGridLeavesBehind) {
    SurfaceFilm film(kCell);
    film.centreOn({0, 0, 0});
    const Eigen::Vector3f border(-30.5f * kCell, 0, 0), middle(5 * kCell, 0, 0), corner(31.5f * kCell, 0, 0);
    for (const auto& p : {border, middle, corner}) film.add(SurfaceFilm::kBlood, p, 1, kCell);
    film.takeChanged();
    film.centreOn({20 * kCell, 0, 0});
    const auto changed = film.takeChanged();
    EXPECT_TRUE(isIn(border, changed)) << "it is gone";
    EXPECT_TRUE(isIn(corner, changed)) << "the film ended before it";
    EXPECT_FALSE(isIn(middle, changed));
}

TEST(SurfaceFilm, staysBetweenNothingAndFull) {
    SurfaceFilm film(kCell);
    film.centreOn({0, 0, 0});
    for (int n = 0; n < 10; ++n) film.add(SurfaceFilm::kBlood, {0, 0, 0}, 3, 3 * kCell);
    EXPECT_EQ(film.at(SurfaceFilm::kBlood, {0, 0, 0}), 1);
    for (int n = 0; n < 100; ++n) film.scaleAll(SurfaceFilm::kBlood, 0.9f);
    EXPECT_EQ(film.at(SurfaceFilm::kBlood, {0, 0, 0}), 0);
}

}  // namespace
}  // namespace bonemill
