#include "render_client/look/paint/stroke_painter.h"

#include <algorithm>
#include <cstddef>

#include "render_client/look/paint/clip_planes.h"
#include "render_client/look/shaders/shaders.h"

namespace bonemill {
namespace {

constexpr float kHalfLine = 0.0022f;  // picture heights
constexpr float kHalfDot = 0.0065f;

}  // namespace

StrokePainter::StrokePainter(const GlApi& gl)
    : gl_(gl),
      program_(gl, "stroke", shaders::kStrokeVertex, shaders::kStrokeFragment),
      layout_(gl),
      buffer_(gl) {
    gl_.BindVertexArray(layout_.name());
    gl_.BindBuffer(GL_ARRAY_BUFFER, buffer_.name());
    // A line goes from a point to the one after it.
    constexpr size_t kOffsets[] = {offsetof(Point, p_W), sizeof(Point) + offsetof(Point, p_W),
                                   offsetof(Point, colour), offsetof(Point, half_width)};
    constexpr GLint kSizes[] = {3, 3, 3, 1};
    for (GLuint i = 0; i < 4; ++i) {
        gl_.VertexAttribPointer(i, kSizes[i], GL_FLOAT, GL_FALSE, sizeof(Point),
                                reinterpret_cast<const void*>(kOffsets[i]));
        gl_.VertexAttribDivisor(i, 1);
        gl_.EnableVertexAttribArray(i);
    }
    gl_.BindVertexArray(0);
}

void StrokePainter::set(const std::vector<Stroke>& strokes) {
    if (strokes.empty() && lines_ == 0) return;
    std::vector<Point> points;
    for (const Stroke& stroke : strokes) {
        for (const Eigen::Vector3f& p_W : stroke.points_W) points.push_back({p_W, stroke.colour, kHalfLine});
        if (stroke.points_W.size() == 1) points.push_back({stroke.points_W[0], stroke.colour, kHalfLine});
        if (stroke.points_W.size() == 1) points[points.size() - 2].half_width = kHalfDot;
        if (!stroke.points_W.empty()) points.back().half_width = 0;
    }
    lines_ = GLsizei(points.empty() ? 0 : points.size() - 1);
    gl_.BindBuffer(GL_ARRAY_BUFFER, buffer_.name());
    gl_.BufferData(GL_ARRAY_BUFFER, GLsizeiptr(points.size() * sizeof(Point)), points.data(),
                   GL_DYNAMIC_DRAW);
}

void StrokePainter::draw(const Frame& frame, const FrameView& view) const {
    if (lines_ == 0) return;
    const ClipPlanes clip(gl_, frame.cuts_C);
    gl_.Enable(GL_DEPTH_TEST);
    gl_.DepthMask(GL_FALSE);
    program_.use();
    program_.set("camera_from_world", view.camera.X_CW());
    program_.set("clip_from_camera", frame.clip_from_camera);
    program_.set("height_per_depth", 2 * frame.tangents.y());
    program_.set("nearest", frame.near_far.x());
    setCutPlanes(program_, frame.cuts_C);
    gl_.BindVertexArray(layout_.name());
    gl_.DrawArraysInstanced(GL_TRIANGLE_STRIP, 0, 4, lines_);
    gl_.BindVertexArray(0);
    gl_.DepthMask(GL_TRUE);
}

Eigen::AlignedBox3f StrokePainter::box(const Stroke& stroke, const Frame& frame, const FrameView& view) {
    Eigen::AlignedBox3f box;
    const Eigen::Matrix4f X_CW = view.camera.X_CW();
    for (const Eigen::Vector3f& p_W : stroke.points_W) {
        const Eigen::Vector3f p_C = (X_CW * p_W.homogeneous()).head<3>();
        const float room = 3 * kHalfDot * 2 * frame.tangents.y() * std::max(-p_C.z(), 0.0f);
        box.extend(Eigen::Vector3f(p_C.array() - room));
        box.extend(Eigen::Vector3f(p_C.array() + room));
    }
    return box;
}

}  // namespace bonemill
