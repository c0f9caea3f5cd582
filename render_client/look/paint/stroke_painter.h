// Draws what people drew on the bone as lines of a constant width, and where a note belongs as a dot. They
// lie a little before the surface that they were drawn on, and are hidden by what is in front of them.
//
// It belongs to the thread of the context. The frames are W (world) and C (camera); the unit is m.
#pragma once

#include <vector>

#include "render_client/look/gl/gl_object.h"
#include "render_client/look/paint/frame.h"

namespace bonemill {

class StrokePainter {
  public:
    explicit StrokePainter(const GlApi& gl);

    // Replaces all strokes.
    void set(const std::vector<Stroke>& strokes);
    // Draws into the bound framebuffer, whose depth it reads and leaves as it is.
    void draw(const Frame& frame, const FrameView& view) const;
    // Returns the box (C) around a stroke as it is drawn.
    static Eigen::AlignedBox3f box(const Stroke& stroke, const Frame& frame, const FrameView& view);

  private:
    struct Point {
        Eigen::Vector3f p_W, colour;
        float half_width;  // picture heights, of the line to the next point; 0: there is none
    };

    const GlApi& gl_;
    Program program_;
    GlVertexArray layout_;
    GlBuffer buffer_;
    GLsizei lines_ = 0;
};

}  // namespace bonemill
