// Heat spreads in the bone by conduction on a grid of cubes of its own, coarser or finer than the voxels,
// with memory only for bricks of cubes where it is warmer or colder than the body.
//
// The finite volumes are explicit: heat that goes through a face leaves one cube and comes to the other, so
// that none is lost but at the bone's surface and to the blood. A cube is bone or it is not, by the voxel at
// its middle; its faces to the air count by the surface's slope, for stairs have more area than it. Bricks
// take turns, each with the time that has gone by since its last turn, a few in each step.
//
// The frame is V. Construction allocates; all else is RT-safe, for the tick thread only.
#pragma once

#include <array>
#include <cstdint>
#include <limits>
#include <vector>

#include "haptic_server/core/effects/thermal/dead_cells.h"
#include "haptic_server/core/effects/thermal/thermal_config.h"
#include "haptic_server/core/volume/voxel_volume.h"

namespace bonemill {

class HeatGrid {
  public:
    static constexpr int kPartsOfFace = 4;  // in which area is counted

    // Keeps a reference to the bone. dt is the time of a step, in s.
    HeatGrid(const HeatConfig& config, const VoxelVolume& bone, double dt);

    // Puts heat (J) into the bone at its surface; inward_V is of unit length and points into the bone. Water
    // there takes its share at once. What finds no bone is gone.
    void addHeat(const Eigen::Vector3d& p_V, const Eigen::Vector3d& inward_V, double heat) noexcept;
    // Voxels in this box may have become bone or air. What is cut away takes its heat with it.
    void noteChange(const IndexBox& voxels) noexcept;
    void noteChangeEverywhere() noexcept;
    // All bone is as warm as the body again, and none is dead. Time and irrigation go on.
    void forget() noexcept;
    // From now on the bone's surface is irrigated within `radius` (m) of here where no bone stands between it
    // and the nozzle; 0 means nowhere. A place that comes into the jet is wet within kTurnsPerLook turns,
    // one that nothing has warmed within half a second, when all bricks around have been looked at.
    void irrigate(const Eigen::Vector3d& center_V, double radius, const Eigen::Vector3d& p_VN) noexcept;
    // Time goes on by dt. Bricks take their turns, or they wait for the next step.
    void step(bool has_time = true) noexcept;

    double temperatureAt(const Eigen::Vector3d& p_V) const noexcept;  // °C
    double hottest() const noexcept;                                  // °C, of bone that is there
    // Returns the m³ of bone, not cut away since, that was above the necrosis temperature for
    // the necrosis time.
    double necroticVolume() const noexcept;
    double storedHeat() const noexcept;  // J above body temperature
    double time() const noexcept { return now_; }
    size_t activeBricks() const noexcept { return active_.size(); }

  private:
    static constexpr int kShift = DeadCells::kShift, kEdge = DeadCells::kEdge, kCells = DeadCells::kCells;
    static constexpr uint32_t kNone = ~uint32_t(0);
    static constexpr int kOutside = -1;
    static constexpr int kAround = kEdge + 2;  // cubes that a look at a brick sees along an axis
    // Of the cubes around a brick, which are bone: a bit for each along x, rows along y first.
    using BoneRows = std::array<uint16_t, size_t(kAround* kAround)>;
    static constexpr double kSpareForSources = 0.25;  // of the pool, that heat on its way does not take
    static constexpr int kTurnsPerLook = 4;

    // Rows of a brick's cubes along x: a bit for each, those along y first.
    using RowSet = uint64_t;
    static constexpr RowSet kAllRows = ~RowSet(0);
    static_assert(kEdge * kEdge == std::numeric_limits<RowSet>::digits);

    struct Brick {
        Eigen::Vector3i index = Eigen::Vector3i::Zero();
        double opened, last_time;  // s; up to the latter its faces are done
        float coldest;             // above body temperature; of its bone
        RowSet stale;              // whether cells of these rows are bone is to be looked up anew
        float excess[kCells];      // temperature above the body's
        float hot_time[kCells];    // s above necrosis without a break
        uint8_t is_bone[kCells];
        uint8_t open_area[kCells];   // of bone, towards air; kPartsOfFace make a cube's face
        uint8_t is_reached[kCells];  // by the jet, when it was looked at last
        uint8_t turn;                // which of kTurnsPerLook it is
    };

    size_t directoryIndex(const Eigen::Vector3i& brick) const noexcept { return placeIn(bricks_, brick); }
    bool isInside(const Eigen::Vector3i& brick) const noexcept {
        return (brick.array() >= 0).all() && (brick.array() < bricks_.array()).all();
    }
    static Eigen::Vector3i brickOfCell(const Eigen::Vector3i& cell) noexcept {
        return cell.unaryExpr([](int v) { return v >> kShift; });
    }
    static int cellIndex(const Eigen::Vector3i& cell) noexcept {
        constexpr int kMask = kEdge - 1;
        return (cell.x() & kMask) + kEdge * ((cell.y() & kMask) + kEdge * (cell.z() & kMask));
    }
    Eigen::Vector3i cellAt(const Eigen::Vector3d& p_V) const noexcept;
    int voxelAt(int cell, int axis) const noexcept;
    bool isBone(const Eigen::Vector3i& cell) const noexcept;
    Eigen::Vector3d middleOf(const Eigen::Vector3i& cell) const noexcept {
        return (cell.cast<double>().array() + 0.5).matrix() * config_.cell - bone_.spacing() / 2;
    }
    bool isReached(const Eigen::Vector3d& p_V) const noexcept;
    Brick* find(const Eigen::Vector3i& brick) noexcept;
    Brick* findOrOpen(const Eigen::Vector3i& brick) noexcept;
    Brick* boneAt(const Eigen::Vector3i& cell) noexcept;
    void putInto(Brick& brick, const Eigen::Vector3i& cell, double heat) noexcept;
    bool spread(const Eigen::Vector3d& p_V, int axis, double heat) noexcept;
    bool isWet(const Brick& brick, int cell, const Eigen::Vector3d& p_V) const noexcept {
        return (p_V - wet_center_V_).squaredNorm() < wet_radius_ * wet_radius_ && brick.is_reached[cell];
    }
    void openWet() noexcept;
    // The rows are the first of 3 x 3 around one, and a bit of it is a cube's that is bone, or has a face to
    // the air, too.
    static unsigned boneIn(const uint16_t* rows) noexcept {
        return rows[1 + kAround] >> 1 & ((1 << kEdge) - 1);
    }
    static unsigned openIn(const uint16_t* rows) noexcept {
        const unsigned row = rows[1 + kAround];
        const unsigned beside = rows[1] & rows[kAround] & rows[2 + kAround] & rows[1 + 2 * kAround];
        return boneIn(rows) & ~(row & row >> 2 & beside >> 1);
    }
    static uint8_t openArea(const uint16_t* rows, int x) noexcept;
    void lookUpBone(Brick& brick) noexcept;
    BoneRows rowsAround(const Brick& brick) noexcept;
    void conduct(Brick& brick, double elapsed) noexcept;
    void openNeighbours(Brick& brick) noexcept;
    void cool(Brick& brick, double elapsed) noexcept;
    void harm(Brick& brick, double elapsed) noexcept;
    float& hottestOf(const Brick& brick) noexcept { return hottest_[size_t(&brick - pool_.data())]; }
    float hottestOf(const Brick& brick) const noexcept { return hottest_[size_t(&brick - pool_.data())]; }
    bool isSettled(const Brick& brick) const noexcept;
    void close(size_t place) noexcept;

    HeatConfig config_;
    const VoxelVolume& bone_;
    double dt_;
    Eigen::Vector3i bricks_;      // per axis
    double cell_capacity_;        // J/K
    double per_time_;             // share of a temperature difference that crosses a face per time, 1/s
    double longest_;              // s: of a stable turn
    double turn_;                 // s: of a turn while there are few bricks
    double cold_turn_;            // s: of a turn where nothing is hot
    size_t most_turns_;           // in a step
    double wet_rate_, dry_rate_;  // 1/s, of a face
    double wet_share_;            // of the heat that comes to a wet surface, which goes into the bone
    int64_t wet_looks_ = 0;
    double next_wet_look_ = 0;  // s
    double necrosis_excess_;
    double now_ = 0;
    double turns_due_ = 0;
    size_t next_ = 0;     // of active_
    size_t lookups_ = 0;  // left in this step
    Eigen::Vector3d wet_center_V_ = Eigen::Vector3d::Zero(), p_VN_ = Eigen::Vector3d::Zero();
    double wet_radius_ = 0;

    std::vector<Brick> pool_;
    std::vector<float> hottest_;  // of each brick of the pool, side by side, as every step asks for them
    std::vector<uint32_t> free_;
    std::vector<uint32_t> active_;
    std::vector<uint32_t> directory_;  // per brick: in pool_
    std::vector<int> voxels_[3];       // per cube along an axis with a voxel in its middle: which one
    std::vector<Density> row_;         // scratch
    DeadCells dead_;
};

}  // namespace bonemill
