#include "device_daemon/ares/kinematics/pose_search.h"

#include "device_daemon/ares/kinematics/singularity.h"

namespace bonemill {

Location locate(const AresKinematics& kinematics, const Vector6d& q, const Pose& X_DT_start) noexcept {
    Location location;
    const ForwardSolution solution = kinematics.forward(q, X_DT_start);
    location.X_DT = solution.X_DT;
    location.is_found = solution.converged && kinematics.inverseJacobian(solution.X_DT, location.J_inv);
    if (!location.is_found) return location;
    location.singularity_index = singularityIndex(location.J_inv);
    location.faults = kinematics.workspaceFaults(location.X_DT, kWorkspaceSlack);
    if (!(location.singularity_index >= kMinSingularityIndex)) location.faults |= kWorkspaceSingular;
    if (!kinematics.isOwnAssembly(location.J_inv)) location.faults |= kWorkspaceMirrored;
    return location;
}

}  // namespace bonemill
