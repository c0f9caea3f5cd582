// What the labels of a scan say: materials, by label or by raw value; segments as text, and what people write
// of them; numbers for the combinations of segments that voxels are of. It is not RT-safe (it allocates) and
// has no shared state.
#pragma once

#include <bitset>
#include <cstdint>
#include <optional>
#include <span>
#include <string>
#include <unordered_map>
#include <vector>

#include "haptic_server/core/volume/material_properties.h"
#include "haptic_server/core/volume/raw_volume.h"
#include "haptic_server/core/volume/segments.h"

namespace bonemill {

// A voxel is of the material if its raw value lies in the range or its label is one of these.
struct MaterialRule {
    bool has_range = false;
    std::optional<double> from = {}, below = {};  // raw values: included, not included; absent: no end
    std::vector<uint32_t> labels = {};            // 0 .. kMaxLabel
};
inline constexpr uint32_t kMaxLabel = 65535;

// There is one of each voxel, x fastest; of several rules that fit the last one wins. Values that are not
// finite fit no range. `of_labels` are those that voxels have by their labels (voxel_materials.h), or none.
std::vector<MaterialId> materialIds(const RawVolume& raw, std::span<const MaterialRule> rules,
                                    std::vector<MaterialId> of_labels = {});

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
