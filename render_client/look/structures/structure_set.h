// The protected structures of a scene: where they are, how far the burr is from them, which of them is seen
// at a place of the picture, and their colours. A set is for one thread; the functions are pure.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <map>
#include <optional>
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

    struct Nearest {
        uint32_t structure;
        float distance;  // m; 0 within it
    };
    // Of those that counts(structure) is true of; there is none at `within` or farther.
    template <class Counts>
    std::optional<Nearest> nearest(const Eigen::Vector3f& p_V, float within, Counts&& counts) const {
        std::optional<Nearest> nearest;
        for (const auto& [id, structure] : structures_) {
            const float least = nearest ? nearest->distance : within;
            if (!counts(id) || structure.tree.box().squaredExteriorDistance(p_V) >= least * least) continue;
            if (const auto place = nearestOf(structure.tree, p_V, least); place && place->distance < least)
                nearest = Nearest{id, std::max(place->distance, 0.0f)};
        }
        return nearest;
    }

  private:
    // What lies deep in a structure is far from its surface, and yet not far from the structure.
    static std::optional<NearestPlace> nearestOf(const TriangleTree& tree, const Eigen::Vector3f& p_V,
                                                 float within) {
        return tree.nearest(p_V, tree.box().contains(p_V) ? TriangleTree::kAnyDistance : within);
    }
    std::map<uint32_t, Structure> structures_;
};

// Returns the scene's colour of a material (sRGB, 0 to 1), or else what its name asks for by the custom of
// anatomy books: nerves yellow, veins blue, arteries red, dura violet. Others take their turn in a row of
// colours that people who see no red or no green can tell apart (Okabe and Ito 2008).
Eigen::Vector3f structureColour(const topics::SceneInfo& info, uint32_t structure);

// Returns the linear colour of an sRGB one, as the shaders' toneMap() takes it for, and back.
Eigen::Vector3f linearColour(const Eigen::Vector3f& srgb);
Eigen::Vector3f srgbColour(const Eigen::Vector3f& linear);

// The colour of a distance to a structure: red at 0, yellow at half of the warning distance, green from there
// on.
Eigen::Vector3f distanceColour(double distance, double warning_distance);

}  // namespace bonemill
