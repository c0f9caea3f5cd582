#include "render_client/case_window/case_screen/screen_painter.h"

#include <imgui.h>

#include <algorithm>

#include "common/geometry/pose.h"
#include "proto/topics.pb.h"
#include "render_client/look/model/tool_mesh.h"
#include "render_client/look/shaders/shaders.h"

namespace bonemill {
namespace {

constexpr int kSamples = 4;
constexpr float kHiddenOpacity = 0.3f;
const Eigen::Vector3f kBoneTint(0.86f, 0.79f, 0.66f), kBoxTint(0.25f, 0.85f, 0.42f),
    kArrowTint(1.0f, 0.30f, 0.48f);

// Light comes from the camera's upper left, and a little from everywhere.
constexpr char kFragmentShader[] = R"(
in vec3 p_C;
in vec3 n_C;
uniform vec3 tint;
uniform float opacity;
out vec4 colour;
void main() {
    vec3 to_eye = normalize(-p_C);
    vec3 normal = normalize(n_C);
    float key = max(dot(normal, normalize(vec3(-0.45, 0.55, 0.70))), 0.0);
    float fill = max(dot(normal, normalize(vec3(0.80, -0.10, 0.50))), 0.0);
    float rim = pow(1.0 - max(dot(normal, to_eye), 0.0), 3.0);
    float light = 0.20 + 0.75 * key + 0.18 * fill + 0.12 * rim;
    colour = vec4(pow(tint * light, vec3(0.9)), opacity);
}
)";

// Adds a body of rotation from one place towards another; the stations' centres count along the way.
void addTurned(const std::vector<TubeStation>& stations, const Eigen::Vector3f& from,
               const Eigen::Vector3f& to, topics::TriangleMesh& mesh) {
    topics::TriangleMesh body;  // along y, as addTube() wants it
    addTube(stations, &body);
    const Eigen::Vector3d along = (to - from).cast<double>();
    const Eigen::Quaternionf turn = rotationBetween(Eigen::Vector3d::UnitY(), along).cast<float>();
    const auto first = uint32_t(mesh.vertices_m_size() / 3);
    for (int n = 0; n + 2 < body.vertices_m_size(); n += 3) {
        const Eigen::Vector3f at(body.vertices_m(n), body.vertices_m(n + 1), body.vertices_m(n + 2));
        const Eigen::Vector3f normal(body.normals(n), body.normals(n + 1), body.normals(n + 2));
        for (const float metres : Eigen::Vector3f(from + turn * at)) mesh.add_vertices_m(metres);
        for (const float part : Eigen::Vector3f(turn * normal)) mesh.add_normals(part);
    }
    for (const uint32_t index : body.indices()) mesh.add_indices(first + index);
}

topics::TriangleMesh edgesOf(const Eigen::AlignedBox3f& box) {
    topics::TriangleMesh mesh;
    const float length = box.sizes().x(), radius = 0.01f * length;
    const std::vector<TubeStation> rod = {{{0, -radius, 0}, 0},
                                          {{0, -radius, 0}, radius},
                                          {{0, length + radius, 0}, radius},
                                          {{0, length + radius, 0}, 0}};
    for (int corner = 0; corner < 8; ++corner)
        for (int axis = 0; axis < 3; ++axis)
            if (!(corner & (1 << axis)))
                addTurned(rod, box.corner(Eigen::AlignedBox3f::CornerType(corner)),
                          box.corner(Eigen::AlignedBox3f::CornerType(corner | (1 << axis))), mesh);
    return mesh;
}

topics::TriangleMesh arrowOf(const Eigen::Vector3f& tip, const Eigen::Vector3f& end) {
    topics::TriangleMesh mesh;
    const float length = (tip - end).norm(), radius = 0.03f * length, neck = 0.75f * length;
    addTurned({{{0, 0, 0}, 0},
               {{0, 0, 0}, radius},
               {{0, neck, 0}, radius},
               {{0, neck, 0}, 3 * radius},
               {{0, length, 0}, 0}},
              end, tip, mesh);
    return mesh;
}

SliceLook lookOf(const CaseDesk& desk) {
    SliceLook look;
    look.window = desk.window;
    look.iso = desk.iso();
    if (desk.isBoneOfNow()) look.bone = desk.bone();
    look.labels = desk.labels();
    for (size_t row = 0; row < desk.structures().size(); ++row)
        if (desk.structures()[row].use != StructureUse::kIgnored)
            for (const uint32_t label : desk.structures()[row].labels)
                look.label_tints[label] = structureTint(row);
    return look;
}

}  // namespace

BonePreview::BonePreview(const GlApi& gl)
    : gl_(gl),
      bone_program_(gl, "bone of the case", shaders::kMeshVertex, kFragmentShader),
      mark_program_(gl, "marks of the case", shaders::kToolVertex, kFragmentShader),
      bone_(gl),
      box_(gl),
      arrow_(gl),
      drawn_(gl),
      resolved_(gl),
      colour_(gl),
      depth_(gl),
      texture_(gl) {}

bool BonePreview::isSame(const Seen& now) const {
    return seen_.surface_version == now.surface_version && seen_.clip_from_W == now.clip_from_W &&
           seen_.width == now.width && seen_.height == now.height && seen_.marks == now.marks;
}

void BonePreview::paint(const CaseDesk& desk, const OrbitCamera& orbit, int width, int height) {
    if (!desk.scan() || width < 1 || height < 1) return;
    const Camera camera = orbit.view();
    const Eigen::AlignedBox3d box = desk.scanBox();
    const DepthRange range = camera.depthRange(box.center(), box.sizes().norm());
    const Eigen::Matrix4f X_CW = camera.X_CW(), clip = camera.clipFromCamera(double(width) / height, range);
    const Seen now{desk.surfaceVersion(), clip * X_CW, desk.marks(), width, height};
    if (isSame(now)) return;
    if (seen_.width != width || seen_.height != height) makeTargets(width, height);
    if (seen_.surface_version != now.surface_version) {
        bone_.clear();
        for (const NodeMesh& mesh : desk.surface()) bone_.set(mesh);
    }
    makeMarks(now.marks);
    seen_ = now;
    draw(desk, X_CW, clip, width, height);
}

void BonePreview::makeTargets(int width, int height) {
    GLint most = 0;
    gl_.GetIntegerv(GL_MAX_SAMPLES, &most);
    const GLint samples = std::min(most, kSamples);
    gl_.BindRenderbuffer(GL_RENDERBUFFER, colour_.name());
    gl_.RenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_RGBA8, width, height);
    gl_.BindRenderbuffer(GL_RENDERBUFFER, depth_.name());
    gl_.RenderbufferStorageMultisample(GL_RENDERBUFFER, samples, GL_DEPTH_COMPONENT24, width, height);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, drawn_.name());
    gl_.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_RENDERBUFFER, colour_.name());
    gl_.FramebufferRenderbuffer(GL_FRAMEBUFFER, GL_DEPTH_ATTACHMENT, GL_RENDERBUFFER, depth_.name());
    gl_.BindTexture(GL_TEXTURE_2D, texture_.name());
    gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, width, height, 0, GL_RGBA, GL_UNSIGNED_BYTE, nullptr);
    gl_.setSampling(GL_TEXTURE_2D, GL_LINEAR, GL_REPEAT);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, resolved_.name());
    gl_.FramebufferTexture2D(GL_FRAMEBUFFER, GL_COLOR_ATTACHMENT0, GL_TEXTURE_2D, texture_.name(), 0);
    if (gl_.CheckFramebufferStatus(GL_FRAMEBUFFER) != GL_FRAMEBUFFER_COMPLETE)
        throw GlError("the driver refuses the picture of the bone");
}

void BonePreview::makeMarks(const CaseMarks& marks) {
    box_.set(marks.region_W ? edgesOf(marks.region_W->cast<float>()) : topics::TriangleMesh(),
             topics::SceneInfo::NO_HANDPIECE);
    arrow_.set(marks.start_W && marks.hand_W
                   ? arrowOf(marks.start_W->cast<float>(), marks.hand_W->cast<float>())
                   : topics::TriangleMesh(),
               topics::SceneInfo::NO_HANDPIECE);
}

void BonePreview::setCamera(const Program& program, const Eigen::Matrix4f& camera_from_model,
                            const Eigen::Matrix4f& clip_from_camera) const {
    program.use();
    program.set("camera_from_model", camera_from_model);
    program.set("clip_from_camera", clip_from_camera);
}

void BonePreview::drawMarks(float opacity) const {
    mark_program_.set("opacity", opacity);
    mark_program_.set("tint", kBoxTint);
    if (!box_.isEmpty()) box_.draw();
    mark_program_.set("tint", kArrowTint);
    if (!arrow_.isEmpty()) arrow_.draw();
}

void BonePreview::draw(const CaseDesk& desk, const Eigen::Matrix4f& X_CW,
                       const Eigen::Matrix4f& clip_from_camera, int width, int height) {
    Eigen::Affine3f X_WV = Eigen::Affine3f::Identity();
    X_WV.linear() = desk.scan()->geometry.X_WV.rotation.toRotationMatrix().cast<float>();
    X_WV.translation() = desk.scan()->geometry.X_WV.position.cast<float>();
    gl_.BindFramebuffer(GL_FRAMEBUFFER, drawn_.name());
    gl_.Viewport(0, 0, width, height);
    gl_.Disable(GL_SCISSOR_TEST);
    gl_.Disable(GL_BLEND);
    gl_.Enable(GL_DEPTH_TEST);
    gl_.DepthFunc(GL_LESS);
    gl_.DepthMask(GL_TRUE);
    gl_.ClearColor(0.045f, 0.055f, 0.07f, 1);
    gl_.Clear(GL_COLOR_BUFFER_BIT | GL_DEPTH_BUFFER_BIT);
    const Eigen::Matrix4f camera_from_V = X_CW * X_WV.matrix();
    setCamera(bone_program_, camera_from_V, clip_from_camera);
    bone_program_.set("tint", kBoneTint);
    bone_program_.set("opacity", 1.f);
    bone_.draw(bone_program_, clip_from_camera * camera_from_V);
    setCamera(mark_program_, X_CW, clip_from_camera);
    gl_.DepthFunc(GL_GREATER);  // what lies behind bone shines through
    gl_.DepthMask(GL_FALSE);
    gl_.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_FALSE);
    gl_.Enable(GL_BLEND);
    gl_.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    drawMarks(kHiddenOpacity);
    gl_.Disable(GL_BLEND);
    gl_.ColorMask(GL_TRUE, GL_TRUE, GL_TRUE, GL_TRUE);
    gl_.DepthMask(GL_TRUE);
    gl_.DepthFunc(GL_LESS);
    drawMarks(1);
    gl_.Disable(GL_DEPTH_TEST);
    gl_.BindFramebuffer(GL_READ_FRAMEBUFFER, drawn_.name());
    gl_.BindFramebuffer(GL_DRAW_FRAMEBUFFER, resolved_.name());
    gl_.BlitFramebuffer(0, 0, width, height, 0, 0, width, height, GL_COLOR_BUFFER_BIT, GL_NEAREST);
    gl_.BindFramebuffer(GL_FRAMEBUFFER, 0);
    gl_.check("drawing the bone of the case");
}

ScreenPainter::ScreenPainter(const GlApi& gl)
    : gl_(gl), painter_(gl), bone_(gl), textures_{GlTexture(gl), GlTexture(gl), GlTexture(gl)} {}

void ScreenPainter::updateSlice(size_t axis, const CaseDesk& desk, const ScanPane& pane) {
    const SeenSlice now{desk.scan(), pane.plane(desk.scan()->geometry.X_WV), lookOf(desk)};
    if (seen_[axis].scan == now.scan && seen_[axis].plane == now.plane && seen_[axis].look == now.look)
        return;
    const RgbaImage image = drawSlice(*now.scan, now.plane, now.look);
    seen_[axis] = now;
    gl_.BindTexture(GL_TEXTURE_2D, textures_[axis].name());
    gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_RGBA8, image.width, image.height, 0, GL_RGBA, GL_UNSIGNED_BYTE,
                   image.rgba.data());
    gl_.setSampling(GL_TEXTURE_2D, GL_LINEAR);
}

void ScreenPainter::paint(const CaseScreen& screen, const ImGuiStage& stage, const CaseDesk& desk, int width,
                          int height) {
    gl_.ActiveTexture(GL_TEXTURE0);
    ImGuiTextures textures{{kBonePicture, bone_.texture()}};
    for (size_t axis = 0; axis < textures_.size(); ++axis) {
        if (desk.scan())
            updateSlice(axis, desk, screen.panes()[axis]);
        else
            seen_[axis] = {};  // another scan may come to lie at the same place of the memory
        textures[kSlicePictures[axis]] = textures_[axis].name();
    }
    bone_.paint(desk, screen.camera(), screen.boneWidth(), screen.boneHeight());
    gl_.BindFramebuffer(GL_FRAMEBUFFER, 0);
    gl_.Viewport(0, 0, width, height);
    gl_.ClearColor(0.03f, 0.04f, 0.05f, 1);
    gl_.Clear(GL_COLOR_BUFFER_BIT);
    if (screen.drawData()) painter_.paint(*screen.drawData(), stage.fontPixels(), textures, width, height);
}

}  // namespace bonemill
