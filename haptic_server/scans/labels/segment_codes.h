// Numbers for the combinations of segments that voxels are of, so that a label map stays one number per
// voxel.
#pragma once

#include <bitset>
#include <cstdint>
#include <string>
#include <unordered_map>

#include "haptic_server/core/volume/segments.h"

namespace bonemill {

using SegmentMembers = std::bitset<kMaxSegments>;  // numbers in Segments::list

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
