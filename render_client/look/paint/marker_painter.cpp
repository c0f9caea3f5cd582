#include "render_client/look/paint/marker_painter.h"

#include <algorithm>
#include <cmath>
#include <cstddef>

#include "render_client/look/shaders/shaders.h"

namespace bonemill {
namespace {

constexpr double kSmallestForce = 0.05;  // N: below, nothing is shown
constexpr double kGreenForce = 0.2;      // N
constexpr double kLargestForce = 20;     // N
constexpr double kShortest = 0.05;       // of the picture's height
constexpr double kLongest = 0.30;

constexpr float kShaft = 0.0060f;  // radii and lengths of the arrow in picture heights
constexpr float kHead = 0.0155f;
constexpr float kHeadLength = 0.040f;
constexpr float kDot = 0.008f;
constexpr float kRing = 0.022f;
constexpr float kRingWidth = 0.0045f;
constexpr float kGlow = 0.036f;
constexpr float kPullLine = 0.0038f;
constexpr float kPullRing = 0.014f;
constexpr float kClearanceLine = 0.0024f;
constexpr float kShortestPull = 0.006f;
constexpr float kGapRing = 0.005f;    // width
constexpr double kGapOpening = 0.35;  // of the gap, that the ring is wider than the burr
constexpr int kSides = 32;
constexpr float kHiddenStrength = 0.35f;

const Eigen::Vector3f kPointerColour(1.0f, 0.16f, 0.72f);
const Eigen::Vector3f kIdlePullColour(0.7f, 0.75f, 0.8f);
const Eigen::Vector4f kGapColour(0.15f, 0.75f, 1.0f, 0.9f);

Eigen::Vector4f withAlpha(const Eigen::Vector3f& colour, float alpha) {
    return {colour.x(), colour.y(), colour.z(), alpha};
}

double logarithmic(double value, double low, double high) {
    return std::clamp(std::log(value / low) / std::log(high / low), 0.0, 1.0);
}

// Returns the metres that the picture's height spans there.
float heightAt(const Frame& frame, const Eigen::Vector3f& p_C) {
    return 2 * frame.tangents.y() * -p_C.z();
}

struct PullEnds {
    Eigen::Vector3f tool_C, wish_C;
    Eigen::Vector3f colour;
};

// There are none without a pull that can be seen.
std::optional<PullEnds> pullEnds(const Frame& frame, const FrameView& view) {
    if (!frame.X_CT || !view.pull) return std::nullopt;
    PullEnds ends{frame.X_CT->topRightCorner<3, 1>(),
                  (view.camera.R_WC.transpose() * (view.pull->wish_W - view.camera.eye_W)).cast<float>(),
                  kIdlePullColour};
    const float near = frame.near_far.x();
    if (-ends.tool_C.z() <= near || -ends.wish_C.z() <= near ||
        (ends.wish_C - ends.tool_C).norm() < kShortestPull * heightAt(frame, ends.tool_C))
        return std::nullopt;
    const ForceLook look = forceLook(view.pull->newtons);
    if (look.length > 0) ends.colour = look.colour;
    return ends;
}

Eigen::Vector3f onCircle(int i, const Eigen::Vector3f& right, const Eigen::Vector3f& up) {
    const float angle = 2 * float(M_PI) * float(i) / kSides;
    return std::cos(angle) * right + std::sin(angle) * up;
}

}  // namespace

ForceLook forceLook(double newtons) {
    if (!(newtons >= kSmallestForce) || !std::isfinite(newtons)) return {};
    ForceLook look;
    look.length = kShortest + (kLongest - kShortest) * logarithmic(newtons, kSmallestForce, kLargestForce);
    const auto heat = float(logarithmic(newtons, kGreenForce, kLargestForce));
    look.colour = {std::min(2 * heat + 0.12f, 1.0f), std::min(2 - 2 * heat, 1.0f) * 0.85f, 0.10f};
    return look;
}

double gapRingRadius(const FrameView& view) {
    return view.burr_radius + kGapOpening * view.gap->distance;
}

MarkerPainter::MarkerPainter(const GlApi& gl)
    : gl_(gl),
      program_(gl, "marker", shaders::kMarkerVertex, shaders::kMarkerFragment),
      layout_(gl),
      buffer_(gl) {
    gl_.BindVertexArray(layout_.name());
    gl_.BindBuffer(GL_ARRAY_BUFFER, buffer_.name());
    gl_.setFloats(0, 3, sizeof(Vertex), offsetof(Vertex, p_C));
    gl_.setFloats(1, 3, sizeof(Vertex), offsetof(Vertex, n_C));
    gl_.setFloats(2, 4, sizeof(Vertex), offsetof(Vertex, colour));
    gl_.BindVertexArray(0);
}

void MarkerPainter::draw(const Frame& frame, const FrameView& view) {
    vertices_.clear();
    addPullLine(frame, view);
    addClearanceLine(frame, view);
    flush(frame, GL_BACK);
    addArrow(frame, view);
    flush(frame, GL_BACK);
    addGapRing(frame, view);
    addPullRing(frame, view);
    addPointers(frame, view);
    flush(frame, 0);
}

Eigen::AlignedBox3f MarkerPainter::box(const Frame& frame, const FrameView& view) {
    vertices_.clear();
    addPullLine(frame, view);
    addClearanceLine(frame, view);
    addArrow(frame, view);
    addGapRing(frame, view);
    addPullRing(frame, view);
    addPointers(frame, view);
    Eigen::AlignedBox3f box;
    for (const Vertex& vertex : vertices_) box.extend(vertex.p_C);
    vertices_.clear();
    return box;
}

// The line is there where tool and wish visibly part; it has the arrow's colours.
void MarkerPainter::addPullLine(const Frame& frame, const FrameView& view) {
    const auto ends = pullEnds(frame, view);
    if (!ends) return;
    const float radius = kPullLine * heightAt(frame, ends->wish_C);
    addCone(ends->tool_C, ends->wish_C - ends->tool_C, radius, radius, ends->colour);
}

void MarkerPainter::addClearanceLine(const Frame& frame, const FrameView& view) {
    if (!view.clearance) return;
    const Eigen::Matrix4f X_CW = view.camera.X_CW();
    const auto inCamera = [&](const Eigen::Vector3d& p_W) {
        return Eigen::Vector3f((X_CW * p_W.cast<float>().homogeneous()).head<3>());
    };
    const Eigen::Vector3f burr_C = inCamera(view.clearance->burr_W);
    const Eigen::Vector3f structure_C = inCamera(view.clearance->structure_W);
    if (std::min(-burr_C.z(), -structure_C.z()) <= frame.near_far.x()) return;
    const float radius = kClearanceLine * heightAt(frame, structure_C);
    if ((structure_C - burr_C).norm() < radius) return;
    addCone(burr_C, structure_C - burr_C, radius, radius, view.clearance->colour);
    addDisc(structure_C, (burr_C - structure_C).normalized(), 3 * radius, view.clearance->colour);
}

void MarkerPainter::addGapRing(const Frame& frame, const FrameView& view) {
    if (!view.gap) return;
    const Eigen::Vector3f p_C =
        (view.camera.R_WC.transpose() * (view.gap->surface_W - view.camera.eye_W)).cast<float>();
    if (-p_C.z() <= frame.near_far.x()) return;
    const float width = kGapRing * heightAt(frame, p_C);
    const auto inner = float(gapRingRadius(view));
    // A little nearer than the surface, whose bends would swallow it.
    const Eigen::Vector3f near_C = p_C * (1 - std::min(0.5f, inner / p_C.norm()));
    addRing(near_C, inner, inner + width, kGapColour, kGapColour);
}

void MarkerPainter::addPullRing(const Frame& frame, const FrameView& view) {
    const auto ends = pullEnds(frame, view);
    if (!ends) return;
    const float radius = kPullRing * heightAt(frame, ends->wish_C);
    const Eigen::Vector4f colour = withAlpha(ends->colour, 1);
    addRing(ends->wish_C, 0.6f * radius, radius, colour, colour);
}

void MarkerPainter::addPointers(const Frame& frame, const FrameView& view) {
    const Eigen::Matrix4f X_CW = view.camera.X_CW();
    for (const Eigen::Vector3d& p_W : view.pointers_W) {
        const Eigen::Vector4f p = X_CW * p_W.cast<float>().homogeneous();
        if (-p.z() > frame.near_far.x()) addPointer(p.head<3>(), heightAt(frame, p.head<3>()));
    }
}

// The arrow starts at the burr's surface and points the way in which the force pushes the hand. Its
// head has a constant size.
void MarkerPainter::addArrow(const Frame& frame, const FrameView& view) {
    if (!frame.X_CT || !view.f_T_W) return;
    const double newtons = view.f_T_W->norm();
    const ForceLook look = forceLook(newtons);
    const Eigen::Vector3f burr = frame.X_CT->topRightCorner<3, 1>();
    if (look.length <= 0 || -burr.z() <= frame.near_far.x()) return;
    const float height = heightAt(frame, burr);
    const Eigen::Vector3f axis = (view.camera.R_WC.transpose() * *view.f_T_W / newtons).cast<float>();
    const float head = std::min(kHeadLength, 0.7f * float(look.length)) * height;
    const float shaft = float(look.length) * height - head;
    const Eigen::Vector3f base = burr + float(view.burr_radius) * axis;
    const Eigen::Vector3f neck = base + shaft * axis;
    const auto addShaft = [&] {
        addDisc(base, -axis, kShaft * height, look.colour);
        addCone(base, shaft * axis, kShaft * height, kShaft * height, look.colour);
    };
    const auto addHead = [&] {
        addDisc(neck, -axis, kHead * height, look.colour);
        addCone(neck, head * axis, kHead * height, 0, look.colour);
    };
    // Both are convex: with the farther one drawn first, no depth has to be written.
    const bool head_is_nearer = axis.dot(neck) < 0;
    head_is_nearer ? addShaft() : addHead();
    head_is_nearer ? addHead() : addShaft();
}

void MarkerPainter::addCone(const Eigen::Vector3f& base, const Eigen::Vector3f& axis, float low, float high,
                            const Eigen::Vector3f& colour) {
    const Eigen::Vector3f along = axis.normalized(), right = along.unitOrthogonal(), up = along.cross(right);
    const float slope = (low - high) / axis.norm();
    const Eigen::Vector4f opaque = withAlpha(colour, 1);
    const auto vertex = [&](int i, bool is_high) {
        const Eigen::Vector3f out = onCircle(i, right, up);
        const Eigen::Vector3f p =
            base + (is_high ? axis : Eigen::Vector3f::Zero().eval()) + (is_high ? high : low) * out;
        return Vertex{p, (out + slope * along).normalized(), opaque};
    };
    for (int i = 0; i < kSides; ++i) {
        const Vertex a = vertex(i, false), b = vertex(i + 1, false), c = vertex(i + 1, true),
                     d = vertex(i, true);
        vertices_.insert(vertices_.end(), {a, b, c, a, c, d});
    }
}

void MarkerPainter::addDisc(const Eigen::Vector3f& base, const Eigen::Vector3f& axis, float radius,
                            const Eigen::Vector3f& colour) {
    const Eigen::Vector3f right = axis.unitOrthogonal(), up = axis.cross(right);
    const Eigen::Vector4f opaque = withAlpha(colour, 1);
    for (int i = 0; i < kSides; ++i)
        for (const Eigen::Vector3f& p : {base, Eigen::Vector3f(base + radius * onCircle(i, right, up)),
                                         Eigen::Vector3f(base + radius * onCircle(i + 1, right, up))})
            vertices_.push_back({p, axis, opaque});
}

// The sign stands a little nearer than the surface that it marks, so that the surface's
// bends do not swallow it.
void MarkerPainter::addPointer(const Eigen::Vector3f& p_C, float metres_per_height) {
    const float m = metres_per_height;
    const Eigen::Vector3f p = p_C * (1 - kRing * m / p_C.norm());
    const Eigen::Vector4f full = withAlpha(kPointerColour, 1), core(1, 0.85f, 0.97f, 1);
    addRing(p, 0, kGlow * m, withAlpha(kPointerColour, 0.55f), withAlpha(kPointerColour, 0));
    addRing(p, (kRing - kRingWidth) * m, kRing * m, full, full);
    addRing(p, 0, kDot * m, core, full);
}

void MarkerPainter::addRing(const Eigen::Vector3f& p_C, float inner, float outer,
                            const Eigen::Vector4f& inner_colour, const Eigen::Vector4f& outer_colour) {
    const Eigen::Vector3f glows = Eigen::Vector3f::Zero();
    const auto vertex = [&](int i, bool is_outer) {
        const Eigen::Vector3f out = onCircle(i, Eigen::Vector3f::UnitX(), Eigen::Vector3f::UnitY());
        return Vertex{p_C + (is_outer ? outer : inner) * out, glows, is_outer ? outer_colour : inner_colour};
    };
    for (int i = 0; i < kSides; ++i) {
        const Vertex a = vertex(i, false), b = vertex(i, true), c = vertex(i + 1, true),
                     d = vertex(i + 1, false);
        vertices_.insert(vertices_.end(), {a, b, c, a, c, d});
    }
}

void MarkerPainter::flush(const Frame& frame, GLenum culling) {
    if (vertices_.empty()) return;
    gl_.Enable(GL_BLEND);
    gl_.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    gl_.DepthMask(GL_FALSE);
    if (culling) {
        gl_.Enable(GL_CULL_FACE);
        gl_.CullFace(culling);
    }
    program_.use();
    program_.set("clip_from_camera", frame.clip_from_camera);
    gl_.BindVertexArray(layout_.name());
    gl_.BindBuffer(GL_ARRAY_BUFFER, buffer_.name());
    gl_.BufferData(GL_ARRAY_BUFFER, GLsizeiptr(vertices_.size() * sizeof(Vertex)), vertices_.data(),
                   GL_STREAM_DRAW);
    constexpr struct {
        GLenum depth_test;
        float strength;
    } kPasses[] = {{GL_GREATER, kHiddenStrength}, {GL_LEQUAL, 1}};
    for (const auto& pass : kPasses) {
        gl_.DepthFunc(pass.depth_test);
        program_.set("strength", pass.strength);
        gl_.DrawArrays(GL_TRIANGLES, 0, GLsizei(vertices_.size()));
    }
    gl_.BindVertexArray(0);
    gl_.DepthFunc(GL_LESS);
    gl_.DepthMask(GL_TRUE);
    gl_.Disable(GL_CULL_FACE);
    gl_.Disable(GL_BLEND);
    vertices_.clear();
}

}  // namespace bonemill
