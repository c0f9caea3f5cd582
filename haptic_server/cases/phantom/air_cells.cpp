#include "haptic_server/cases/phantom/air_cells.h"

#include <algorithm>
#include <cmath>

#include "haptic_server/cases/phantom/lattice_noise.h"
#include "haptic_server/cases/phantom/spline_shapes.h"
#include "haptic_server/core/volume/index_box.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;

constexpr double kThinnestWall = 0.2, kThickestWall = 0.45;
constexpr double kLargestRadius = 3;
constexpr double kFillet = 0.45;       // of a cell's edges
constexpr double kDeepest = 1;         // depths are told up to here
constexpr double kShareOfHoles = 0.5;  // walls between neighbours that are open

// It bends the walls a little; the noise is slow enough to keep distances.
constexpr double kBend = 0.5;
Vector3d bent(const Vector3d& p) {
    constexpr double kStep = 2.6;
    const double x = smoothNoise(p + Vector3d(40, 0, 0), kStep),
                 y = smoothNoise(p + Vector3d(0, 140, 0), kStep),
                 z = smoothNoise(p + Vector3d(0, 0, 240), kStep);
    return p + kBend * (2 * Vector3d(x, y, z) - Vector3d::Ones());
}

// Points in boxes as wide as two of them can be too near.
class Bins {
  public:
    explicit Bins(const Eigen::AlignedBox3d& box) : low_(box.min()) {
        size_ = (box.sizes() / kWidth).array().floor().cast<int>() + 1;
        bins_.resize(size_t(size_.prod()));
    }
    void add(const Vector3d& p, uint32_t n) { bins_[place(binOf(p))].push_back(n); }
    template <class See>
    void forEachAround(const Vector3d& p, See&& see) const {
        const Eigen::Array3i at = binOf(p);
        for (int n = 0; n < 27; ++n) {
            const Eigen::Array3i bin = at + Eigen::Array3i(n % 3, n / 3 % 3, n / 9) - 1;
            if ((bin < 0).any() || (bin >= size_).any()) continue;
            for (const uint32_t k : bins_[place(bin)]) see(k);
        }
    }

  private:
    static constexpr double kWidth = 2 * kLargestRadius;
    Eigen::Array3i binOf(const Vector3d& p) const {
        return ((p - low_) / kWidth).array().floor().cast<int>();
    }
    size_t place(const Eigen::Array3i& b) const {
        return size_t(b.x() + size_.x() * (b.y() + size_.y() * b.z()));
    }
    Vector3d low_;
    Eigen::Array3i size_;
    std::vector<std::vector<uint32_t>> bins_;
};

// The low corners of the cubes that the region may reach into.
constexpr double kCube = 2;
std::vector<Vector3d> cubesOf(const AirCells::Region& region) {
    constexpr double kSteepest = 1.4;
    const Vector3d half = Vector3d::Constant(kCube / 2);
    std::vector<Vector3d> cubes;
    const Eigen::Vector3i last = (region.box.sizes() / kCube).array().ceil().cast<int>() - 1;
    forEachIndex({Eigen::Vector3i::Zero(), last}, [&](const Eigen::Vector3i& cube) {
        const Vector3d low = region.box.min() + kCube * cube.cast<double>();
        if (region.depth(low + half) > -kSteepest * half.norm()) cubes.push_back(low);
    });
    return cubes;
}

}  // namespace

AirCells::AirCells(const Region& region, uint64_t seed) {
    scatter(region, seed);
}

// Tries places by chance, and keeps those that are far enough from all before: large cells first come where
// there is room, small ones between them.
void AirCells::scatter(const Region& region, uint64_t seed) {
    constexpr double kTriesPerVolume = 3.5, kNearest = 0.8;
    const std::vector<Vector3d> cubes = cubesOf(region);
    Bins bins(region.box);
    const int tries = int(double(cubes.size()) * kCube * kCube * kCube * kTriesPerVolume);
    uint64_t state = splitMix64(seed ^ 0x5eed);
    const auto draw = [&] { return unitOf(state = splitMix64(state)); };
    for (int n = 0; n < tries; ++n) {
        const Vector3d& cube = cubes[std::min(size_t(draw() * double(cubes.size())), cubes.size() - 1)];
        const double x = draw(), y = draw(), z = draw(), chance = draw(), wall = draw();
        const Vector3d p = cube + kCube * Vector3d(x, y, z);
        const double shrink = 1 - 0.55 * double(n) / tries;
        const double radius = std::min(region.radius(p) * (0.75 + 0.6 * chance) * shrink, kLargestRadius);
        bool has_room = true;
        bins.forEachAround(p, [&](uint32_t k) {
            has_room = has_room && (seeds_[k].middle - p).norm() > kNearest * (seeds_[k].radius + radius);
        });
        if (!has_room || region.depth(p) < 0.5 * radius) continue;
        bins.add(p, uint32_t(seeds_.size()));
        seeds_.push_back({p, radius, (kThinnestWall + (kThickestWall - kThinnestWall) * wall * wall) / 2});
    }
}

double AirCells::power(uint32_t n, const Vector3d& p) const noexcept {
    return (seeds_[n].middle - p).squaredNorm() - seeds_[n].radius * seeds_[n].radius;
}

uint32_t AirCells::nearestOf(const std::vector<uint32_t>& near, const Vector3d& p) const noexcept {
    return *std::min_element(near.begin(), near.end(),
                             [&](uint32_t a, uint32_t b) { return power(a, p) < power(b, p); });
}

std::vector<uint32_t> AirCells::seedsNear(const Vector3d& p, double reach) const {
    // A face matters as far as depth() looks; the seeds beyond it lie hardly more than two radii away.
    constexpr double kFaceReach = kDeepest + kFillet + kThickestWall / 2, kFarthest = 2.4 * kLargestRadius;
    const double ball = reach + kBend * std::sqrt(3.0);
    double bound = std::numeric_limits<double>::infinity();
    const auto squared_reach = [&](const Seed& s, double by) {
        const double d = std::max((s.middle - p).norm() + by, 0.0);
        return d * d - s.radius * s.radius;
    };
    for (const Seed& s : seeds_) bound = std::min(bound, squared_reach(s, ball));
    bound += 2 * kFarthest * kFaceReach;
    std::vector<uint32_t> near;
    for (uint32_t n = 0; n < seeds_.size(); ++n)
        if (squared_reach(seeds_[n], -ball) < bound) near.push_back(n);
    return near;
}

// A round hole about the line from seed to seed, where chance opens the wall.
double AirCells::hole(uint32_t a, uint32_t b, const Vector3d& p) const noexcept {
    const uint64_t chance = splitMix64(uint64_t(std::min(a, b)) << 32 | std::max(a, b));
    if (unitOf(chance) > kShareOfHoles) return -std::numeric_limits<double>::infinity();
    const double radius =
        (0.25 + 0.35 * unitOf(splitMix64(chance))) * std::min(seeds_[a].radius, seeds_[b].radius);
    const Vector3d along = seeds_[b].middle - seeds_[a].middle;
    const double t = std::clamp((p - seeds_[a].middle).dot(along) / along.squaredNorm(), 0.0, 1.0);
    return radius - (p - seeds_[a].middle - t * along).norm();
}

double AirCells::depth(const Vector3d& p, const std::vector<uint32_t>& near) const {
    if (near.empty()) return -std::numeric_limits<double>::infinity();
    const Vector3d q = bent(p);
    const uint32_t own = nearestOf(near, q);
    const double own_power = power(own, q);
    double depth = kDeepest;
    for (const uint32_t n : near) {
        if (n == own) continue;
        const double apart = (seeds_[n].middle - seeds_[own].middle).norm();
        const double to_face = (power(n, q) - own_power) / (2 * apart);
        const double to_wall = to_face - (seeds_[n].wall + seeds_[own].wall) / 2;
        if (to_wall > kDeepest + kFillet) continue;
        depth = blend(depth, std::max(to_wall, hole(own, n, q)), kFillet);
    }
    return depth;
}

int AirCells::cellAt(const Vector3d& p) const {
    const std::vector<uint32_t> near = seedsNear(p, 0);
    return near.empty() ? -1 : int(nearestOf(near, bent(p)));
}

}  // namespace bonemill
