#include "render_client/look/slices/slice_image.h"

#include <gtest/gtest.h>

#include <cmath>

#include "render_client/look/slices/slice_plane.h"
#include "tests/unit/render_client/look/slices/sliced_volume.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;
using test::SlicedVolume;

constexpr int kPaneWidth = 83, kPaneHeight = 71;
const GreyWindow kWindow{2500, 700}, kOtherWindow{2500, 780};

// What the pane is held against.
enum class Against { kTruth, kMirrored, kUpsideDown, kTransposed, kOtherSlice, kOtherWindow };

// Returns the place (W) that the convention gives a pixel, from the burr, whose place in the pane is known.
Vector3d placeOf(const Pane& pane, const Vector3d& burr_W, int column, int row) {
    const double right = (column + 0.5 - pane.cross->x()) * pane.metres_per_pixel;
    const double down = (row + 0.5 - pane.cross->y()) * pane.metres_per_pixel;
    Vector3d p_W = burr_W;
    p_W[Eigen::Index(pane.axis)] = pane.position_W;
    if (pane.axis == 0) return p_W + Vector3d(0, right, -down);  // anterior at the left, head on top
    if (pane.axis == 1) return p_W + Vector3d(right, 0, -down);  // the patient's right at the left
    return p_W + Vector3d(right, down, 0);                       // and anterior on top
}

// Returns what a pixel at that place (V) must look like; nothing where rounding decides which tint it has.
std::optional<std::array<double, 3>> expectedColour(const SlicedVolume& volume, const Vector3d& p_V,
                                                    const GreyWindow& window) {
    const Vector3d voxel = (p_V - volume.grid.origin_m).cwiseQuotient(volume.grid.spacing_m);
    const Vector3d end = volume.grid.voxels.cast<double>().array() - 0.5;
    if ((voxel.array() < -0.5).any() || (voxel.array() > end.array()).any())
        return std::array<double, 3>{0, 0, 0};
    const double scanned = volume.at(volume.scanned, p_V), present = volume.at(volume.present, p_V);
    const double grey = 255 * greyOf(window, valueOf(volume.grid, scanned));
    const double iso = densityOf(volume.grid, volume.grid.iso_value);
    if (std::abs(scanned - iso) < 1 || std::abs(present - iso) < 1) return std::nullopt;
    if ((scanned >= iso) == (present >= iso)) return std::array<double, 3>{grey, grey, grey};
    const Rgb& tint = scanned >= iso ? kMilledTint : kAddedTint;
    std::array<double, 3> colour;
    for (size_t c = 0; c < 3; ++c) colour[c] = kSliceTintGrey * grey + (1 - kSliceTintGrey) * tint[c];
    return colour;
}

// Compares random pixels of the panes with the volume. Returns how many of them are off by more than one
// grey level.
int wrongPixels(const Pose& X_WV, double zoom, int count, Against against) {
    const SlicedVolume volume;
    DensityStore store;
    volume.putAll(store);
    SliceSettings settings;
    settings.zoom = zoom;
    const Eigen::AlignedBox3d box_W = scanBox(volume.grid, X_WV);
    const SliceBurr burr{box_W.center() + 0.1 * box_W.sizes(), 2e-3};
    std::mt19937 random(11);
    int wrong = 0;
    for (size_t axis = 0; axis < 3; ++axis) {
        const PaneRect rect{700, 8, kPaneWidth, kPaneHeight};
        const Pane pane = makePane(volume.grid, X_WV, settings, axis, rect, burr);
        const auto rgba = coloursOf(DensitySampler(store).image(pane.plane), volume.grid, kWindow);
        for (int n = 0; n < count / 3; ++n) {
            int column = int(random() % kPaneWidth), row = int(random() % kPaneHeight);
            const uint8_t* const shown = &rgba[size_t(4 * (kPaneWidth * row + column))];
            if (against == Against::kMirrored) column = kPaneWidth - 1 - column;
            if (against == Against::kUpsideDown) row = kPaneHeight - 1 - row;
            if (against == Against::kTransposed) std::swap(column, row);
            Vector3d p_W = placeOf(pane, burr.p_W, column, row);
            if (against == Against::kOtherSlice)
                p_W[Eigen::Index(axis)] += sliceStep(volume.grid, X_WV, axis);
            const auto expected = expectedColour(volume, X_WV.inverse() * p_W,
                                                 against == Against::kOtherWindow ? kOtherWindow : kWindow);
            bool is_wrong = false;
            for (size_t c = 0; c < 3 && expected; ++c)
                is_wrong = is_wrong || std::abs(shown[c] - (*expected)[c]) > 1;
            wrong += is_wrong;
        }
    }
    return wrong;
}

TEST(SliceImage, TenThousandPixelsAreTheVolumesOwn) {
    EXPECT_EQ(wrongPixels(Pose(), 1, 10000, Against::kTruth), 0);
    EXPECT_EQ(wrongPixels(test::turned({0, 0, M_PI / 2}), 3, 10000, Against::kTruth), 0);
    EXPECT_EQ(wrongPixels(test::turned({0.5, -0.3, 0.9}), 1, 10000, Against::kTruth), 0);
}

TEST(SliceImage, TheComparisonSeesAWrongPicture) {
    for (const Against against : {Against::kMirrored, Against::kUpsideDown, Against::kTransposed,
                                  Against::kOtherSlice, Against::kOtherWindow})
        EXPECT_GT(wrongPixels(Pose(), 1, 2000, against), 600) << int(against);
}

TEST(SliceImage, WhatHasNotArrivedSaysSo) {
    const SlicedVolume volume;
    DensityStore store;
    store.setGrid(volume.grid);
    const Eigen::AlignedBox3d box_W = scanBox(volume.grid, Pose());
    const double middle = nearestSlice(volume.grid, Pose(), 2, box_W.center().z());
    const SlicePlane plane = facePlane(volume.grid, Pose(), 2, middle, box_W, 500);
    const auto countOf = [&](SliceState state) {
        return std::ranges::count(DensitySampler(store).image(plane).state, state);
    };
    EXPECT_EQ(countOf(SliceState::kHere), 0);
    const auto all = countOf(SliceState::kLoading);
    EXPECT_GT(all, 900);
    const uint32_t first = bricksOf(volume.grid, plane).front();
    store.put(first, volume.brick(first));
    EXPECT_GT(countOf(SliceState::kHere), 30);
    EXPECT_EQ(countOf(SliceState::kHere) + countOf(SliceState::kLoading), all);
}

TEST(SliceImage, PresentDensitiesAreNotTheScans) {
    const SlicedVolume volume;
    DensityStore store;
    volume.putAll(store);
    const DensitySampler sampler(store);
    std::mt19937 random(5);
    std::uniform_real_distribution<double> part(0, 1);
    int changed = 0;
    for (int n = 0; n < 1000; ++n) {
        const Vector3d voxel(36 * part(random), 28 * part(random), 22 * part(random));
        const Vector3d p_V = volume.grid.origin_m + volume.grid.spacing_m.cwiseProduct(voxel);
        const SampledDensity sample = sampler.at(p_V);
        ASSERT_EQ(sample.state, SliceState::kHere);
        ASSERT_NEAR(sample.scanned, volume.at(volume.scanned, p_V), 0.51);
        ASSERT_NEAR(sample.present, volume.at(volume.present, p_V), 0.51);
        ASSERT_TRUE(sample.was_changed || sample.scanned == sample.present);
        changed += sample.was_changed;
    }
    EXPECT_GT(changed, 100);
}

TEST(SliceImage, ABrickThatNothingChangedIsAsScanned) {
    const SlicedVolume volume;
    DensityStore store;
    store.setGrid(volume.grid);
    DensityBrick brick = volume.brick(0);
    brick.present.clear();
    store.put(0, brick);
    const SampledDensity sample = DensitySampler(store).at(volume.grid.origin_m + Vector3d::Constant(1e-3));
    EXPECT_EQ(sample.state, SliceState::kHere);
    EXPECT_EQ(sample.scanned, sample.present);
    EXPECT_FALSE(sample.was_changed);
}

// The denser of two neighbours says more: what bone fills only partly looks like something less dense.
TEST(SliceImage, HasTheColoursOfMaterials) {
    const SlicedVolume volume;
    DensityStore store;
    volume.putAll(store);
    BoneColours colours;
    colours.fill(Eigen::Vector3f::Constant(0.5f));
    colours[1] = {1, 0, 0.25f};
    colours[2] = {0, 1, 0.75f};
    const Pose X_WV = test::turned({0.3, -0.2, 0.5});
    const Eigen::AlignedBox3d box_W = scanBox(volume.grid, X_WV);
    const SlicePlane plane = facePlane(volume.grid, X_WV, 1, box_W.center().y(), box_W, 40);
    const SliceImage image = DensitySampler(store).image(plane, &colours);
    const SliceImage without = DensitySampler(store).image(plane);
    EXPECT_TRUE(without.colours.empty());
    EXPECT_EQ(without.present, image.present);
    ASSERT_EQ(image.colours.size(), 4 * image.state.size());
    int here = 0;
    for (size_t pixel = 0; pixel < image.state.size(); ++pixel) {
        const uint16_t* const colour = &image.colours[4 * pixel];
        if (image.state[pixel] != SliceState::kHere) {
            EXPECT_EQ(colour[0] + colour[1] + colour[2] + colour[3], 0);
            continue;
        }
        ++here;
        const int column = int(pixel) % plane.width, row = int(pixel) / plane.width;
        Vector3d sum = Vector3d::Zero();
        double weights = 0;
        volume.forEachCorner(plane.corner_V + column * plane.right_V + row * plane.down_V,
                             [&](size_t voxel, double weight) {
                                 weight *= 1.0 + volume.scanned[voxel];
                                 sum += weight * colours[volume.materials[voxel]].cast<double>();
                                 weights += weight;
                             });
        for (Eigen::Index c = 0; c < 3; ++c) EXPECT_NEAR(colour[c], 65535 * sum[c] / weights, 3);
        EXPECT_EQ(colour[3], 65535);
    }
    EXPECT_GT(here, 200);
}

}  // namespace
}  // namespace bonemill
