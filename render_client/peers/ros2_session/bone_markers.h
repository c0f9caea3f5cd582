// The bone as markers of ROS 2: one TRIANGLE_LIST per node of the octree, in V. What has changed goes out in
// parts; for who comes late everything counts as changed. It is for one thread.
#pragma once

#include <cstddef>
#include <cstdint>
#include <deque>
#include <map>
#include <set>
#include <vector>

#include "common/geometry/node_mesh.h"
#include "common/ros/ros_messages.h"

namespace bonemill::ros2 {

// A message with all that it points to.
class MarkerPart {
  public:
    MarkerPart() = default;
    MarkerPart(const MarkerPart&) = delete;
    MarkerPart& operator=(const MarkerPart&) = delete;

    void forgetAll(int64_t stamp_ns);
    void remove(uint32_t leaf, int64_t stamp_ns);
    void show(const NodeMesh& mesh, int64_t stamp_ns);
    // On the wire, but for some words.
    size_t bytes() const noexcept { return bytes_; }
    const MarkerArray& message() noexcept;

  private:
    Marker& add(uint32_t leaf, int32_t action, int64_t stamp_ns);

    MarkerArray message_{};
    std::vector<Marker> markers_;
    std::deque<std::vector<Point>> points_;  // of the markers that show something
    size_t bytes_ = 0;
};

class BoneMarkers {
  public:
    // A part has no more than this, unless a single node has.
    static constexpr size_t kPartBytes = size_t(1) << 20;

    // Another bone: everything goes.
    void clear();
    // An empty mesh removes its leaf.
    void take(NodeMesh&& mesh);
    // Somebody has come who has nothing yet.
    void tellAnew();

    // False: there is nothing to tell. What goes into `part` counts as told.
    bool takePart(MarkerPart& part, int64_t stamp_ns);
    bool hasUntold() const noexcept { return is_cleared_ || !untold_.empty(); }

  private:
    std::map<uint32_t, NodeMesh> shown_;  // by leaf
    std::set<uint32_t> untold_;
    bool is_cleared_ = true;  // who heard a session before forgets it
};

}  // namespace bonemill::ros2
