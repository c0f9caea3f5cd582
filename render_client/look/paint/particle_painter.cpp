#include "render_client/look/paint/particle_painter.h"

#include <algorithm>
#include <cstddef>

#include "render_client/look/shaders/shaders.h"

namespace bonemill {
namespace {

constexpr float kSmallest = 0.75f;  // pixels, radius; what is smaller is drawn so large, and fainter
constexpr float kMinDepth = 1e-4f;  // m before the eye

// Returns how many metres a pixel of the picture spans at this depth.
float pixelAt(const Frame& frame, float depth, int height) {
    return 2 * frame.tangents.y() * depth / float(height);
}

struct Placed {
    Eigen::Vector3f from, to;  // C
    float radius;
};

Placed place(const Frame& frame, const Particle& particle, int height) {
    const auto X = frame.X_CV.topLeftCorner<3, 3>();
    const Eigen::Vector3f from = X * particle.p_V + frame.X_CV.topRightCorner<3, 1>();
    const float least = kSmallest * pixelAt(frame, std::max(-from.z(), 0.0f), height);
    return {from, from + X * particle.streak_V, std::max(particle.radius, least)};
}

}  // namespace

ParticlePainter::ParticlePainter(const GlApi& gl)
    : gl_(gl),
      program_(gl, "particle", shaders::kParticleVertex, shaders::kParticleFragment),
      layout_(gl),
      buffer_(gl) {
    gl_.BindVertexArray(layout_.name());
    gl_.BindBuffer(GL_ARRAY_BUFFER, buffer_.name());
    const auto attribute = [&](GLuint index, GLint size, size_t offset) {
        gl_.VertexAttribPointer(index, size, GL_FLOAT, GL_FALSE, sizeof(Vertex),
                                reinterpret_cast<const void*>(offset));
        gl_.EnableVertexAttribArray(index);
    };
    attribute(0, 3, offsetof(Vertex, p_C));
    attribute(1, 2, offsetof(Vertex, uv));
    attribute(2, 3, offsetof(Vertex, along));  // and half_length
    attribute(3, 4, offsetof(Vertex, colour));
    attribute(4, 1, offsetof(Vertex, gloss));
    gl_.BindVertexArray(0);
}

void ParticlePainter::add(const Frame& frame, const Particle& particle, int height) {
    const Placed placed = place(frame, particle, height);
    if (-placed.from.z() < kMinDepth || -placed.to.z() < kMinDepth) return;
    const Eigen::Vector3f middle = (placed.from + placed.to) / 2;
    const Eigen::Vector2f length = (placed.to - placed.from).head<2>();
    const Eigen::Vector2f along =
        length.norm() > 1e-9f ? length.normalized() : Eigen::Vector2f::UnitX().eval();
    const Eigen::Vector2f across(-along.y(), along.x());
    const float half = length.norm() / 2 / placed.radius;
    Eigen::Vector4f colour = particle.colour;
    colour.w() *= (particle.radius / placed.radius) * std::min(1.0f, 2 * particle.radius / placed.radius);
    const auto corner = [&](float u, float v) {
        const Eigen::Vector2f uv((half + 1) * u, v);
        const Eigen::Vector2f off = placed.radius * (uv.x() * along + uv.y() * across);
        Eigen::Vector3f p = middle;
        p.head<2>() += off;
        return Vertex{p, uv, along, half, colour, particle.gloss};
    };
    const Vertex a = corner(-1, -1), b = corner(1, -1), c = corner(1, 1), d = corner(-1, 1);
    vertices_.insert(vertices_.end(), {a, b, c, a, c, d});
}

Eigen::AlignedBox3f ParticlePainter::box(const Frame& frame, const Particles& particles, int height) {
    Eigen::AlignedBox3f box;
    for (const Particle& particle : particles) {
        const Placed placed = place(frame, particle, height);
        if (-placed.from.z() < kMinDepth || -placed.to.z() < kMinDepth) continue;
        const Eigen::Vector3f margin = Eigen::Vector3f::Constant(placed.radius);
        for (const Eigen::Vector3f& end : {placed.from, placed.to}) {
            box.extend(end - margin);
            box.extend(end + margin);
        }
    }
    return box;
}

void ParticlePainter::draw(const Frame& frame, const Particles& particles, int height,
                           GLuint shadow_texture) {
    vertices_.clear();
    for (const Particle& particle : particles) add(frame, particle, height);
    if (vertices_.empty()) return;
    gl_.Enable(GL_DEPTH_TEST);
    gl_.Enable(GL_BLEND);
    gl_.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    gl_.DepthMask(GL_FALSE);
    program_.use();
    frame.setLight(gl_, program_, shadow_texture);
    gl_.BindVertexArray(layout_.name());
    gl_.BindBuffer(GL_ARRAY_BUFFER, buffer_.name());
    gl_.BufferData(GL_ARRAY_BUFFER, GLsizeiptr(vertices_.size() * sizeof(Vertex)), vertices_.data(),
                   GL_STREAM_DRAW);
    gl_.DrawArrays(GL_TRIANGLES, 0, GLsizei(vertices_.size()));
    gl_.BindVertexArray(0);
    gl_.DepthMask(GL_TRUE);
    gl_.Disable(GL_BLEND);
}

}  // namespace bonemill
