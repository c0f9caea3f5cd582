#include "render_client/look/paint/scan_painters.h"

#include <algorithm>
#include <string>

#include "render_client/look/shaders/shaders.h"
#include "render_client/look/slices/slice_image.h"

namespace bonemill {
namespace {

constexpr float kNowhere = -1e6f;

constexpr GLenum kFirstUnit = 1;  // of the textures; 0 is the shadow's
constexpr uint16_t kKnown = 65535;

// Returns density and whether it is known, per pixel.
std::vector<uint16_t> texelsOf(const SliceImage& image) {
    std::vector<uint16_t> texels;
    texels.reserve(2 * image.state.size());
    for (size_t i = 0; i < image.state.size(); ++i) {
        const bool is_known = image.state[i] == SliceState::kHere;
        texels.insert(texels.end(),
                      {is_known ? image.present[i] : uint16_t(0), is_known ? kKnown : uint16_t(0)});
    }
    return texels;
}

// Returns the box around the pixels from one to the other, and what lies half blended beside them.
Eigen::AlignedBox3f boxOfPixels(const SlicePlane& plane, int x0, int y0, int x1, int y1) {
    Eigen::AlignedBox3f box;
    for (const int x : {x0 - 1, x1 + 1})
        for (const int y : {y0 - 1, y1 + 1})
            box.extend((plane.corner_V + x * plane.right_V + y * plane.down_V).cast<float>());
    return box;
}

Eigen::AlignedBox3f boxOfPlane(const SlicePlane& plane) {
    return boxOfPixels(plane, 0, 0, plane.width - 1, plane.height - 1);
}

bool haveSameColour(const SliceImage& a, const SliceImage& b, size_t pixel) {
    if (a.colours.empty() || b.colours.empty()) return a.colours.empty() == b.colours.empty();
    return std::equal(&a.colours[4 * pixel], &a.colours[4 * pixel] + 4, &b.colours[4 * pixel]);
}

Eigen::AlignedBox3f differenceBox(const SlicePlane& plane, const SliceImage& a, const SliceImage& b) {
    int x0 = plane.width, y0 = plane.height, x1 = -1, y1 = -1;
    size_t i = 0;
    for (int y = 0; y < plane.height; ++y)
        for (int x = 0; x < plane.width; ++x, ++i) {
            if (a.present[i] == b.present[i] && a.state[i] == b.state[i] && haveSameColour(a, b, i)) continue;
            x0 = std::min(x0, x), x1 = std::max(x1, x);
            y0 = std::min(y0, y), y1 = std::max(y1, y);
        }
    return x1 < 0 ? Eigen::AlignedBox3f() : boxOfPixels(plane, x0, y0, x1, y1);
}

// Takes V to the texture's (u, v).
Eigen::Matrix4f textureFromVolume(const SlicePlane& plane) {
    Eigen::Matrix4d matrix = Eigen::Matrix4d::Zero();
    const auto setRow = [&](Eigen::Index row, const Eigen::Vector3d& step, int size) {
        const Eigen::Vector3d per_pixel = step / step.squaredNorm();
        matrix.block<1, 3>(row, 0) = per_pixel.transpose() / size;
        matrix(row, 3) = (0.5 - per_pixel.dot(plane.corner_V)) / size;
    };
    setRow(0, plane.right_V, plane.width);
    setRow(1, plane.down_V, plane.height);
    return matrix.cast<float>();
}

}  // namespace

SlicePainter::SlicePainter(const GlApi& gl)
    : gl_(gl),
      program_(gl, "slice", shaders::kFullScreenVertex, shaders::kSliceFragment),
      no_attributes_(gl),
      textures_{GlTexture(gl), GlTexture(gl), GlTexture(gl)} {}

void SlicePainter::setPixels(size_t axis, const std::vector<uint8_t>& rgba, int width, int height) {
    gl_.ActiveTexture(GL_TEXTURE0);
    gl_.BindTexture(GL_TEXTURE_2D, textures_[axis].name());
    gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
    gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, rgba.data());
    gl_.setSampling(GL_TEXTURE_2D, GL_NEAREST, GL_REPEAT);
}

void SlicePainter::paint(const std::array<Pane, 3>& panes, int columns, int width, int height,
                         GLuint target) const {
    gl_.BindFramebuffer(GL_FRAMEBUFFER, target);
    gl_.Enable(GL_SCISSOR_TEST);
    gl_.Scissor(width - columns, 0, columns, height);
    gl_.ClearColor(0.055f, 0.066f, 0.082f, 1);
    gl_.Clear(GL_COLOR_BUFFER_BIT);
    gl_.ClearColor(0, 0, 0, 1);
    gl_.Disable(GL_SCISSOR_TEST);
    gl_.Disable(GL_DEPTH_TEST);
    gl_.Disable(GL_BLEND);
    program_.use();
    program_.set("slice", 0);
    gl_.ActiveTexture(GL_TEXTURE0);
    gl_.BindVertexArray(no_attributes_.name());
    for (const Pane& pane : panes) {
        const PaneRect& rect = pane.rect;
        gl_.Viewport(rect.x, height - rect.y - rect.height, rect.width, rect.height);
        gl_.BindTexture(GL_TEXTURE_2D, textures_[pane.axis].name());
        program_.set("size", Eigen::Vector2f(float(rect.width), float(rect.height)));
        program_.set("burr", pane.cross ? Eigen::Vector2f(pane.cross->cast<float>())
                                        : Eigen::Vector2f(kNowhere, kNowhere));
        program_.set("circle", float(pane.circle));
        gl_.DrawArrays(GL_TRIANGLES, 0, 3);
    }
    gl_.BindVertexArray(0);
    gl_.Viewport(0, 0, width, height);
    gl_.check("drawing the slices");
}

CtFaces::CtFaces(const GlApi& gl)
    : gl_(gl),
      cap_(gl, "cap with the scan", shaders::kFullScreenVertex,
           std::string("#define CT\n") + shaders::kCapFragment),
      nothing_(gl) {
    SliceImage nothing{1, 1, {0}, {0}, {SliceState::kOutside}, {}};
    Face face(gl);
    std::swap(face.texture, nothing_);
    face.image = nothing;
    upload(face);
    std::swap(face.texture, nothing_);
}

void CtFaces::upload(const Face& face) const {
    gl_.ActiveTexture(GL_TEXTURE0 + kFirstUnit);
    gl_.BindTexture(GL_TEXTURE_2D, face.texture.name());
    gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 4);
    const SliceImage& image = face.image;
    if (image.colours.empty())
        gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RG16, image.width, image.height, 0, GL_RG, GL_UNSIGNED_SHORT,
                       texelsOf(image).data());
    else
        gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA16, image.width, image.height, 0, GL_RGBA, GL_UNSIGNED_SHORT,
                       image.colours.data());
    gl_.setSampling(GL_TEXTURE_2D, GL_LINEAR);
    gl_.ActiveTexture(GL_TEXTURE0);
    gl_.check("making the texture of a cut");
}

Eigen::AlignedBox3f CtFaces::set(size_t axis, const SlicePlane& plane, const SliceImage& image) {
    std::optional<Face>& face = faces_[axis];
    Eigen::AlignedBox3f changed;
    if (face && face->plane == plane) {
        changed = differenceBox(plane, face->image, image);
    } else {
        changed = boxOfPlane(plane);
        if (face) changed.extend(boxOfPlane(face->plane));
    }
    if (changed.isEmpty()) return changed;
    if (!face) face.emplace(gl_);
    face->plane = plane;
    face->image = image;
    upload(*face);
    return changed;
}

Eigen::AlignedBox3f CtFaces::remove(size_t axis) {
    if (!faces_[axis]) return {};
    const Eigen::AlignedBox3f changed = boxOfPlane(faces_[axis]->plane);
    faces_[axis].reset();
    return changed;
}

Eigen::AlignedBox3f CtFaces::setWindow(const DensityGrid& grid, const GreyWindow& window) {
    const Eigen::Vector2f grey = greyOfDensity(grid, window).cast<float>();
    Eigen::AlignedBox3f changed;
    if (std::exchange(grey_of_density_, grey) == grey) return changed;
    for (const auto& face : faces_)
        if (face) changed.extend(boxOfPlane(face->plane));
    return changed;
}

void CtFaces::setUniforms() const {
    constexpr const char* kMaps[] = {"ct_x", "ct_y", "ct_z"};
    constexpr const char* kMatrices[] = {"ct_from_model[0]", "ct_from_model[1]", "ct_from_model[2]"};
    bool has_colours = false;  // all faces have them, or none has
    for (size_t axis = 0; axis < 3; ++axis) {
        const GLenum unit = kFirstUnit + GLenum(axis);
        gl_.ActiveTexture(GL_TEXTURE0 + unit);
        gl_.BindTexture(GL_TEXTURE_2D, faces_[axis] ? faces_[axis]->texture.name() : nothing_.name());
        cap_.set(kMaps[axis], int(unit));
        has_colours |= faces_[axis] && !faces_[axis]->image.colours.empty();
        cap_.set(kMatrices[axis], faces_[axis] ? textureFromVolume(faces_[axis]->plane)
                                               : Eigen::Matrix4f(Eigen::Matrix4f::Zero()));
    }
    gl_.ActiveTexture(GL_TEXTURE0);
    cap_.set("grey_of_density", grey_of_density_);
    cap_.set("shows_materials", has_colours ? 1 : 0);
}

}  // namespace bonemill
