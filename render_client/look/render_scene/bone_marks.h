// What is marked in the bone and on it. It is for one thread.
#pragma once

#include <array>
#include <cstdint>
#include <functional>
#include <map>
#include <optional>
#include <string>
#include <vector>

#include "proto/topics.pb.h"
#include "render_client/look/camera/view_settings.h"
#include "render_client/look/hud/hud.h"
#include "render_client/look/paint/frame.h"
#include "render_client/look/structures/structure_set.h"

namespace bonemill {

// Decides how the protected structures of a scene are seen: colours, what is near the burr, what lies at a
// place of the picture.
class StructureView {
  public:
    // Colours, names and the burr are those of this scene.
    void setInfo(const topics::SceneInfo& info);
    // Replaces the structure that the mesh's leaf names; the distance is in m.
    void set(const NodeMesh& mesh, double warning_distance) { structures_.set(mesh, warning_distance); }
    void clear() { structures_.clear(); }

    const StructureSet& structures() const { return structures_; }

    // Fills in what the view shows of structures; the tool's pose must be in it.
    void show(const ViewSettings& settings, FrameView& view) const;

    // Returns the name of the structure that is seen first along a ray (W), or nothing. What lies farther
    // away than `bone_at` (m) is behind bone.
    std::string nameAlong(const Eigen::Vector3d& from_W, const Eigen::Vector3d& direction_W, double bone_at,
                          const FrameView& view) const;

    // Says what the colours of thickness mean.
    HudLegend legend() const;

  private:
    StructureSet structures_;
    topics::SceneInfo info_;  // materials and burr only
    std::vector<BurrBall> burr_;
};

// Returns how far the burr hangs in front of the bone along the line of sight (m, from its surface). `view`
// is that of the last picture, of this size, and `pick` gives what is seen at a pixel of it. Nothing where
// there is no bone around the burr, or the burr is as near as its surroundings.
std::optional<double> burrGap(const FrameView& view, const Eigen::Vector2i& size,
                              const std::function<std::optional<Eigen::Vector3d>(int, int)>& pick);

// Where that is behind the tool of this view, which may have moved on since.
BurrGap behindBurr(const FrameView& view, double distance);

// What people wrote and drew, as the picture shows it: strokes, a dot where a note belongs, and the note's
// first words beside it.
class RemarkView {
  public:
    static constexpr size_t kMaxLabels = 16;  // of the newest notes

    // Takes all that there are, by place.
    void set(const std::map<uint32_t, topics::Remark>& remarks);

    struct Label {
        Eigen::Vector3d p_W;
        std::string text;
    };
    const std::vector<Stroke>& strokes() const { return strokes_; }
    const std::vector<Label>& labels() const { return labels_; }

  private:
    std::vector<Stroke> strokes_;
    std::vector<Label> labels_;
};

// Returns the linear colour of a stroke, of 0xRRGGBB.
Eigen::Vector3f strokeColour(uint32_t colour);

}  // namespace bonemill
