// These are the GLSL sources (without #version) of everything that is drawn over or into the scene. Each
// group stands in the source file that its heading names. Colours are linear until toneMap().
#pragma once

namespace bonemill::shaders {

// lighting_shaders.cpp has what goes before other sources.
extern const char kLighting[];  // before the fragment shaders of bone, cap, tool and particles
extern const char kNoise[];     // after kLighting, before those of bone and cap

// bone_shaders.cpp draws bone and cap. Vertex attribute 0 of a mesh is the position (quantisation steps),
// 1 the normal (octahedral, ±127), 2 the material, 3 what the scan measured. With `#define MATERIALS` before
// both shaders, bone has its materials' colours; with `#define THICKNESS` the colour of its distance to the
// next structure.
extern const char kMeshVertex[];
extern const char kBoneFragment[];  // with `#define FILM`: blood and water lie on it
extern const char kCapFragment[];   // the face of a cut; with `#define CT`: the scan's grey values on it

// structure_shaders.cpp draws protected structures, of meshes as bone has them.
extern const char kStructureFragment[];  // after kLighting
extern const char kSectionFragment[];    // after kLighting: a structure that a cut has opened

// tool_shaders.cpp draws tool and ghost. Vertex attribute 0 is the position (T, m), 1 the normal.
extern const char kToolVertex[];
extern const char kToolFragment[];  // with `#define SPIN`: flutes turn
extern const char kGhostFragment[];

// frame_shaders.cpp has the passes over the whole frame.
extern const char kShadowVertex[];   // what casts a shadow, bone or tool
extern const char kDepthFragment[];  // writes no colour
extern const char
    kFullScreenVertex[];  // makes a triangle over all of the picture from 3 vertices without attributes
extern const char kBackgroundFragment[];
extern const char kOcclusionFragment[];
extern const char kCompositeFragment[];  // with `#define INSTRUMENT`: a round field, depth of field
extern const char kToolShadowFragment[];
extern const char kAnaglyphFragment[];

// particle_shaders.cpp draws grains and drops.
extern const char kParticleVertex[];
extern const char kParticleFragment[];

// marker_shaders.cpp draws the force arrow and the pointers.
extern const char kMarkerVertex[];
extern const char kMarkerFragment[];

// stroke_shaders.cpp draws lines on the bone.
extern const char kStrokeVertex[];
extern const char kStrokeFragment[];

// slice_shaders.cpp draws a pane with a slice through the scan.
extern const char kSliceFragment[];

// hud_shaders.cpp draws boxes and glyphs over the picture.
extern const char kHudVertex[];
extern const char kHudFragment[];

}  // namespace bonemill::shaders
