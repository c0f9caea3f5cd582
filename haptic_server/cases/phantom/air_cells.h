// Makes a foam of air cells: the cells of a power diagram about scattered seeds of several sizes, with
// thin walls, rounded corners, and holes through some of the walls.
//
// Lengths are in mm. Thread-safe; building allocates, and so does what is asked for a neighbourhood.
#pragma once

#include <Eigen/Geometry>
#include <cstdint>
#include <functional>
#include <vector>

namespace bonemill {

class AirCells {
  public:
    struct Region {
        Eigen::AlignedBox3d box;
        std::function<double(const Eigen::Vector3d&)> depth;   // how far inside the region; < 0: outside
        std::function<double(const Eigen::Vector3d&)> radius;  // the cells' mean radius there
    };
    AirCells(const Region& region, uint64_t seed);

    // The seeds that matter within `reach` of a point, in their order.
    std::vector<uint32_t> seedsNear(const Eigen::Vector3d& p, double reach) const;
    // How far inside a cell's air the point lies, negative in a wall. `near` is seedsNear() of a ball that
    // holds the point.
    double depth(const Eigen::Vector3d& p, const std::vector<uint32_t>& near) const;
    // The cell of the point, or of the nearest one beyond a wall; -1: there is none.
    int cellAt(const Eigen::Vector3d& p) const;

    size_t count() const noexcept { return seeds_.size(); }

  private:
    struct Seed {
        Eigen::Vector3d middle;
        double radius;
        double wall;  // half the thickness
    };
    void scatter(const Region& region, uint64_t seed);
    double power(uint32_t n, const Eigen::Vector3d& p) const noexcept;
    uint32_t nearestOf(const std::vector<uint32_t>& near, const Eigen::Vector3d& p) const noexcept;
    double hole(uint32_t a, uint32_t b, const Eigen::Vector3d& p) const noexcept;

    std::vector<Seed> seeds_;
};

}  // namespace bonemill
