// Shows the scan: three panes with slices, and grey values on the faces of cuts. It asks the store for the
// bricks that this takes, and for none where nothing of it is shown.
//
// It belongs to the thread of the context. The frames are W (world) and V (volume); the units are m.
#pragma once

#include <array>
#include <cstdint>
#include <memory>
#include <optional>
#include <vector>

#include "render_client/link/density_store/density_store.h"
#include "render_client/look/camera/view_settings.h"
#include "render_client/look/hud/hud_signs.h"
#include "render_client/look/model/material_palette.h"
#include "render_client/look/model/node_store.h"
#include "render_client/look/paint/scan_painters.h"
#include "render_client/look/slices/slice_image.h"
#include "render_client/look/slices/slice_plane.h"

namespace bonemill {

// Gives the vertices of nodes that were milled what the scan measured there, as its densities come.
//
// It belongs to the thread of the context. The frame is V; the units are m.
class MilledScan {
  public:
    // Samples the nodes that changed, or whose bricks did. The sampler reads that store, which has a grid.
    void update(const DensitySampler& sampler, const DensityStore& store, NodeStore& nodes);
    void clear() { bricks_.clear(); }

    // Returns the bricks around all milled nodes.
    const std::vector<uint32_t>& bricks() const { return bricks_; }

  private:
    std::vector<uint32_t> bricks_;
};

// One plane through the scan, and what of it was there when it was looked at last.
struct ShownSlice {
    SlicePlane plane;
    std::vector<uint32_t> bricks;
    SliceImage image;
    uint64_t changes = 0;
    bool is_known = false;
};

class CtShow {
  public:
    explicit CtShow(const GlApi& gl) : gl_(gl) {}

    DensityStore& store() { return store_; }

    // As paletteOf() of the scene.
    void setPalette(const std::vector<Eigen::Vector4f>& palette);

    struct View {
        const ViewSettings& settings;
        Pose X_WV;
        Eigen::AlignedBox3d bone_W;  // empty: nothing is known
        std::optional<SliceBurr> burr;
        int width, height;  // of the whole picture, pixels
    };
    // Brings panes, faces and milled nodes up to date, and wants what they show. Returns the box (V) in which
    // faces look different now. Throws GlError when the driver refuses a shader or a texture.
    Eigen::AlignedBox3f update(const View& view, NodeStore& nodes);

    // Returns what the faces of cuts show; null where they are plain.
    const CtFaces* faces() const { return shows_faces_ ? faces_.get() : nullptr; }

    // Returns what makes grey of the scan's densities on milled bone; nothing where it has its own colour.
    std::optional<Eigen::Vector2f> milledGrey() const { return milled_grey_; }

    // Draws the panes of the last update() into their columns of the picture (`target`), if there are any.
    void paintPanes(GLuint target) const;
    // Returns what is written on them: sides of the patient, or W's axes.
    std::vector<HudPane> texts(bool are_patients_axes) const;

    bool hasPanes() const { return panes_.has_value(); }
    // Returns what the panes of the last update() show; nothing without a scan.
    std::optional<SeenPanes> seenPanes() const;

  private:
    // Returns true when the image is another one now.
    static bool isLoading(const std::optional<ShownSlice>& slice);
    bool look(ShownSlice& slice, const SlicePlane& plane, const BoneColours* colours = nullptr);
    void updatePanes(const View& view);
    Eigen::AlignedBox3f updateFaces(const View& view);
    void updateMilled(const View& view, NodeStore& nodes);
    void showNoGrid(const View& view);
    void wantAll();
    const DensitySampler& sampler();

    const GlApi& gl_;
    DensityStore store_;
    std::optional<DensityGrid> grid_;        // of the last update
    std::optional<DensitySampler> sampler_;  // of this update
    BoneColours bone_colours_ = boneColoursOf({});
    std::unique_ptr<SlicePainter> painter_;
    std::unique_ptr<CtFaces> faces_;
    bool shows_faces_ = false;
    MilledScan milled_;
    std::optional<Eigen::Vector2f> milled_grey_;
    std::optional<std::array<Pane, 3>> panes_;
    std::array<bool, 3> are_scrolled_{};
    std::array<std::optional<ShownSlice>, 3> pane_slices_, face_slices_;
    std::array<std::optional<GreyWindow>, 3> painted_;  // the window that each pane's pixels have
    std::optional<GreyWindow> window_;
    int columns_ = 0, width_ = 0, height_ = 0;
};

}  // namespace bonemill
