// The screen of make-case's window: steps at the left, three slices and the bone at the right, below what was
// said. The steps are for people who read no manual: from top to bottom.
//
// It needs no OpenGL; ScreenPainter draws it. Positions are pixels from the picture's upper left corner. It
// belongs to the render thread.
#pragma once

#include <array>
#include <filesystem>
#include <optional>
#include <string>
#include <utility>

#include "render_client/case_window/case_desk/case_desk.h"
#include "render_client/case_window/case_desk/folder_view.h"
#include "render_client/hand/controls/window_event.h"
#include "render_client/look/camera/camera.h"
#include "render_client/panel/imgui/control_places.h"
#include "render_client/panel/imgui/imgui_stage.h"

struct ImVec2;
struct ImVec4;

namespace bonemill {

// A box over the screen in which a folder or file is looked for. It belongs to the render thread.
class BrowseBox {
  public:
    // Opens the box at the folder of this path, or at the working folder. With `takes_folders` a folder can
    // be chosen as a whole.
    void open(const std::string& title, const std::string& near, bool takes_folders);
    // It is called in every frame; returns what was chosen.
    std::optional<std::string> build(ControlPlaces& places, float scale);

  private:
    std::optional<std::string> buildEntries(ControlPlaces& places);

    std::string title_ = "Browse";
    bool takes_folders_ = true, is_asked_for_ = false;
    FolderView view_;
};

// Numbers under which the drawing names the pictures of the slices, by axis of W, and of the bone.
inline constexpr std::array<int, 3> kSlicePictures = {1, 2, 3};
inline constexpr int kBonePicture = 4;

class CaseScreen {
  public:
    // The desk must outlive it. Sets of tools are the scene texts in `tools_folder`. Throws UserError (font).
    CaseScreen(CaseDesk& desk, const std::filesystem::path& tools_folder);

    ImGuiStage& stage() { return stage_; }
    // Takes the size (pixels) of the picture to come, and how much larger than usual its text is. It is
    // called before the events of the picture.
    void setPicture(int width, int height, float scale);
    void handle(const WindowEvent& event);
    void openDropped(const std::string& path);
    // Brings the screen up to date with the desk; `seconds` have gone by since the picture before.
    void layOut(double seconds);

    // From now on a made case has a button to mill it, whose scene takeMilling() gives once it was pressed.
    void offerMilling() { offers_milling_ = true; }
    std::string takeMilling() { return std::exchange(milling_, {}); }

    // Returns where to click on the control with this label, if it can be seen.
    std::optional<PixelPoint> find(const std::string& label) const;
    const ImDrawData* drawData() const { return stage_.drawData(); }

    // What the pictures are to show; without a scan there are none.
    const std::array<ScanPane, 3>& panes() const { return panes_; }
    const OrbitCamera& camera() const { return camera_; }
    int boneWidth() const { return bone_width_; }
    int boneHeight() const { return bone_height_; }

  private:
    void frame(double seconds);
    void buildMessages(float height);
    // case_steps.cpp
    void buildSteps();
    void buildScan();
    void buildSeries();
    void buildBone();
    void buildIso();
    void buildWindow();
    void buildPieces();
    void buildPlace();
    void buildStructures();
    void buildStructure(size_t row);
    void buildCase();
    void buildTools();
    bool button(const char* label, bool is_enabled = true);
    bool choice(const char* label, bool is_chosen);
    bool isTyped(const char* label, const char* hint, std::string& text, float free_width);
    bool slider(const char* label, float& value, float low, float high, const char* format, int flags = 0);
    void say(const std::string& text);
    void say(const std::string& text, const ImVec4& colour);
    // slice_panes.cpp
    void buildPanes(const ImVec2& size);
    void buildSlice(size_t axis, const ImVec2& size);
    void moveOnSlice(size_t axis, const ImVec2& corner);
    void scrollSlice(size_t axis, const ImVec2& corner);
    void drawMarks(const ScanPane& pane, const ImVec2& corner) const;
    void drawSides(const ScanPane& pane, const ImVec2& corner) const;
    void buildBoneView(const ImVec2& size);
    void lookAtAll();
    void lookAtNew();
    void lookFrom(const Eigen::Vector3d& outwards_W);

    CaseDesk& desk_;
    std::vector<std::filesystem::path> tool_sets_;
    ImGuiStage stage_;
    ControlPlaces places_;
    int width_ = 1, height_ = 1;
    bool offers_milling_ = false;
    std::string milling_;  // the scene; empty: nothing is wanted
    std::string typed_path_, typed_labels_;
    BrowseBox browse_;
    bool browses_for_labels_ = false;
    std::array<ScanPane, 3> panes_;
    double zoom_ = 1;
    Eigen::Vector3d zoom_middle_W_ = Eigen::Vector3d::Zero();
    std::optional<Grip> grip_;  // while the button is down
    OrbitCamera camera_;
    int bone_width_ = 1, bone_height_ = 1;
    const RawVolume* seen_scan_ = nullptr;  // that zoom and camera were fitted to
    bool seen_bone_ = false;
    size_t lines_seen_ = 0;
};

}  // namespace bonemill
