// The protected structures of a scene: where they are, how far the burr is from them, which of them is seen
// at a place of the picture, and their colours. A set is for one thread; the functions are pure.
#pragma once

#include <Eigen/Core>
#include <array>
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

// How much there is from any place near the structures to the next of them, in samples on a grid: bone that
// is looked at takes its colour from here. It is a plain value.
struct ThicknessField {
    static constexpr int kMaxSamples = 1 << 19, kMaxPerAxis = 256;

    Eigen::Vector3f first_V = Eigen::Vector3f::Zero();  // m, of the first sample
    float step = 0;                                     // m
    Eigen::Vector3i size = Eigen::Vector3i::Zero();     // samples; 0: nothing is near
    float reach = 0;                                    // m
    std::vector<uint8_t> shares;  // of the reach, x fastest; 255: it is as far or farther
};

// Samples lie at least 0.4 mm apart, and there are kMaxSamples at most, however large the structures are.
// Only those near a structure are computed one by one. It takes tenths of a second.
ThicknessField thicknessField(const StructureSet& structures, double reach);

// Returns the scene's colour of a material (sRGB, 0 to 1), or else what its name asks for by the custom of
// anatomy books: nerves yellow, veins blue, arteries red, dura violet. Others take their turn in a row of
// colours that people who see no red or no green can tell apart (Okabe and Ito 2008).
Eigen::Vector3f structureColour(const topics::SceneInfo& info, uint32_t structure);

// Returns the linear colour of an sRGB one, as the shaders' toneMap() takes it for, and back.
Eigen::Vector3f linearColour(const Eigen::Vector3f& srgb);
Eigen::Vector3f srgbColour(const Eigen::Vector3f& linear);

// These colours (linear) stand for distances from 0 to the reach. They run from dark red through orange and
// yellow to blue: bright and dark tell them apart without hues, too.
constexpr int kThicknessColours = 5;
const std::array<Eigen::Vector3f, kThicknessColours>& thicknessColours();

// The colour of a distance to a structure: red at 0, yellow at half of the warning distance, green from there
// on.
Eigen::Vector3f distanceColour(double distance, double warning_distance);

}  // namespace bonemill
