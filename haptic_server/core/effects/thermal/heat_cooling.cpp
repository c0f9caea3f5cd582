// The bone's surface in the heat grid: where water reaches it, and what it gives off.
#include <algorithm>
#include <array>
#include <cmath>

#include "common/math/pinned_math.h"
#include "haptic_server/core/effects/thermal/heat_grid.h"

namespace bonemill {
namespace {

constexpr double kWetLookPeriod = 4e-3;  // s

}  // namespace

void HeatGrid::irrigate(const Eigen::Vector3d& center_V, double radius,
                        const Eigen::Vector3d& p_VN) noexcept {
    wet_center_V_ = center_V;
    wet_radius_ = radius;
    p_VN_ = p_VN;
}

// Nothing stands between the cube in whose middle p_V lies and the nozzle. The cubes around are the surface
// itself, and those far from it are taken for air: that bounds the time.
bool HeatGrid::isReached(const Eigen::Vector3d& p_V) const noexcept {
    constexpr double kFirst = 1.5, kFarthest = 128;  // cubes
    const Eigen::Vector3d way = p_VN_ - p_V;
    const double cubes = way.norm() / config_.cell;
    for (double n = kFirst; n < std::min(cubes, kFarthest); ++n)
        if (isBone(cellAt(p_V + n / cubes * way))) return false;
    return true;
}

// What is irrigated cools, also where nothing has warmed it: the bricks around take turns to be looked at.
void HeatGrid::openWet() noexcept {
    if (now_ + dt_ / 2 < next_wet_look_) return;
    next_wet_look_ = now_ + kWetLookPeriod;
    ++wet_looks_;
    const Eigen::Vector3d reach = Eigen::Vector3d::Constant(wet_radius_);
    const IndexBox box =
        IndexBox{brickOfCell(cellAt(wet_center_V_ - reach)), brickOfCell(cellAt(wet_center_V_ + reach))}
            .clamped(Eigen::Vector3i::Zero(), bricks_.array() - 1);
    if (box.isEmpty() || double(free_.size()) < kSpareForSources * double(pool_.size())) return;
    const Eigen::Vector3i size = box.max - box.min + Eigen::Vector3i::Ones();
    const int64_t n = wet_looks_ % box.count();
    const Eigen::Vector3i brick = box.min + Eigen::Vector3i(int(n % size.x()), int(n / size.x() % size.y()),
                                                            int(n / size.x() / size.y()));
    if (!find(brick)) findOrOpen(brick);
}

void HeatGrid::cool(Brick& brick, double elapsed) noexcept {
    std::array<float, 6 * kPartsOfFace + 1> wet, dry;  // what is left of a difference, by open area
    wet[0] = dry[0] = 1;
    wet[1] = float(pinned::exp(-wet_rate_ * elapsed / kPartsOfFace));
    dry[1] = float(pinned::exp(-dry_rate_ * elapsed / kPartsOfFace));
    for (size_t area = 2; area < wet.size(); ++area) {
        wet[area] = wet[area - 1] * wet[1];
        dry[area] = dry[area - 1] * dry[1];
    }
    const float wet_excess = float(config_.irrigation_temperature - config_.body_temperature);
    const float left_by_blood = float(pinned::exp(-config_.perfusion * elapsed));
    const Eigen::Vector3d first = (brick.index * kEdge).cast<double>() * config_.cell - bone_.spacing() / 2;
    brick.turn = uint8_t((brick.turn + 1) % kTurnsPerLook);
    float& hottest = hottestOf(brick) = brick.coldest = 0;
    for (int n = 0; n < kCells; ++n) {
        if (!brick.is_bone[n]) continue;
        float& excess = brick.excess[n];
        if (const uint8_t area = brick.open_area[n]; area > 0) {
            const Eigen::Array3d cell(n & (kEdge - 1), n >> kShift & (kEdge - 1), n >> (2 * kShift));
            const Eigen::Vector3d p_V = first + ((cell + 0.5) * config_.cell).matrix();
            const bool is_near = (p_V - wet_center_V_).squaredNorm() < wet_radius_ * wet_radius_;
            if (is_near && n % kTurnsPerLook == brick.turn) brick.is_reached[n] = isReached(p_V);
            if (is_near && brick.is_reached[n])
                excess = wet_excess + (excess - wet_excess) * wet[area];
            else
                excess *= dry[area];
        }
        excess *= left_by_blood;
        hottest = std::max(hottest, excess);
        brick.coldest = std::min(brick.coldest, excess);
    }
}

}  // namespace bonemill
