// What a folder of DICOM files holds, for people.
#pragma once

#include <string>
#include <vector>

#include "haptic_server/scans/dicom/dicom_stack.h"

namespace bonemill {

struct SeriesTableNotes {
    std::string left_out;               // files that belong to no stack; empty: none
    std::vector<std::string> problems;  // of files that cannot be read
};

// Lines of printable text: a head, one line of each stack, which is the best for bone and how to choose it,
// and the notes. What a stack's name says is what DicomWish takes.
std::vector<std::string> seriesTable(const std::vector<DicomStack>& stacks, const SeriesTableNotes& notes);

}  // namespace bonemill
