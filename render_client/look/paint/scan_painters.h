// Painters of the scan, on the faces of cuts and in panes. They belong to the thread of the context.
#pragma once

#include <array>
#include <optional>

#include "render_client/look/gl/gl_api.h"
#include "render_client/look/slices/slice_image.h"
#include "render_client/look/slices/slice_plane.h"

namespace bonemill {

// Shows the scan on the faces of cuts, from one texture per cut: grey values of the bone as it is now, or the
// colours of its materials where an image has them. Faces are plain where nothing has arrived yet.
class CtFaces {
  public:
    // Throws GlError with the compiler's log when the driver refuses the shader.
    explicit CtFaces(const GlApi& gl);

    // The cut across that axis of W (0 to 2) shows the image, which lies on that plane. Returns the box (V)
    // in which it looks different now.
    Eigen::AlignedBox3f set(size_t axis, const SlicePlane& plane, const SliceImage& image);
    // It is plain again.
    Eigen::AlignedBox3f remove(size_t axis);
    // The window turns densities into grey. Returns the box (V) in which faces look different now.
    Eigen::AlignedBox3f setWindow(const DensityGrid& grid, const GreyWindow& window);

    // cap() draws faces in place of the plain faces' program. While it is in use setUniforms() sets what is
    // said here; the textures take units 1 to 3.
    const Program& cap() const { return cap_; }
    void setUniforms() const;

  private:
    struct Face {
        explicit Face(const GlApi& gl) : texture(gl) {}
        GlTexture texture;
        SlicePlane plane;
        SliceImage image;
    };
    void upload(const Face& face) const;

    const GlApi& gl_;
    Program cap_;
    GlTexture nothing_;  // in place of a texture that there is not
    std::array<std::optional<Face>, 3> faces_;
    Eigen::Vector2f grey_of_density_ = Eigen::Vector2f::UnitX();
};

// Draws the panes with slices through the scan: their pixels, and where the burr is.
class SlicePainter {
  public:
    // Throws GlError with the compiler's log when the driver refuses the shader.
    explicit SlicePainter(const GlApi& gl);

    // Takes what the pane across that axis of W shows: red, green, blue and opacity per pixel, the upper row
    // first.
    void setPixels(size_t axis, const std::vector<uint8_t>& rgba, int width, int height);

    // Fills the last columns of the picture (pixels, in `target`) and draws the panes there. Leaves target
    // bound, and the viewport the whole picture.
    void paint(const std::array<Pane, 3>& panes, int columns, int width, int height, GLuint target) const;

  private:
    const GlApi& gl_;
    Program program_;
    GlVertexArray no_attributes_;
    std::array<GlTexture, 3> textures_;
};

}  // namespace bonemill
