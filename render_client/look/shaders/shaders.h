// These are the GLSL sources (without #version) of everything that is drawn over or into the scene, each with
// what its file includes. kCapFragment stands in cap_fragment.glsl, and so on; the page for browsers takes
// the same files, and what differs there asks for GL_ES. Colours are linear until toneMap().
#pragma once

namespace bonemill::shaders {

// Bone. Vertex attribute 0 of a mesh is the position (quantisation steps), 1 the normal (octahedral, ±127), 2
// the material, 3 what the scan measured. What the surface has in each pixel is gathered first, with `#define
// MATERIALS` and `#define MILLED` before the vertices' shader, and shaded then: with `#define FILM` blood,
// water, burns and bruises lie on it, with `#define NEAR_STRUCTURES` it shows what shines through it or is
// near below it. The page shades each triangle (bone_fragment.glsl), with the words that it has a use for.
extern const char kMeshVertex[];
extern const char kBoneSurfaceFragment[];
extern const char kBoneShadeFragment[];  // with `#define SAMPLES 4`: of so many per pixel
extern const char kCapFragment[];        // the face of a cut; with `#define CT`: the scan on it

// Protected structures, of meshes as bone has them.
extern const char kStructureFragment[];  // with `#define FILM`: bruises lie on them
extern const char kSectionFragment[];    // a structure that a cut has opened

// Tool and ghost. Vertex attribute 0 is the position (T, m), 1 the normal.
extern const char kToolVertex[];
extern const char kToolFragment[];  // with `#define SPIN`: flutes turn
extern const char kGhostFragment[];

// The passes over the whole frame.
extern const char kShadowVertex[];   // what casts a shadow, bone or tool
extern const char kDepthFragment[];  // writes no colour
extern const char
    kFullScreenVertex[];  // a triangle over all of the picture, of 3 vertices without attributes
extern const char kBackgroundFragment[];
extern const char kOcclusionFragment[];
extern const char kCompositeFragment[];  // with `#define INSTRUMENT`: a round field, depth of field
extern const char kToolShadowFragment[];
extern const char kAnaglyphFragment[];

// Grains and drops.
extern const char kParticleVertex[];
extern const char kParticleFragment[];

// The force arrow and the pointers.
extern const char kMarkerVertex[];
extern const char kMarkerFragment[];

// Lines on the bone.
extern const char kStrokeVertex[];
extern const char kStrokeFragment[];

// A pane with a slice through the scan.
extern const char kSliceFragment[];

// Boxes and glyphs over the picture.
extern const char kHudVertex[];
extern const char kHudFragment[];

}  // namespace bonemill::shaders
