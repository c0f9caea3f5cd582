#include "haptic_server/core/effects/thermal/heat_grid.h"

#include <algorithm>
#include <array>
#include <cmath>

#include "common/base/assert.h"
#include "common/math/pinned_math.h"
#include "haptic_server/core/volume/floor_index.h"

namespace bonemill {
namespace {

constexpr double kStableShare = 1.0 / 6;  // of a difference, through each of a cube's six faces, explicit
constexpr double kLongestShare = 0.9 * kStableShare;
constexpr double kShortestTurn = 0.02;  // s: quicker turns would show nobody more
constexpr double kColdTurn = 0.1;       // s
constexpr double kTurnsPerSecond = 4000;
constexpr double kPoolShare = 0.8;  // of the bricks that could have their turn in time
constexpr size_t kMostBricks = 1024, kMostDeadBricks = 16384;
constexpr size_t kLookupsPerStep = 4;  // of a brick's cubes in the volume
constexpr size_t kLookupsOfHeat = 2;   // of them, that dead bone leaves to the bricks whose turn it is
// They are in K: a brick whose border is warmer than that opens its neighbour; one that is cooler all over is
// closed when it has been open for a while. Cold matters less.
constexpr float kWarm = 0.01f, kCold = -1, kSettledCold = -0.5f;
constexpr double kShortestLife = 1;    // s
constexpr double kLeastWeight = 0.02;  // of a cube that heat is spread to

const std::array<Eigen::Vector3i, 6> kSides = {
    {{1, 0, 0}, {0, 1, 0}, {0, 0, 1}, {-1, 0, 0}, {0, -1, 0}, {0, 0, -1}}};

// Calls visit(n) for the cells of a brick that are the last ones along the axis with this step.
template <class Visit>
void forEachLast(int step, Visit&& visit) noexcept {
    const int row = DeadCells::kEdge * step;
    for (int first = row - step; first < DeadCells::kCells; first += row)
        for (int n = first; n < first + step; ++n) visit(n);
}

}  // namespace

HeatGrid::HeatGrid(const HeatConfig& config, const VoxelVolume& bone, double dt)
    : config_(config),
      bone_(bone),
      dt_(dt),
      bricks_((bone.dims().cast<double>().array() * bone.spacing().array() / (config.cell * kEdge))
                  .ceil()
                  .cast<int>()),
      cell_capacity_(config.heat_capacity * pinned::cube(config.cell)),
      per_time_(config.conductivity / (config.heat_capacity * config.cell * config.cell)),
      longest_(kLongestShare / per_time_),
      turn_(std::min(kShortestTurn, longest_ / 2)),
      cold_turn_(std::min(kColdTurn, longest_ / 2)),
      most_turns_(size_t(std::max(1.0, std::round(kTurnsPerSecond * dt)))),
      necrosis_excess_(config.necrosis_temperature - config.body_temperature),
      dead_(bricks_, kMostDeadBricks) {
    // There is half a cube of bone between a cube's middle and its face.
    const auto rate = [&](double transfer) {
        if (transfer <= 0) return 0.0;
        return 1 / (1 / transfer + config.cell / (2 * config.conductivity)) /
               (config.heat_capacity * config.cell);
    };
    wet_rate_ = rate(config.wet_transfer);
    // The bone's surface lies half a cube from its middle, with the film on its other side.
    wet_share_ = 1 / (1 + std::max(config.wet_transfer, 0.0) * config.cell / (2 * config.conductivity));
    dry_rate_ = rate(config.dry_transfer);
    directory_.assign(size_t(bricks_.prod()), kNone);
    const double in_time = kPoolShare * double(most_turns_) * longest_ / dt;
    pool_.resize(std::min({kMostBricks, size_t(std::max(1.0, in_time)), directory_.size()}));
    hottest_.resize(pool_.size());
    for (size_t n = pool_.size(); n > 0; --n) free_.push_back(uint32_t(n - 1));
    active_.reserve(pool_.size());
    lookups_ = kLookupsPerStep;
    for (int axis = 0; axis < 3; ++axis) {
        const auto middleIn = [&](size_t cell) {
            return int((double(cell) + 0.5) * config.cell / bone.spacing()[axis]);
        };
        std::vector<int>& voxels = voxels_[axis];
        while (middleIn(voxels.size()) < bone.dims()[axis]) voxels.push_back(middleIn(voxels.size()));
    }
    const double around = kAround * config.cell / bone.spacing().x();
    row_.resize(size_t(std::min(around + 2, double(bone.dims().x()))) + VoxelVolume::kReadSlack);
}

// The grid begins where the first voxel does, half a voxel before its centre.
Eigen::Vector3i HeatGrid::cellAt(const Eigen::Vector3d& p_V) const noexcept {
    constexpr double kFar = 1e6;
    const Eigen::Array3d place = (p_V + bone_.spacing() / 2).array() / config_.cell;
    return floorIndices(place.max(-kFar).min(kFar).matrix());
}

HeatGrid::Brick* HeatGrid::find(const Eigen::Vector3i& brick) noexcept {
    if (!isInside(brick)) return nullptr;
    const uint32_t slot = directory_[directoryIndex(brick)];
    return slot == kNone ? nullptr : &pool_[slot];
}

HeatGrid::Brick* HeatGrid::findOrOpen(const Eigen::Vector3i& index) noexcept {
    if (Brick* brick = find(index)) return brick;
    if (!isInside(index) || free_.empty() || lookups_ == 0) return nullptr;
    const uint32_t slot = free_.back();
    free_.pop_back();
    active_.push_back(slot);
    directory_[directoryIndex(index)] = slot;
    Brick& brick = pool_[slot];
    brick = Brick{};
    hottestOf(brick) = 0;
    brick.index = index;
    brick.opened = brick.last_time = now_;
    brick.stale = kAllRows;
    lookUpBone(brick);
    return &brick;
}

// The brick of a cube of bone, which it opens where there is room; null: it is no bone, or there is none.
HeatGrid::Brick* HeatGrid::boneAt(const Eigen::Vector3i& cell) noexcept {
    if ((cell.array() < 0).any()) return nullptr;
    Brick* brick = findOrOpen(brickOfCell(cell));
    if (!brick) return nullptr;
    if (brick->stale && lookups_ > 0) lookUpBone(*brick);
    return brick->is_bone[cellIndex(cell)] ? brick : nullptr;
}

void HeatGrid::putInto(Brick& brick, const Eigen::Vector3i& cell, double heat) noexcept {
    const int n = cellIndex(cell);
    if (brick.open_area[n] > 0 && isWet(brick, n, middleOf(cell))) heat *= wet_share_;
    brick.excess[n] += float(heat / cell_capacity_);
    float& hottest = hottestOf(brick);
    hottest = std::max(hottest, brick.excess[n]);
}

// Into the cube of bone that a place is in and those beside it across the axis, the more the nearer their
// middles are: how the place lies among them does not count.
bool HeatGrid::spread(const Eigen::Vector3d& p_V, int axis, double heat) noexcept {
    const Eigen::Vector3i cell = cellAt(p_V);
    Brick* const brick = boneAt(cell);
    if (!brick) return false;
    const Eigen::Array2i across((axis + 1) % 3, (axis + 2) % 3);
    const Eigen::Vector3d off = (p_V - middleOf(cell)) / config_.cell;
    std::array<Eigen::Vector3i, 4> cells;
    std::array<Brick*, 4> bricks;
    std::array<double, 4> weights;
    double sum = 0;
    for (size_t n = 0; n < 4; ++n) {
        cells[n] = cell;
        weights[n] = 1;
        for (int side = 0; side < 2; ++side) {
            const double share = std::abs(off[across[side]]);
            const bool is_next = n >> side & 1;
            if (is_next) cells[n][across[side]] += off[across[side]] < 0 ? -1 : 1;
            weights[n] *= is_next ? share : 1 - share;
        }
        if (weights[n] >= kLeastWeight) bricks[n] = n > 0 ? boneAt(cells[n]) : brick;
        if (weights[n] < kLeastWeight || !bricks[n]) weights[n] = 0;
        sum += weights[n];
    }
    for (size_t n = 0; n < 4; ++n)
        if (weights[n] > 0) putInto(*bricks[n], cells[n], heat * weights[n] / sum);
    return true;
}

void HeatGrid::addHeat(const Eigen::Vector3d& p_V, const Eigen::Vector3d& inward_V, double heat) noexcept {
    BONEMILL_ASSERT(heat >= 0 && std::abs(inward_V.squaredNorm() - 1) < 1e-6);
    int axis = 0;
    inward_V.cwiseAbs().maxCoeff(&axis);
    // Cubes that are half bone count as bone or as none: the next one inwards may be the first.
    for (const double depth : {0.25, 0.75, 1.25})
        if (spread(p_V + depth * config_.cell * inward_V, axis, heat)) return;
    const Eigen::Vector3i cell = cellAt(p_V);
    for (const Eigen::Vector3i& side : kSides)
        if (Brick* const brick = boneAt(cell + side)) return putInto(*brick, cell + side, heat);
}

void HeatGrid::forget() noexcept {
    while (!active_.empty()) close(active_.size() - 1);
    turns_due_ = 0;
    next_ = 0;
    dead_.forget();
}

void HeatGrid::step(bool has_time) noexcept {
    now_ += dt_;
    lookups_ = kLookupsPerStep;
    turns_due_ = std::min(turns_due_ + double(active_.size()) * dt_ / turn_, double(most_turns_));
    if (!has_time) return;
    if (wet_radius_ > 0) openWet();
    lookups_ -=
        dead_.review(kLookupsPerStep - kLookupsOfHeat, [&](const auto& cell) { return isBone(cell); });
    for (; turns_due_ >= 1 && !active_.empty(); --turns_due_) {
        if (next_ >= active_.size()) next_ = 0;
        Brick& brick = pool_[active_[next_]];
        if (brick.stale) {
            if (lookups_ == 0) return;
            lookUpBone(brick);
        }
        // Nothing is hot in it: the little that changes can wait.
        if (hottestOf(brick) < kWarm && now_ - brick.last_time < cold_turn_) {
            ++next_;
            continue;
        }
        const double elapsed = std::min(now_ - brick.last_time, longest_);
        brick.last_time = now_;
        harm(brick, elapsed);
        openNeighbours(brick);
        conduct(brick, elapsed);
        cool(brick, elapsed);
        if (isSettled(brick))
            close(next_);
        else
            ++next_;
    }
}

// Neighbours are opened where heat is about to come to them.
void HeatGrid::openNeighbours(Brick& brick) noexcept {
    if (double(free_.size()) < kSpareForSources * double(pool_.size())) return;
    for (size_t side = 0; side < kSides.size(); ++side) {
        const Eigen::Vector3i neighbour = brick.index + kSides[side];
        if (lookups_ == 0 || !isInside(neighbour) || find(neighbour)) continue;
        const int axis = int(side % 3);
        IndexBox border{Eigen::Vector3i::Zero(), Eigen::Vector3i::Constant(kEdge - 1)};
        (side < 3 ? border.min : border.max)[axis] = side < 3 ? kEdge - 1 : 0;
        bool is_wanted = false;
        forEachIndex(border, [&](const Eigen::Vector3i& c) {
            const float excess = brick.excess[cellIndex(c)];
            if (is_wanted || (excess < kWarm && excess > kCold)) return;
            is_wanted = isBone(brick.index * kEdge + c + kSides[side]);
        });
        if (is_wanted) findOrOpen(neighbour);
    }
}

// Heat goes through the faces between the brick's cubes, and through those to its neighbours upwards; the
// neighbours' own turns do the others.
void HeatGrid::conduct(Brick& brick, double elapsed) noexcept {
    const float share = float(per_time_ * elapsed);
    std::array<float, kCells> gain{}, flow, is_bone;
    std::copy_n(brick.is_bone, kCells, is_bone.begin());
    for (int axis = 0; axis < 3; ++axis) {
        const int step = 1 << (kShift * axis), to_first = (kEdge - 1) * step;
        for (int n = 0; n < kCells - step; ++n)
            flow[size_t(n)] = share * (brick.excess[n] - brick.excess[n + step]) *
                              (is_bone[size_t(n)] * is_bone[size_t(n + step)]);
        forEachLast(step, [&](int n) { flow[size_t(n)] = 0; });
        for (int n = step; n < kCells; ++n) gain[size_t(n)] += flow[size_t(n - step)];
        if (Brick* above = find(brick.index + kSides[size_t(axis)]))
            forEachLast(step, [&](int n) {
                const int m = n - to_first;
                if (!brick.is_bone[n] || !above->is_bone[m]) return;
                flow[size_t(n)] = share * (brick.excess[n] - above->excess[m]);
                above->excess[m] += flow[size_t(n)];
            });
        for (int n = 0; n < kCells; ++n) gain[size_t(n)] -= flow[size_t(n)];
    }
    for (int n = 0; n < kCells; ++n) brick.excess[n] += gain[size_t(n)];
}

// Notes what the brick's bone has gone through since its last turn.
void HeatGrid::harm(Brick& brick, double elapsed) noexcept {
    for (int n = 0; n < kCells; ++n) {
        if (!brick.is_bone[n] || double(brick.excess[n]) < necrosis_excess_) {
            brick.hot_time[n] = 0;
            continue;
        }
        brick.hot_time[n] += float(elapsed);
        if (double(brick.hot_time[n]) >= config_.necrosis_time) dead_.add(brick.index, n);
    }
}

bool HeatGrid::isSettled(const Brick& brick) const noexcept {
    return hottestOf(brick) < kWarm && brick.coldest > kSettledCold && now_ - brick.opened > kShortestLife;
}

void HeatGrid::close(size_t place) noexcept {
    const uint32_t slot = active_[place];
    directory_[directoryIndex(pool_[slot].index)] = kNone;
    free_.push_back(slot);
    active_[place] = active_.back();
    active_.pop_back();
}

double HeatGrid::temperatureAt(const Eigen::Vector3d& p_V) const noexcept {
    const Eigen::Vector3i cell = cellAt(p_V);
    if ((cell.array() < 0).any()) return config_.body_temperature;
    Brick* brick = const_cast<HeatGrid*>(this)->find(brickOfCell(cell));
    return config_.body_temperature + (brick ? double(brick->excess[cellIndex(cell)]) : 0.0);
}

double HeatGrid::hottest() const noexcept {
    float excess = 0;
    for (const uint32_t slot : active_) excess = std::max(excess, hottest_[slot]);
    return config_.body_temperature + double(excess);
}

double HeatGrid::necroticVolume() const noexcept {
    return double(dead_.count()) * pinned::cube(config_.cell);
}

double HeatGrid::storedHeat() const noexcept {
    double sum = 0;
    for (const uint32_t slot : active_)
        for (int n = 0; n < kCells; ++n) sum += double(pool_[slot].excess[n]);
    return sum * cell_capacity_;
}

}  // namespace bonemill
