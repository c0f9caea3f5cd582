// Lets an effect scale the energy of single contact points: softer where a burr cuts, harder in enamel.
#pragma once

#include "haptic_server/core/contact/candidates.h"
#include "haptic_server/core/tool/tool_field.h"

namespace bonemill {

class ContactWeights {
  public:
    virtual ~ContactWeights() = default;
    // Multiplies weights of the candidates just gathered, before the far-side guard and the stiffness cap see
    // them. `origin` is that of the candidates' positions, X_VT the tool's pose at the gathering. Returns the
    // largest factor. It is called once or more often in a tick, for each gathering anew. It is RT-safe, for
    // the tick thread only.
    virtual double scale(Candidates& candidates, const Eigen::Vector3d& origin_V, const ToolField& tool,
                         const Pose& X_VT) noexcept = 0;
};

}  // namespace bonemill
