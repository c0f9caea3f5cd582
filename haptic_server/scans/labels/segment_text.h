// Segments as text, what people write of them, and numbers for the combinations of them that voxels are of.
#pragma once

#include <bitset>
#include <cstdint>
#include <string>
#include <unordered_map>

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

using SegmentMembers = std::bitset<kMaxSegments>;  // numbers in Segments::list

// With them a label map stays one number per voxel.
class SegmentCodes {
  public:
    // `file` is for messages.
    explicit SegmentCodes(std::string file);

    // 0 is that of no segment; others are counted from 1 as they come. Throws UserError beyond what a few
    // structures can have.
    uint16_t codeOf(const SegmentMembers& members);
    bool anyOverlap() const;
    // Gives the segments their codes as labels. Throws UserError as above.
    void listIn(Segments& segments) const;

  private:
    [[noreturn]] void refuse() const;

    std::string file_;
    std::unordered_map<SegmentMembers, uint16_t> codes_;
};

}  // namespace bonemill
