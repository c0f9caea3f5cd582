// What flies and flows meets the bone as this: the vertices of the node meshes, found by place.
//
// The surface only exists while an effect needs it. The frame is V, the unit m. It is for one
// thread and allocates.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <map>
#include <optional>
#include <utility>
#include <vector>

#include "common/geometry/node_mesh.h"

namespace bonemill {

// It is a place on the bone's surface. The frame is V, the unit m.
struct SurfacePoint {
    Eigen::Vector3f p_V = Eigen::Vector3f::Zero();
    Eigen::Vector3f n_V = Eigen::Vector3f::UnitZ();  // unit, out of the bone

    uint8_t material = 0;  // as NodeMesh::materials, without kMilledBit

    // Returns the height (m) of p above the tangent plane; it is negative in the bone.
    float heightOf(const Eigen::Vector3f& p) const { return n_V.dot(p - p_V); }
};

class BoneSurface {
  public:
    static constexpr float kFocusRadius = 0.02f;  // m around the focus in which points are found

    void set(const NodeMesh& mesh);  // an empty one removes it
    void clear();

    // Points are found around this place from now on. The call is cheap while the place hardly moves.
    void focusOn(const Eigen::Vector3f& p_V);
    bool isInFocus(const Eigen::Vector3f& p_V) const { return (p_V - focus_).norm() < kFocusRadius; }
    // Returns the nearest vertex within `reach` (m); nothing out of focus.
    std::optional<SurfacePoint> nearest(const Eigen::Vector3f& p_V, float reach) const;

    // From now on the surface knows which vertices are new; that takes time.
    void trackFresh() { tracks_fresh_ = true; }
    // Returns the vertices since the last call that no earlier mesh of their leaf had, at most kMaxFresh.
    std::vector<SurfacePoint> takeFresh() { return std::exchange(fresh_, {}); }
    static constexpr size_t kMaxFresh = 20000;

  private:
    struct Leaf {
        Eigen::Vector3f origin, step;
        std::vector<PackedVertex> vertices;
        std::vector<uint8_t> materials;  // per vertex, or none
        Eigen::AlignedBox3f box;
        mutable std::vector<uint32_t> starts, order;  // vertices by bucket; empty: not sorted yet
        SurfacePoint point(size_t vertex) const;
        void sortIntoBuckets() const;
        Eigen::Array3i bucketOf(const Eigen::Vector3f& p) const;
        void findNearer(const Eigen::Vector3f& p_V, float& reach, const PackedVertex*& found) const;
    };
    void remove(uint32_t leaf);
    void noteFresh(const Leaf* before, const Leaf& after);
    void findLeaves();

    std::map<uint32_t, Leaf> leaves_;
    using Cell = Eigen::Array3i;
    Cell cellOf(const Eigen::Vector3f& p_V) const;
    static size_t numberOf(const Cell& cell);

    std::vector<std::vector<const Leaf*>>
        near_;  // the leaves that touch each cell of a grid around the focus
    Eigen::Vector3f focus_ = Eigen::Vector3f::Zero(), sought_around_ = focus_;
    bool is_stale_ = true;  // near_
    bool tracks_fresh_ = false;
    std::vector<SurfacePoint> fresh_;
};

// Gravity draws a drop down on the bone's surface. The frame is V, the unit m. Any thread may
// call the functions.
enum class Walk { kGoesOn, kRests, kFallsOff };

// Moves `at` along the surface by at most `distance`: less on level ground. Where the surface overhangs or
// ends the drop falls off, and `at` stays.
Walk walkDown(const BoneSurface& surface, const Eigen::Vector3f& up_V, float distance, SurfacePoint& at);

}  // namespace bonemill
