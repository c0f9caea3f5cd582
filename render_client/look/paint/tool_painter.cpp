#include "render_client/look/paint/tool_painter.h"

#include <algorithm>
#include <cstddef>
#include <string>

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

// The burr has a light of its own while it works: orange where it removes, the brighter the harder it
// presses, blue where it adds.
Eigen::Vector3f glowOf(BurrWork work, double load) {
    constexpr float kFaintest = 0.35f;
    switch (work) {
        case BurrWork::kRemoving:
            return (kFaintest + (1 - kFaintest) * float(load)) * Eigen::Vector3f(1.9f, 0.30f, 0.02f);
        case BurrWork::kAdding:
            return {0.05f, 0.75f, 1.1f};
        case BurrWork::kTurning:
        case BurrWork::kIdle:
            break;
    }
    return Eigen::Vector3f::Zero();
}

}  // namespace

ParticlePainter::ParticlePainter(const GlApi& gl)
    : gl_(gl),
      program_(gl, "particle", shaders::kParticleVertex, shaders::kParticleFragment),
      layout_(gl),
      buffer_(gl) {
    gl_.BindVertexArray(layout_.name());
    gl_.BindBuffer(GL_ARRAY_BUFFER, buffer_.name());
    gl_.setFloats(0, 3, sizeof(Vertex), offsetof(Vertex, p_C));
    gl_.setFloats(1, 2, sizeof(Vertex), offsetof(Vertex, uv));
    gl_.setFloats(2, 3, sizeof(Vertex), offsetof(Vertex, along));  // and half_length
    gl_.setFloats(3, 4, sizeof(Vertex), offsetof(Vertex, colour));
    gl_.setFloats(4, 1, sizeof(Vertex), offsetof(Vertex, gloss));
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

std::vector<Eigen::AlignedBox3f> ParticlePainter::boxes(const Frame& frame, const Particles& particles,
                                                        int height) {
    std::vector<Eigen::AlignedBox3f> boxes;
    for (const Particle& particle : particles) {
        const Placed placed = place(frame, particle, height);
        if (-placed.from.z() < kMinDepth || -placed.to.z() < kMinDepth) continue;
        const Eigen::Vector3f margin = Eigen::Vector3f::Constant(placed.radius);
        Eigen::AlignedBox3f& box = boxes.emplace_back();
        for (const Eigen::Vector3f& end : {placed.from, placed.to}) {
            box.extend(end - margin);
            box.extend(end + margin);
        }
    }
    return boxes;
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

ToolPainter::ToolPainter(const GlApi& gl)
    : gl_(gl),
      tool_(gl, "tool", shaders::kToolVertex, shaders::kToolFragment),
      ghost_(gl, "ghost", shaders::kToolVertex, shaders::kGhostFragment) {}

void ToolPainter::prepareSpin(bool is_needed) {
    spinning_tool_.reset();
    if (!is_needed) return;
    const std::string fragment = std::string("#define SPIN\n") + shaders::kToolFragment;
    spinning_tool_ = std::make_unique<Program>(gl_, "turning tool", shaders::kToolVertex, fragment);
}

void ToolPainter::drawTool(const Frame& frame, const FrameView& view, const ToolMesh& tool,
                           GLuint shadow_texture) const {
    if (!frame.X_CT) return;
    const bool spins = spinning_tool_ && view.effects->turn;
    const Program& program = spins ? *spinning_tool_ : tool_;
    program.use();
    frame.setLight(gl_, program, shadow_texture);
    program.set("camera_from_model", *frame.X_CT);
    program.set("burr_radius", float(view.burr_radius));
    program.set("milling_glow", glowOf(view.burr_work, view.burr_load));
    if (spins) {
        program.set("spin_angle", view.effects->turn->angle);
        program.set("spin_sweep", view.effects->turn->sweep);
        program.set("flutes", view.effects->turn->flutes);
    }
    gl_.Enable(GL_CULL_FACE);
    tool.draw(view.shows_handpiece);
    gl_.Disable(GL_CULL_FACE);
}

// Ghosts are seen through the bone too, but fainter there: the hand usually is inside when the tool is
// stopped at the surface.
void ToolPainter::drawGhosts(const Frame& frame, const ToolMesh& tool) const {
    if (frame.ghosts.empty()) return;
    gl_.Enable(GL_BLEND);
    gl_.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    gl_.Enable(GL_CULL_FACE);
    gl_.DepthMask(GL_FALSE);
    ghost_.use();
    ghost_.set("clip_from_camera", frame.clip_from_camera);
    constexpr struct {
        GLenum depth_test;
        float strength;
    } kPasses[] = {{GL_GREATER, 0.6f}, {GL_LEQUAL, 0.8f}};
    for (const Ghost& ghost : frame.ghosts) {
        ghost_.set("camera_from_model", ghost.X_CT);
        ghost_.set("tint", ghost.colour);
        for (const auto& pass : kPasses) {
            gl_.DepthFunc(pass.depth_test);
            ghost_.set("strength", pass.strength);
            tool.draw();
        }
    }
    gl_.DepthFunc(GL_LESS);
    gl_.DepthMask(GL_TRUE);
    gl_.Disable(GL_CULL_FACE);
    gl_.Disable(GL_BLEND);
}

}  // namespace bonemill
