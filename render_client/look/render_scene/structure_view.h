// Decides how the protected structures of a scene are seen: colours, what is near the burr, what lies at a
// place of the picture. It is for one thread.
#pragma once

#include <array>
#include <string>

#include "proto/topics.pb.h"
#include "render_client/look/camera/view_settings.h"
#include "render_client/look/hud/hud.h"
#include "render_client/look/paint/frame.h"
#include "render_client/look/structures/structure_set.h"

namespace bonemill {

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

}  // namespace bonemill
