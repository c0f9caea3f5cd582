// Draws the screen of make-case's window in any OpenGL 3.3 core context.
//
// It belongs to the thread of the context, which must be current for every call.
#pragma once

#include <array>
#include <optional>

#include "render_client/case_window/case_desk/case_desk.h"
#include "render_client/case_window/case_desk/scan_slice.h"
#include "render_client/case_window/case_screen/case_screen.h"
#include "render_client/look/camera/camera.h"
#include "render_client/look/model/node_store.h"
#include "render_client/look/model/tool_mesh.h"
#include "render_client/panel/imgui/imgui_stage.h"

namespace bonemill {

// Draws the bone, the box of what is milled and the hand's arrow into a texture.
class BonePreview {
  public:
    // Throws GlError.
    explicit BonePreview(const GlApi& gl);

    // Draws a picture of this size (pixels), if something of it has changed. Leaves framebuffer 0 bound.
    // Throws GlError.
    void paint(const CaseDesk& desk, const OrbitCamera& camera, int width, int height);
    GLuint texture() const { return texture_.name(); }

  private:
    struct Seen {  // in the texture
        int surface_version = -1;
        Eigen::Matrix4f clip_from_W;
        CaseMarks marks;
        int width = 0, height = 0;
    };
    bool isSame(const Seen& now) const;
    void makeTargets(int width, int height);
    void makeMarks(const CaseMarks& marks);
    void draw(const CaseDesk& desk, const Eigen::Matrix4f& X_CW, const Eigen::Matrix4f& clip_from_camera,
              int width, int height);
    void drawMarks(float opacity) const;
    void setCamera(const Program& program, const Eigen::Matrix4f& camera_from_model,
                   const Eigen::Matrix4f& clip_from_camera) const;

    const GlApi& gl_;
    Program bone_program_, mark_program_;
    NodeStore bone_;
    ToolMesh box_, arrow_;
    GlFramebuffer drawn_, resolved_;
    GlRenderbuffer colour_, depth_;
    GlTexture texture_;
    Seen seen_;
};

class ScreenPainter {
  public:
    // Throws GlError.
    explicit ScreenPainter(const GlApi& gl);

    // Draws into framebuffer 0 of this size (pixels). Only what has changed is computed anew.
    void paint(const CaseScreen& screen, const ImGuiStage& stage, const CaseDesk& desk, int width,
               int height);

  private:
    struct SeenSlice {  // in the texture
        const RawVolume* scan = nullptr;
        SlicePlane plane;
        SliceLook look;
    };
    void updateSlice(size_t axis, const CaseDesk& desk, const ScanPane& pane);

    const GlApi& gl_;
    ImGuiPainter painter_;
    BonePreview bone_;
    std::array<GlTexture, 3> textures_;
    std::array<SeenSlice, 3> seen_;
};

}  // namespace bonemill
