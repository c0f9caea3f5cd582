// The handpiece that holds the tool is made here, of tubes. It is only drawn: contact knows nothing of it.
//
// Lengths are m in frame T: the tool's axis is y, the hand is at +y. The functions are pure, for any thread.
#pragma once

#include <Eigen/Core>
#include <optional>
#include <vector>

#include "proto/topics.pb.h"

namespace bonemill {

// The shaft ends there; behind it there is room.
struct ShaftEnd {
    float y;
    float radius;
};

// Returns the end of the tool's shaft; nothing where no shaft goes along +y.
std::optional<ShaftEnd> shaftEndOf(const topics::TriangleMesh& tool);

// A tube goes through these places; where the radius is 0 it is closed.
struct TubeStation {
    Eigen::Vector3f center;
    float radius;
};

// Adds the tube's surface, with normals that point outwards and are smooth but at sharp edges.
void addTube(const std::vector<TubeStation>& stations, topics::TriangleMesh* mesh);

// Nothing of it lies nearer to the burr than the shaft's end, but for the sleeve of a drill guide, which
// stands around the shaft's rear part. It is empty for NO_HANDPIECE.
topics::TriangleMesh makeHandpiece(topics::SceneInfo::Handpiece kind, const ShaftEnd& shaft);

}  // namespace bonemill
