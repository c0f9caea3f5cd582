// The protected structures of a scene: where they are, how far the burr is from them, which of them is seen
// at a place of the picture. It is for one thread.
#pragma once

#include <map>
#include <span>
#include <vector>

#include "common/geometry/pose.h"
#include "proto/topics.pb.h"
#include "render_client/look/structures/triangle_tree.h"

namespace bonemill {

// A ball stands for a part of the burr, or a point with radius 0.
struct BurrBall {
    Eigen::Vector3d center_T;
    double radius;  // m
};

// Reads them off a scene info, or takes one ball at the tool point where it names none.
std::vector<BurrBall> burrBallsOf(const topics::SceneInfo& info);

// The shortest way from the burr's surface to a structure.
struct Clearance {
    uint32_t structure = 0;
    Eigen::Vector3d burr_V = Eigen::Vector3d::Zero(), structure_V = Eigen::Vector3d::Zero();
    double distance = 0;  // m, negative where the burr is in the structure
    double warning_distance = 0;
};

class StructureSet {
  public:
    struct Structure {
        TriangleTree tree;
        double warning_distance;  // m
    };

    // Replaces the structure that the mesh's leaf names.
    void set(const NodeMesh& mesh, double warning_distance);
    void clear() { structures_.clear(); }

    const std::map<uint32_t, Structure>& all() const { return structures_; }
    Eigen::AlignedBox3f box() const;        // V, m; empty without structures
    double largestWarningDistance() const;  // m

    // Returns those that are nearer than their warning distance, the nearest first.
    std::vector<Clearance> clearances(std::span<const BurrBall> burr, const Pose& X_VT) const;

    // Returns how far it is from there to the nearest structure, at most `within`.
    float distance(const Eigen::Vector3f& p_V, float within) const;

  private:
    std::map<uint32_t, Structure> structures_;
};

}  // namespace bonemill
