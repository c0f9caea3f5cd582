// Segments as text, and what people write of them.
#pragma once

#include <string>

#include "haptic_server/core/volume/segments.h"

namespace bonemill {

// 1 to kLongestSegmentName bytes, none of them a control character.
bool isSegmentName(const std::string& name);

// Three lines of each segment: name, colour (or "-"), labels; before them one that says whether they are
// layered.
std::string textOfSegments(const Segments& segments);
// Takes nothing for granted: throws std::length_error for what textOfSegments() cannot have written.
Segments segmentsFromText(const std::string& text);

// The labels of the segments that are called so. Throws UserError, beginning with `file` and listing the
// names that are there.
std::vector<uint32_t> labelsOfSegment(const Segments& segments, const std::string& name,
                                      const std::string& file);

}  // namespace bonemill
