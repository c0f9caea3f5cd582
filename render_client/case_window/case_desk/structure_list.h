// The structures of a label map, and what each is to be in the case. Any thread may call the functions.
#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include "haptic_server/core/volume/raw_volume.h"

namespace bonemill {

enum class StructureUse : uint8_t { kIgnored, kShown, kProtected, kTarget };

struct StructureRow {
    std::optional<uint32_t> number;  // none: the file names it, and its name is fixed
    std::string name;
    std::vector<uint32_t> labels;  // of its voxels
    StructureUse use = StructureUse::kIgnored;
};

inline constexpr size_t kMaxStructureRows = 256;

// The segments that the file names, or the numbers but 0 that its voxels have. Throws UserError where the
// file is no label map: numbers that are no integers, or too many of them.
std::vector<StructureRow> structuresOf(const RawVolume& map);

// Gives rows the use that the words of --label say; those that fit no row are left out.
void takeWords(const std::vector<std::string>& words, std::vector<StructureRow>& rows);

// As --label takes them; what is ignored, and what has no name, is left out.
std::vector<std::string> labelWordsOf(const std::vector<StructureRow>& rows);

// How people tell the structure of this row from others: red, green, blue.
std::array<uint8_t, 3> structureTint(size_t row);

}  // namespace bonemill
