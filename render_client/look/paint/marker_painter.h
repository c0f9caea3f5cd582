// Draws signs into the scene: the contact force as an arrow, the pull of a mouse as a line from the tool to a
// ring where it is wanted, a ring on the bone behind its burr that closes as the burr comes nearer, the way
// from the burr to the nearest structure, instructors' pointers as glowing dots in rings. What lies behind
// bone or tool shines through, fainter.
//
// It belongs to the thread of the context. The frames are C (camera) and W (world); the unit is m.
#pragma once

#include <vector>

#include "render_client/look/gl/gl_api.h"
#include "render_client/look/paint/frame.h"

namespace bonemill {

// It says how the arrow shows a force (N). Its length is a part of the picture's height, logarithmic between
// the smallest force that is shown and 20 N, and 0 below; its colour goes from green through yellow to red.
struct ForceLook {
    double length = 0;
    Eigen::Vector3f colour = Eigen::Vector3f::Zero();
};
ForceLook forceLook(double newtons);

// The ring behind a burr that hangs in front of the bone (m): as wide as the burr where that touches, and
// wider the farther the burr is away. `view` has a gap.
double gapRingRadius(const FrameView& view);

class MarkerPainter {
  public:
    explicit MarkerPainter(const GlApi& gl);

    // Draws into the bound framebuffer, whose depth it reads and leaves as it is.
    void draw(const Frame& frame, const FrameView& view);

    // Returns the box (C, m) around all that is drawn.
    Eigen::AlignedBox3f box(const Frame& frame, const FrameView& view);

  private:
    void addPointers(const Frame& frame, const FrameView& view);
    struct Vertex {
        Eigen::Vector3f p_C, n_C;
        Eigen::Vector4f colour;
    };
    void addPullLine(const Frame& frame, const FrameView& view);
    void addClearanceLine(const Frame& frame, const FrameView& view);
    void addGapRing(const Frame& frame, const FrameView& view);
    void addPullRing(const Frame& frame, const FrameView& view);
    void addArrow(const Frame& frame, const FrameView& view);
    // Adds the part of a cone between two radii, with its lower end at `base` (C).
    void addCone(const Eigen::Vector3f& base, const Eigen::Vector3f& axis, float low, float high,
                 const Eigen::Vector3f& colour);
    void addDisc(const Eigen::Vector3f& base, const Eigen::Vector3f& axis, float radius,
                 const Eigen::Vector3f& colour);
    void addPointer(const Eigen::Vector3f& p_C, float metres_per_height);
    // Adds a ring that faces the eye; the colour runs from the inner to the outer radius.
    void addRing(const Eigen::Vector3f& p_C, float inner, float outer, const Eigen::Vector4f& inner_colour,
                 const Eigen::Vector4f& outer_colour);
    void flush(const Frame& frame, GLenum culling);

    const GlApi& gl_;
    Program program_;
    GlVertexArray layout_;
    GlBuffer buffer_;
    std::vector<Vertex> vertices_;
};

}  // namespace bonemill
