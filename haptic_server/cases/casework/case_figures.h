// Figures of a case, for gnuplot: the scan's values with the iso-value, and the pieces of bone from three
// sides. Nothing in them comes from the scan's file but values and geometry.
#pragma once

#include <filesystem>
#include <string>
#include <string_view>

#include "haptic_server/cases/casework/case_plan.h"

namespace bonemill {

// Makes the folder, and in it what `gnuplot histogram.gp` and `gnuplot pieces.gp` make histogram.png and
// pieces.png of, when they run there. Start-up only. Throws UserError.
void writeFigures(const std::filesystem::path& folder, const RawVolume& scan, const CasePlan& plan);

// Writes a file as a whole. Throws UserError.
void writeWhole(const std::filesystem::path& file, std::string_view bytes);

// A whole gnuplot script that writes histogram.png where it runs. Start-up only: it goes through all values.
std::string histogramScript(const RawVolume& scan, const CasePlan& plan);

}  // namespace bonemill
