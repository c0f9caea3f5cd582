// Which of the stacks in a folder shows bone best.
#pragma once

#include <string>
#include <vector>

#include "haptic_server/scans/dicom/dicom_stack.h"

namespace bonemill {

// Is it the name of a sharp reconstruction kernel, as makers give for bone? bone_series.cpp has the table.
bool isBoneKernel(const std::string& kernel);

struct BoneRecommendation {
    const DicomStack* stack = nullptr;  // nothing: none can be used
    std::string why;                    // for people
};

// Scouts and what cannot be used are left out. CT goes before all else, bone kernels before others unless
// their slices are more than twice as far apart as the thinnest, then the thinnest slices, then the most,
// then originals.
BoneRecommendation recommendForBone(const std::vector<DicomStack>& stacks);

}  // namespace bonemill
