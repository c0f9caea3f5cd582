// Writes the scene of a case from its plan.
#pragma once

#include <string>
#include <vector>

#include "haptic_server/cases/casework/case_plan.h"
#include "proto/scene.pb.h"

namespace bonemill {

// `tools` may be empty; `scan_file` and `label_file` (empty: none) stand as they are.
scene::Scene sceneOfCase(const CasePlan& plan, const CaseRequest& request,
                         const std::vector<CaseLabel>& labels, const std::vector<scene::Tool>& tools,
                         const std::string& name);

// The text that loadScene() reads.
std::string textOfScene(const scene::Scene& scene);

inline constexpr char kScanOfCase[] = "scan.nrrd", kLabelsOfCase[] = "labels.nrrd";

}  // namespace bonemill
