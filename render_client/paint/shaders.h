// GLSL sources (without #version) of everything that is drawn. Colours are linear until toneMap().
#pragma once

namespace bonemill::shaders {

// Vertex attributes of meshes: 0 position (quantisation steps), 1 normal (octahedral ±127, or a vector for
// the tool), 2 material.
extern const char kMeshVertex[];        // bone nodes; #define MATERIALS: in their materials' colours
extern const char kToolVertex[];        // the tool
extern const char kShadowVertex[];      // shadow casters, bone or tool
extern const char kDepthFragment[];     // no colour
extern const char kFullScreenVertex[];  // 3 vertices, no attributes
extern const char kBackgroundFragment[];
extern const char kLighting[];  // goes before the next four and kParticleFragment
extern const char kNoise[];     // goes before the next two
extern const char
    kBoneFragment[];  // #define MATERIALS as its vertex shader, FILM: with blood and water on it
extern const char kCapFragment[];
extern const char kToolFragment[];  // #define SPIN: with flutes that turn
extern const char kGhostFragment[];
extern const char kOcclusionFragment[];
extern const char kCompositeFragment[];
extern const char kAnaglyphFragment[];
extern const char kParticleVertex[];
extern const char kParticleFragment[];
extern const char kMarkerVertex[];
extern const char kMarkerFragment[];
extern const char kHudVertex[];
extern const char kHudFragment[];

}  // namespace bonemill::shaders
