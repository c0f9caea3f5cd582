// The bone's surface in a Foxglove file, by its changes: a topic for each of 64 nodes of the octree at most,
// "/bone/NN", whose newest message is all of that node. A viewer that jumps shows the newest message of each
// topic, so it has the bone as it was, wherever it jumps to.
//
// What changed is told twice a second at most, what waits longest first, and no more of it than a budget of
// bytes; at the end all that waits. For one normal thread; no tick writes voxels meanwhile.
#pragma once

#include <deque>
#include <map>
#include <optional>
#include <vector>

#include "haptic_server/recording/foxglove/foxglove_file.h"
#include "haptic_server/scene/setup/scene_setup.h"
#include "haptic_server/surface/mesh/mesher.h"

namespace bonemill {

class BoneTopics {
  public:
    static constexpr double kPeriod = 0.5;                // s
    static constexpr size_t kBytesPerUpdate = 1'000'000;  // before they are packed, on average
    static constexpr int kMostNodes = 64;

    // Both must outlive this object.
    BoneTopics(const SceneSetup& simulation, FoxgloveFile& file);

    // Every tick, with its session time; the first time the whole bone goes out.
    void update(double t_s, uint64_t stamp_ns);
    // All that is left.
    void finish(uint64_t stamp_ns);

  private:
    struct Node {
        std::map<uint32_t, NodeMesh> leaves;  // by LeafId
        std::optional<uint16_t> channel;      // since it has a surface
        bool is_waiting = false;
    };
    void takeChanges();
    size_t put(size_t node, uint64_t stamp_ns);
    size_t nodeOf(uint32_t leaf) const;

    FoxgloveFile& file_;
    const LeafLattice& lattice_;
    Mesher mesher_;
    int shift_ = 0;                // a node has so many levels of the octree below it
    Eigen::Vector3i nodes_;        // per axis
    std::vector<Node> all_nodes_;  // x fastest
    std::deque<size_t> waiting_;
    double allowance_ = 0;  // bytes
    std::optional<double> next_s_;
};

}  // namespace bonemill
