// Tells the acquisitions, phases and reconstructions of one series apart that show the same places.
#pragma once

#include <optional>
#include <vector>

#include "haptic_server/scans/dicom/dicom_stack.h"

namespace bonemill {

// The slices of one series, of the same orientation, size and pixel spacing, as one stack, or as those that
// they are of. Where pictures at one place differ, one of their traits (dicom_slice.h) or two tell them
// apart, the first that leave proper stacks only, else those that leave most slices in proper ones; where
// nothing does, there is one stack with a problem. Stacks that overlap without a common place are told apart,
// too, where one volume never mixes them (kernels, phases, b-values), or where they are even and what they
// make together is not. Stacks have names (none, where slices of one stack have several numbers of
// acquisition), the lowest first.
std::vector<DicomStack> partsOf(const std::vector<DicomSlice>& slices,
                                const std::vector<DicomSlice>& strangers,
                                const IsSamePicture& is_same_picture);

// The number of the acquisition that all slices are of; nothing: of several, or of none.
std::optional<double> acquisitionOf(const DicomStack& stack);

}  // namespace bonemill
