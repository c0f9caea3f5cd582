#include "haptic_server/assessment/product/deviation.h"

#include <array>
#include <limits>

#include "common/base/units.h"
#include "common/picture/picture.h"
#include "haptic_server/assessment/product/signed_field.h"
#include "haptic_server/surface/mesh/leaf_mesher.h"

namespace bonemill {
namespace {

constexpr int kCutLeafCells = 16;

bool isNearChange(const Eigen::Vector3d& p_V, const ChangeGrid& changes) {
    const Eigen::Vector3i low = (p_V.array() / changes.spacing().array()).floor().cast<int>();
    for (int corner = 0; corner < 8; ++corner)
        if (changes.isChangedOrIdeal(low + Eigen::Vector3i(corner & 1, corner >> 1 & 1, corner >> 2)))
            return true;
    return false;
}

void addPieces(const NodeMesh& mesh, const MeshGrid& grid, const ChangeGrid& changes,
               std::vector<CutPiece>& pieces) {
    for (size_t n = 0; n + 2 < mesh.indices.size(); n += 3) {
        Eigen::Vector3d corner[3];
        for (size_t c = 0; c < 3; ++c)
            corner[c] = grid.position(grid.stepsOf(mesh.leaf, mesh.vertices[mesh.indices[n + c]]));
        const Eigen::Vector3d center = (corner[0] + corner[1] + corner[2]) / 3;
        const Eigen::Vector3d across = (corner[1] - corner[0]).cross(corner[2] - corner[0]);
        const double area = across.norm() / 2;
        if (area > 0) pieces.push_back({center, across / (2 * area), area, isNearChange(center, changes)});
    }
}

constexpr int kMaxPixels = 480;  // per side
constexpr double kFineScale = 1e-3, kScaleVoxels = 3;

using PaintRgb = std::array<double, 3>;
constexpr PaintRgb kPaper{255, 255, 255}, kBone{228, 220, 200}, kRight{150, 200, 150}, kTooFar{205, 40, 30},
    kNotFar{40, 80, 205};

PaintRgb mixOf(const PaintRgb& a, const PaintRgb& b, double share) {
    PaintRgb mixed;
    for (size_t n = 0; n < mixed.size(); ++n) mixed[n] = a[n] + share * (b[n] - a[n]);
    return mixed;
}

// Orthographic, with the nearest piece in each pixel.
class Canvas {
  public:
    Canvas(const Eigen::AlignedBox2d& window, double pixel)
        : low_(window.min()),
          pixel_(pixel),
          size_(((window.sizes() / pixel).array().ceil()).cast<int>() + 1) {
        depth_.assign(size_t(size_.prod()), std::numeric_limits<double>::infinity());
        colour_.assign(depth_.size(), kPaper);
    }
    void splat(const Eigen::Vector2d& at, double depth, double radius, const PaintRgb& colour) {
        const Eigen::Array2d middle = (at - low_).array() / pixel_;
        const int reach = int(std::ceil(radius / pixel_));
        const Eigen::Array2i pixel = middle.round().cast<int>();
        for (int j = pixel.y() - reach; j <= pixel.y() + reach; ++j)
            for (int i = pixel.x() - reach; i <= pixel.x() + reach; ++i) {
                if (i < 0 || j < 0 || i >= size_.x() || j >= size_.y()) continue;
                if ((Eigen::Array2d(i, j) - middle).matrix().norm() * pixel_ > radius) continue;
                const size_t n = size_t(i) + size_t(size_.x()) * size_t(j);
                if (depth >= depth_[n]) continue;
                depth_[n] = depth;
                colour_[n] = colour;
            }
    }
    std::string png() const {
        Picture picture(size_.x(), size_.y());
        for (int j = 0; j < size_.y(); ++j) {
            uint8_t* byte = picture.row(size_.y() - 1 - j);  // the picture's first row is the highest
            for (int i = 0; i < size_.x(); ++i)
                for (const double part : colour_[size_t(i) + size_t(size_.x()) * size_t(j)])
                    *byte++ = uint8_t(std::lround(part));
        }
        return pngOf(picture);
    }

  private:
    Eigen::Vector2d low_;
    double pixel_;
    Eigen::Array2i size_;
    std::vector<double> depth_;
    std::vector<PaintRgb> colour_;
};

struct View {
    Eigen::Vector3d right, up, into;

    explicit View(const Eigen::Vector3d& approach_V) : into(approach_V) {
        const Eigen::Vector3d upright =
            std::abs(into.z()) < 0.9 ? Eigen::Vector3d::UnitZ() : Eigen::Vector3d::UnitY();
        right = into.cross(upright).normalized();
        up = right.cross(into);
    }
    Eigen::Vector2d place(const Eigen::Vector3d& p) const { return {right.dot(p), up.dot(p)}; }
    PaintRgb shaded(const PaintRgb& colour, const Eigen::Vector3d& normal) const {
        const double light = 0.45 + 0.55 * std::max(0.0, -normal.dot(into));
        return mixOf({0, 0, 0}, colour, light);
    }
};

PaintRgb colourOf(double distance, double scale) {
    const double share = std::min(1.0, std::abs(distance) / scale);
    return mixOf(kRight, distance > 0 ? kTooFar : kNotFar, share);
}

constexpr int kDeviationVersion = 1;

void addOneSide(const WeightedSample& sample, const std::string& id, const std::string& label,
                Figures& figures) {
    const auto add = [&](const char* what, const char* text, double value) {
        figures.push_back(
            {id + "." + what, kDeviationVersion, label + ", " + text, value * kPerMillimetre, "mm"});
    };
    add("mean", "mean", sample.isEmpty() ? 0 : sample.mean());
    add("sd", "SD", sample.isEmpty() ? 0 : sample.deviation());
    add("p95", "95 %", sample.isEmpty() ? 0 : sample.percentile(0.95));
    add("max", "most", sample.isEmpty() ? 0 : sample.percentile(1));
}

}  // namespace

ChangeGrid::ChangeGrid(const IndexBox& box, const VoxelVolume& scanned, const VoxelVolume& now,
                       const JudgedTask& task)
    : box_(box), size_(box.max - box.min + Eigen::Vector3i::Ones()), spacing_(scanned.spacing()) {
    bits_.reserve(size_t(box.count()));
    const Density iso = scanned.iso();
    forEachIndex(box, [&](const Eigen::Vector3i& v) {
        const bool was = scanned.at(v.x(), v.y(), v.z()) >= iso, is = now.at(v.x(), v.y(), v.z()) >= iso;
        const bool is_ideal = was && task.isIdeal(v);
        bits_.push_back(uint8_t((was ? kWasBone : 0) | (is ? kIsBone : 0) | (is_ideal ? kIsIdeal : 0)));
    });
}

std::vector<CutPiece> surfaceIn(const VoxelVolume& now, const ChangeGrid& changes) {
    std::vector<CutPiece> pieces;
    const LeafLattice lattice(now, Eigen::Vector3i::Constant(kCutLeafCells));
    const MeshGrid grid(now, lattice);
    LeafMesher mesher(now, lattice);
    forEachIndex(lattice.leavesOfCells(changes.box().grown(1)), [&](const Eigen::Vector3i& leaf) {
        const auto mesh = mesher.mesh(lattice.leafId(leaf));
        if (mesh) addPieces(*mesh, grid, changes, pieces);
    });
    return pieces;
}

DeviationPicture drawDeviation(const Deviation& deviation, const std::vector<CutPiece>& context,
                               const Eigen::Vector3d& approach_V, double voxel) {
    DeviationPicture picture;
    if (deviation.pieces.empty()) return picture;
    picture.scale = std::max(kFineScale, kScaleVoxels * voxel);
    const View view(approach_V);
    Eigen::AlignedBox2d window;
    for (const CutPiece& piece : deviation.pieces) window.extend(view.place(piece.center_V));
    const Eigen::Vector2d rim = Eigen::Vector2d::Constant(6 * voxel);
    window = {window.min() - rim, window.max() + rim};
    const double pixel = std::max(voxel / 16, window.sizes().maxCoeff() / kMaxPixels);
    Canvas canvas(window, pixel);
    const double radius = std::max(0.8 * voxel, pixel);
    const auto draw = [&](const CutPiece& piece, const PaintRgb& colour) {
        if (piece.normal_V.dot(view.into) > 0) return;  // seen from behind
        canvas.splat(view.place(piece.center_V), view.into.dot(piece.center_V), radius,
                     view.shaded(colour, piece.normal_V));
    };
    for (size_t n = 0; n < deviation.pieces.size(); ++n)
        draw(deviation.pieces[n], colourOf(deviation.distance[n], picture.scale));
    for (const CutPiece& piece : context)
        if (!piece.is_judged) draw(piece, kBone);
    picture.png = canvas.png();
    return picture;
}

Deviation deviationOf(const ChangeGrid& changes, const std::vector<CutPiece>& pieces) {
    const SignedField ideal(changes.box(), changes.spacing(),
                            [&](const Eigen::Vector3i& v) { return changes.staysIdeally(v); });
    Deviation deviation;
    for (const CutPiece& piece : pieces) {
        if (!piece.is_judged) continue;
        const double distance = ideal.at(piece.center_V);
        if (!std::isfinite(distance)) continue;
        deviation.distance.push_back(distance);
        deviation.pieces.push_back(piece);
    }
    return deviation;
}

void addDeviationFigures(const Deviation& deviation, Figures& figures) {
    if (deviation.pieces.empty()) return;
    WeightedSample over, under;
    for (size_t n = 0; n < deviation.pieces.size(); ++n) {
        const double distance = deviation.distance[n], area = deviation.pieces[n].area;
        if (distance > 0) over.add(distance, area);
        if (distance < 0) under.add(-distance, area);
    }
    addOneSide(over, "overcut", "Cut too far", figures);
    addOneSide(under, "undercut", "Not cut far enough", figures);
}

}  // namespace bonemill
