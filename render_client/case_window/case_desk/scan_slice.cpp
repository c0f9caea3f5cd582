#include "render_client/case_window/case_desk/scan_slice.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <span>

#include "haptic_server/scans/densify/region.h"
#include "render_client/link/density_store/density_store.h"
#include "render_client/look/slices/slice_image.h"

namespace bonemill {
namespace {

constexpr double kMargin = 1.06;
constexpr double kInset = 14;  // pixels from the pane's edge to a handle's middle

constexpr float kNothing = std::numeric_limits<float>::quiet_NaN();
constexpr float kLineReach = 1.3f;  // pixels to each side, fading
constexpr double kTintShare = 0.45;

bool isInside(const Eigen::Vector3d& voxel, const Eigen::Vector3i& dims) {
    return (voxel.array() > -0.5).all() && (voxel.array() < dims.cast<double>().array() - 0.5).all();
}

// Voxel coordinates along the rows of a picture.
class VoxelWalk {
  public:
    VoxelWalk(const SlicePlane& plane, const Eigen::Vector3d& spacing)
        : corner_(plane.corner_V.cwiseQuotient(spacing)),
          right_(plane.right_V.cwiseQuotient(spacing)),
          down_(plane.down_V.cwiseQuotient(spacing)) {}
    Eigen::Vector3d at(int x, int y) const { return corner_ + x * right_ + y * down_; }

  private:
    Eigen::Vector3d corner_, right_, down_;
};

template <class T>
float trilinear(std::span<const T> values, const Eigen::Vector3i& dims, const Eigen::Vector3d& voxel) {
    if (!isInside(voxel, dims)) return kNothing;
    const Eigen::Vector3d v = voxel.cwiseMax(0.0).cwiseMin((dims.cast<double>().array() - 1).matrix());
    const Eigen::Vector3i low = v.cast<int>(), high = (low.array() + 1).min(dims.array() - 1);
    const Eigen::Vector3f t = (v - low.cast<double>()).cast<float>();
    const size_t row = size_t(dims.x()), slice = row * size_t(dims.y());
    const auto along = [&](int j, int k) {
        const T* const line = values.data() + row * size_t(j) + slice * size_t(k);
        return float(line[low.x()]) + t.x() * (float(line[high.x()]) - float(line[low.x()]));
    };
    const float front =
        along(low.y(), low.z()) + t.y() * (along(high.y(), low.z()) - along(low.y(), low.z()));
    const float back =
        along(low.y(), high.z()) + t.y() * (along(high.y(), high.z()) - along(low.y(), high.z()));
    return front + t.z() * (back - front);
}

std::vector<float> valuesOn(const RawVolume& scan, const SlicePlane& plane) {
    std::vector<float> values(size_t(plane.width) * size_t(plane.height));
    const VoxelWalk walk(plane, scan.geometry.spacing);
    scan.values.visit([&]<class T>(std::span<const T> samples) {
        size_t n = 0;
        for (int y = 0; y < plane.height; ++y)
            for (int x = 0; x < plane.width; ++x)
                values[n++] = trilinear(samples, scan.geometry.dims, walk.at(x, y));
    });
    return values;
}

void mix(uint8_t* pixel, const Rgb& colour, double share) {
    for (size_t c = 0; c < 3; ++c)
        pixel[c] = uint8_t(std::lround((1 - share) * pixel[c] + share * colour[c]));
}

void paintGrey(const std::vector<float>& values, const GreyWindow& window, RgbaImage& image) {
    for (size_t n = 0; n < values.size(); ++n) {
        uint8_t* const pixel = image.rgba.data() + 4 * n;
        const double grey = std::isnan(values[n]) ? 0 : greyOf(window, double(values[n]));
        std::fill_n(pixel, 3, uint8_t(std::lround(255 * grey)));
        pixel[3] = 255;
    }
}

void tintLabels(const RawVolume& scan, const SlicePlane& plane, const SliceLook& look, RgbaImage& image) {
    const RawVolume& map = *look.labels;
    const Eigen::Affine3d to_map = indexMap(scan.geometry, map.geometry);
    const VoxelWalk walk(plane, scan.geometry.spacing);
    const Eigen::Vector3i& dims = map.geometry.dims;
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const Eigen::Vector3d voxel = to_map * walk.at(x, y);
            if (!isInside(voxel, dims)) continue;
            const Eigen::Vector3i v = voxel.array().round().cast<int>();
            const size_t n =
                size_t(v.x()) + size_t(dims.x()) * (size_t(v.y()) + size_t(dims.y()) * size_t(v.z()));
            const float label = map.values[n];
            const auto tint = label > 0 ? look.label_tints.find(uint32_t(label)) : look.label_tints.end();
            if (tint == look.label_tints.end()) continue;
            mix(image.rgba.data() + 4 * (size_t(y) * size_t(image.width) + size_t(x)), tint->second,
                kTintShare);
        }
}

// How much of a pixel the line at `iso` covers: by its distance, which value and slope tell.
double lineShare(const std::vector<float>& values, int width, int height, int x, int y, float iso) {
    const auto at = [&](int u, int v) {
        return values[size_t(std::clamp(v, 0, height - 1)) * size_t(width) +
                      size_t(std::clamp(u, 0, width - 1))];
    };
    const float here = at(x, y);
    const float slope = std::hypot(at(x + 1, y) - at(x - 1, y), at(x, y + 1) - at(x, y - 1)) / 2;
    if (!(slope > 0)) return 0;  // also beside what lies outside
    return double(std::clamp(kLineReach - std::abs(here - iso) / slope, 0.f, 1.f));
}

// Is the voxel's bone, or that of one beside it, part of the case?
bool isKept(const CaseBone& bone, const Eigen::Vector3d& voxel) {
    const Eigen::Vector3i v = voxel.array().round().cast<int>();
    const VoxelVolume& volume = bone.volume;
    const Eigen::Vector3i low = (v.array() - 1).max(0), high = (v.array() + 1).min(volume.dims().array() - 1);
    for (int k = low.z(); k <= high.z(); ++k)
        for (int j = low.y(); j <= high.y(); ++j)
            for (int i = low.x(); i <= high.x(); ++i)
                if (volume.at(i, j, k) >= volume.iso()) return true;
    return false;
}

void paintLine(const RawVolume& scan, const std::vector<float>& values, const SlicePlane& plane,
               const SliceLook& look, RgbaImage& image) {
    const VoxelWalk walk(plane, scan.geometry.spacing);
    for (int y = 0; y < image.height; ++y)
        for (int x = 0; x < image.width; ++x) {
            const double share = lineShare(values, image.width, image.height, x, y, float(*look.iso));
            if (share <= 0) continue;
            const bool is_kept = !look.bone || isKept(*look.bone, walk.at(x, y));
            mix(image.rgba.data() + 4 * (size_t(y) * size_t(image.width) + size_t(x)),
                is_kept ? kBoneLine : kLeftOutLine, is_kept ? share : share * 0.6);
        }
}

}  // namespace

Eigen::Vector2d ScanPane::toPixel(const Eigen::Vector3d& p_W) const {
    const SliceView& view = sliceViewOf(axis);
    const Eigen::Vector3d from_middle = (p_W - middle_W) / metres_per_pixel;
    return {width / 2.0 + view.right_W.dot(from_middle), height / 2.0 + view.down_W.dot(from_middle)};
}

Eigen::Vector3d ScanPane::toWorld(const Eigen::Vector2d& pixel) const {
    const SliceView& view = sliceViewOf(axis);
    return middle_W + metres_per_pixel * ((pixel.x() - width / 2.0) * view.right_W +
                                          (pixel.y() - height / 2.0) * view.down_W);
}

Eigen::Vector3d ScanPane::moved(const Eigen::Vector3d& p_W, const Eigen::Vector2d& pixel) const {
    Eigen::Vector3d to = toWorld(pixel);
    to[Eigen::Index(axis)] = p_W[Eigen::Index(axis)];
    return to;
}

SlicePlane ScanPane::plane(const Pose& X_WV) const {
    return slicePlane(X_WV, axis, middle_W, metres_per_pixel, width, height);
}

DensityGrid gridOf(const VolumeGeometry& geometry) {
    DensityGrid grid{};
    grid.voxels = geometry.dims;
    grid.spacing_m = geometry.spacing;
    grid.origin_m.setZero();
    return grid;
}

Eigen::AlignedBox3d boxOfScan(const VolumeGeometry& geometry) {
    return scanBox(gridOf(geometry), geometry.X_WV);
}

ScanPane paneOver(const Eigen::AlignedBox3d& box_W, size_t axis, int width, int height, double zoom,
                  const Eigen::Vector3d& middle_W) {
    const SliceView& view = sliceViewOf(axis);
    const Eigen::Vector3d size = box_W.sizes();
    const double right = std::abs(view.right_W.dot(size)), down = std::abs(view.down_W.dot(size));
    ScanPane pane{axis, std::max(width, 1), std::max(height, 1), box_W.center(), 1};
    pane.metres_per_pixel = kMargin * std::max(right / pane.width, down / pane.height) / zoom;
    if (zoom > 1) pane.middle_W = middle_W;
    pane.middle_W[Eigen::Index(axis)] = middle_W[Eigen::Index(axis)];
    return pane;
}

Eigen::Vector2d handleOf(const ScanPane& pane, const Eigen::Vector3d& start_W,
                         const Eigen::Vector3d& hand_W) {
    const Eigen::Vector2d start = pane.toPixel(start_W), way = pane.toPixel(hand_W) - start;
    const Eigen::Vector2d low = Eigen::Vector2d::Constant(kInset),
                          high = Eigen::Vector2d(pane.width, pane.height) - low;
    double share = 1;
    for (Eigen::Index i = 0; i < 2; ++i) {
        const double end = start[i] + way[i], nearest = std::clamp(end, low[i], high[i]);
        if (end != nearest && way[i] != 0) share = std::min(share, (nearest - start[i]) / way[i]);
    }
    return start + std::max(share, 0.0) * way;
}

Eigen::Vector3d turnedHand(const ScanPane& pane, const Eigen::Vector3d& start_W,
                           const Eigen::Vector3d& hand_W, const Eigen::Vector2d& pixel) {
    const Eigen::Index along = Eigen::Index(pane.axis);
    const Eigen::Vector3d outwards = (hand_W - start_W).normalized();
    Eigen::Vector3d flat = pane.moved(start_W, pixel) - start_W;
    const double reach = flat.norm() / (hand_W - start_W).norm();
    if (reach < 1e-3) return outwards;
    Eigen::Vector3d in_plane = outwards;
    in_plane[along] = 0;
    const double lean = std::clamp(std::max(in_plane.norm(), reach), 0.0, 1.0);
    Eigen::Vector3d turned = lean * flat.normalized();
    turned[along] = std::copysign(std::sqrt(1 - lean * lean), outwards[along]);
    return turned;
}

Grip gripAt(const ScanPane& pane, const CaseMarks& marks, const Eigen::Vector2d& pixel, double reach) {
    const auto isNear = [&](const Eigen::Vector3d& p_W) {
        return (pane.toPixel(p_W) - pixel).norm() <= reach;
    };
    if (marks.start_W && marks.hand_W &&
        (handleOf(pane, *marks.start_W, *marks.hand_W) - pixel).norm() <= reach)
        return Grip::kHand;
    if (marks.region_W && isNear(marks.region_W->center())) return Grip::kRegion;
    return Grip::kCross;
}

RgbaImage drawSlice(const RawVolume& scan, const SlicePlane& plane, const SliceLook& look) {
    const std::vector<float> values = valuesOn(scan, plane);
    RgbaImage image{plane.width, plane.height, std::vector<uint8_t>(4 * values.size())};
    paintGrey(values, look.window, image);
    if (look.labels) tintLabels(scan, plane, look, image);
    if (look.iso) paintLine(scan, values, plane, look, image);
    return image;
}

}  // namespace bonemill
