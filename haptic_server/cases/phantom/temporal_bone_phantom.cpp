#include "haptic_server/cases/phantom/temporal_bone_phantom.h"

#include <algorithm>
#include <cmath>
#include <span>

#include "common/base/units.h"
#include "common/process/work_ahead.h"
#include "haptic_server/cases/phantom/air_cells.h"
#include "haptic_server/cases/phantom/lattice_noise.h"
#include "haptic_server/cases/phantom/sided_grid.h"
#include "haptic_server/cases/phantom/temporal_shapes.h"
#include "haptic_server/core/volume/index_box.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;
using enum TemporalShape;
using Pneumatisation = TemporalBoneKind::Pneumatisation;

constexpr double kAirHu = -1000, kMuscleHu = 40, kBrainHu = 32, kFluidHu = 15;
constexpr double kCortexLowHu = 1500, kCortexHighHu = 1800, kSeptumHu = 1450;
constexpr double kCapsuleLowHu = 2000, kCapsuleHighHu = 2300, kOssicleHu = 1700;
constexpr double kMarrowLowHu = 250, kMarrowHighHu = 900, kScleroticLowHu = 1300, kScleroticHighHu = 1650;
constexpr double kDuraThickness = 1.0;
constexpr double kCapsule = 1.8;  // thickness of the otic capsule
constexpr double kBlurVoxels = 2.5;

double of(const TemporalDistances& d, TemporalShape shape) {
    return d[size_t(shape)];
}
double labyrinth(const TemporalDistances& d) {
    return std::min(of(d, kCanals), of(d, kInnerEar));
}

// The thickness of bone over cells swells and thins by some 30 %.
double swell(const Vector3d& p) {
    return 0.7 + 0.6 * smoothNoise(p + Vector3d(0, 0, 500), 4.5);
}

// How far behind the plates of bone that cells leave standing a place lies; negative in a plate.
double behindPlates(const Vector3d& p, const TemporalDistances& d, const TemporalMeasures& m) {
    const double factor = swell(p);
    const double tegmen = m.tegmen_plate * factor;
    double depth = std::min(-of(d, kOuter) - m.cortex * factor, -of(d, kBlock) - 1.5);
    depth = std::min({depth, of(d, kCranium) - tegmen, of(d, kSinus) - m.sinus_plate * factor,
                      of(d, kNerve) - 0.9, labyrinth(d) - kCapsule, of(d, kEarCanal) - 1.4 * factor});
    return std::min({depth, of(d, kCarotid) - 1.2, of(d, kMeatus) - 1.5, of(d, kMiddleEar) - 0.5});
}

// Cells reach from the antrum through the whole mastoid, or only a little way.
double pneumaticReach(Pneumatisation pneumatisation, const Vector3d& p, double to_antrum) {
    const double ragged = 3 * (smoothNoise(p + Vector3d(700, 0, 0), 3) - 0.5);
    switch (pneumatisation) {
        case Pneumatisation::kWell:
            return p.x() + 24 + ragged;
        case Pneumatisation::kPoor:
            return 4.5 + ragged - to_antrum;
        case Pneumatisation::kSclerotic:
            return 0.8 + ragged / 2 - to_antrum;
    }
    return 0;
}

// The middle ear and the antrum leave thinner plates than cells do.
double spacesDepth(const TemporalDistances& d, const TemporalMeasures& m) {
    const double plates =
        std::min({of(d, kCranium) - 0.8 * m.tegmen_plate, labyrinth(d) - 0.8, of(d, kNerve) - 0.35,
                  of(d, kSinus) - 0.8, -of(d, kBlock) - 1, -of(d, kOuter) - m.cortex});
    const double window =
        0.7 * smoothStep(1.2, 0.5, of(d, kOssicles));  // the footplate stands in the oval one
    const double middle = std::min(-of(d, kMiddleEar), plates + window);
    const double antrum = std::min({-of(d, kAntrum), plates, of(d, kEarCanal) - 0.9});
    return std::max(middle, antrum);
}

AirCells makeCells(const TemporalBoneKind& kind, const TemporalShapes& shapes) {
    AirCells::Region region;
    region.box = temporalBlock();
    region.depth = [&](const Vector3d& p) {
        const TemporalDistances d = shapes.distances(p);
        return std::min(behindPlates(p, d, shapes.measures()),
                        pneumaticReach(kind.pneumatisation, p, of(d, kAntrum)));
    };
    // Large cells lie above and in front, about the antrum, smaller ones towards the tip (Gray, Anatomy of
    // the Human Body, 1918).
    region.radius = [&](const Vector3d& p) {
        const double away = smoothStep(1, 16, shapes.distance(kAntrum, p));
        return 2.6 - 0.7 * away;
    };
    return AirCells(region, kind.seed);
}

Vector3d toLeft(const TemporalBoneKind& kind, const Vector3d& p_W) {
    const Vector3d p = p_W * kPerMillimetre;
    return kind.is_right ? Vector3d(-p.x(), p.y(), p.z()) : p;
}

// Makes the voxels of a cube: what is far from all of it keeps the distance of its middle.
class Cube {
  public:
    Cube(const TemporalBoneKind& kind, const TemporalShapes& shapes, const AirCells& cells,
         const Vector3d& middle, double half_diagonal)
        : kind_(kind), shapes_(shapes), cells_(cells), at_middle_(shapes.distances(middle)) {
        constexpr double kReach = 6.5, kSteepest = 1.4;
        for (size_t n = 0; n < kTemporalShapes; ++n)
            if (std::abs(at_middle_[n]) < kReach + kSteepest * half_diagonal)
                near_.push_back(TemporalShape(n));
        if (of(at_middle_, kOuter) < kSteepest * half_diagonal)
            near_seeds_ = cells.seedsNear(middle, half_diagonal);
    }

    struct Voxel {
        double hu;
        TemporalTissue tissue;
    };
    Voxel at(const Vector3d& p, double blur) const {
        TemporalDistances d = at_middle_;
        for (const TemporalShape shape : near_) d[size_t(shape)] = shapes_.distance(shape, p);
        return {huOf(p, d, blur), tissueOf(d)};
    }

  private:
    static double share(double depth, double blur) { return std::clamp(0.5 + depth / blur, 0.0, 1.0); }
    static double mixed(double from, double to, double share) { return from + share * (to - from); }

    double airDepth(const Vector3d& p, const TemporalDistances& d, double behind_plates) const {
        const double open = std::max(-of(d, kEarCanal), spacesDepth(d, shapes_.measures()));
        const double room = std::min(behind_plates, pneumaticReach(kind_.pneumatisation, p, of(d, kAntrum)));
        if (room < -1 || near_seeds_.empty()) return open;
        return std::max(open, blend(cells_.depth(p, near_seeds_), room, 0.5));
    }

    // Where cells do not reach there is marrow, or dense bone.
    double insideHu(const Vector3d& p, double reach, double grain, double drift) const {
        if (reach > 0.5) return kSeptumHu;
        const bool is_dense = kind_.pneumatisation == Pneumatisation::kSclerotic;
        const double marrow_noise = 0.7 * smoothNoise(p, 1.1) + 0.3 * grain;
        const double beyond = is_dense ? kScleroticLowHu + (kScleroticHighHu - kScleroticLowHu) * drift
                                       : kMarrowLowHu + (kMarrowHighHu - kMarrowLowHu) * marrow_noise;
        return mixed(beyond, kSeptumHu, smoothStep(-0.5, 0.5, reach));
    }

    double boneHu(const Vector3d& p, const TemporalDistances& d, double behind_plates) const {
        const double grain = smoothNoise(p, 0.8), drift = smoothNoise(p, 5);
        const double cortex = kCortexLowHu + (kCortexHighHu - kCortexLowHu) * (0.3 * grain + 0.7 * drift);
        const double reach = pneumaticReach(kind_.pneumatisation, p, of(d, kAntrum));
        const double inside = insideHu(p, reach, grain, drift);
        const double bone = mixed(cortex, inside, smoothStep(-0.2, 0.6, behind_plates));
        const double capsule = kCapsuleLowHu + (kCapsuleHighHu - kCapsuleLowHu) * grain;
        return mixed(bone, capsule, 1 - smoothStep(kCapsule - 0.6, kCapsule + 0.4, labyrinth(d)));
    }

    // What is drawn later covers what was drawn before it.
    double huOf(const Vector3d& p, const TemporalDistances& d, double blur) const {
        double hu = kAirHu;  // the specimen is cleaned of muscle, so that its surface lies half-way to bone
        const double bone = share(-of(d, kOuter), blur);
        const double behind_plates = behindPlates(p, d, shapes_.measures());
        if (bone > 0) hu = mixed(hu, boneHu(p, d, behind_plates), bone);
        hu = mixed(hu, kBrainHu, share(-of(d, kCranium), blur));
        hu = mixed(hu, kAirHu, share(airDepth(p, d, behind_plates), blur));
        hu = mixed(hu, kFluidHu, share(-std::min(labyrinth(d), of(d, kMeatus)), blur));
        const double soft = std::min({of(d, kSinus), of(d, kCarotid), of(d, kNerve), of(d, kDrum)});
        hu = mixed(hu, kMuscleHu, share(-soft, blur));
        hu = mixed(hu, kOssicleHu, share(-of(d, kOssicles), blur));
        return mixed(kAirHu, hu, share(-of(d, kBlock), blur));
    }

    static TemporalTissue tissueOf(const TemporalDistances& d) {
        if (of(d, kBlock) > 0) return TemporalTissue::kNone;
        if (of(d, kOssicles) < 0) return TemporalTissue::kOssicles;
        if (of(d, kNerve) < 0) return TemporalTissue::kFacialNerve;
        if (of(d, kCanals) < 0) return TemporalTissue::kSemicircularCanals;
        if (of(d, kSinus) < 0) return TemporalTissue::kSigmoidSinus;
        const double cranium = of(d, kCranium);
        return cranium < 0 && cranium > -kDuraThickness ? TemporalTissue::kDura : TemporalTissue::kNone;
    }

    const TemporalBoneKind& kind_;
    const TemporalShapes& shapes_;
    const AirCells& cells_;
    TemporalDistances at_middle_;
    std::vector<TemporalShape> near_;
    std::vector<uint32_t> near_seeds_;
};

// Makes a few slices at a time.
class Slabs {
  public:
    struct Slab {
        std::vector<int16_t> hu;
        std::vector<uint8_t> labels;
    };
    Slabs(const TemporalBoneKind& kind, const TemporalShapes& shapes, const AirCells& cells,
          const VolumeGeometry& geometry)
        : kind_(kind), shapes_(shapes), cells_(cells), geometry_(geometry) {}

    std::vector<int> firstSlices() const {
        std::vector<int> firsts;
        for (int k = 0; k < geometry_.dims.z(); k += kEdge) firsts.push_back(k);
        return firsts;
    }
    Slab make(int first) const {
        Eigen::Vector3i size = geometry_.dims;
        size.z() = std::min(kEdge, geometry_.dims.z() - first);
        Slab slab{std::vector<int16_t>(size_t(size.prod())), std::vector<uint8_t>(size_t(size.prod()))};
        for (int j = 0; j < size.y(); j += kEdge)
            for (int i = 0; i < size.x(); i += kEdge) fill(slab, {i, j, first}, size);
        return slab;
    }

  private:
    static constexpr int kEdge = 8;  // voxels of a cube

    Vector3d pointOf(const Vector3d& index) const {
        return toLeft(kind_, geometry_.X_WV * geometry_.spacing.cwiseProduct(index));
    }
    void fill(Slab& slab, const Eigen::Vector3i& low, const Eigen::Vector3i& slab_size) const {
        const double blur = kBlurVoxels * geometry_.spacing.maxCoeff() * kPerMillimetre;
        const double half_diagonal = (geometry_.spacing * (kEdge - 1) / 2).norm() * kPerMillimetre;
        const Vector3d middle = low.cast<double>().array() + (kEdge - 1) / 2.0;
        const Cube cube(kind_, shapes_, cells_, pointOf(middle), half_diagonal);
        const Eigen::Vector3i high = (low.array() + kEdge - 1).matrix();
        forEachIndex({low, high.cwiseMin((geometry_.dims.array() - 1).matrix())},
                     [&](const Eigen::Vector3i& v) {
                         const Cube::Voxel voxel = cube.at(pointOf(v.cast<double>()), blur);
                         const size_t n = placeIn(slab_size, {v.x(), v.y(), v.z() - low.z()});
                         slab.hu[n] = int16_t(std::lround(voxel.hu));
                         slab.labels[n] = uint8_t(voxel.tissue);
                     });
    }

    const TemporalBoneKind& kind_;
    const TemporalShapes& shapes_;
    const AirCells& cells_;
    const VolumeGeometry& geometry_;
};

}  // namespace

TemporalBone::TemporalBone(const TemporalBoneKind& kind)
    : kind_(kind),
      shapes_(std::make_unique<TemporalShapes>(kind)),
      cells_(std::make_unique<AirCells>(makeCells(kind, *shapes_))) {}
TemporalBone::~TemporalBone() = default;

VolumeGeometry TemporalBone::grid(double voxel_size) const {
    return sidedGrid(temporalBlock(), voxel_size, kind_.is_right);
}

TemporalScan TemporalBone::scan(const VolumeGeometry& geometry) const {
    TemporalScan scan;
    scan.ct.geometry = geometry;
    scan.ct.is_hounsfield = true;
    scan.ct.description = "temporal bone phantom";
    scan.ct.values.reserve(geometry.voxelCount());
    scan.labels.reserve(geometry.voxelCount());
    const Slabs slabs(kind_, *shapes_, *cells_, geometry);
    workAhead(
        slabs.firstSlices(), [&](int first) { return slabs.make(first); },
        [&](int, Slabs::Slab&& slab) {
            scan.ct.values.append(std::span<const int16_t>(slab.hu));
            scan.labels.insert(scan.labels.end(), slab.labels.begin(), slab.labels.end());
        });
    return scan;
}

double TemporalBone::distance(TemporalTissue tissue, const Vector3d& p_W) const noexcept {
    constexpr TemporalShape kShapes[] = {kSinus, kNerve, kCranium, kCanals, kOssicles};
    return shapes_->distance(kShapes[int(tissue) - 1], toLeft(kind_, p_W)) * kMillimetre;
}

int TemporalBone::cellAt(const Vector3d& p_W) const {
    const Vector3d p = toLeft(kind_, p_W);
    const TemporalDistances d = shapes_->distances(p);
    const double room = std::min(behindPlates(p, d, shapes_->measures()),
                                 pneumaticReach(kind_.pneumatisation, p, of(d, kAntrum)));
    return room < 0 ? -1 : cells_->cellAt(p);
}

}  // namespace bonemill
