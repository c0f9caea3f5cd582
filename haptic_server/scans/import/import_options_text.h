// Options of an import as one word, for the program that reads (import_program.h).
#pragma once

#include <string>

#include "haptic_server/scans/import/import_volume.h"

namespace bonemill {

std::string textOfOptions(const ImportOptions& options);
// Throws nlohmann::json::exception for what textOfOptions() has not written.
ImportOptions optionsFromText(const std::string& text);

}  // namespace bonemill
