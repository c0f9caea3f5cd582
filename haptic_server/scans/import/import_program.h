// A volume's reader as a program of its own: haptic_server starts itself once more for it.
//
// A child that is forked while other threads run may only call what is safe in a signal handler: a lock that
// another thread held stays locked in it for ever. A process that is spawned begins anew, and the kernel
// copies no page table of locked memory for it, which the tick would feel.
#pragma once

#include <string>
#include <vector>

#include "haptic_server/scans/import/import_volume.h"

namespace bonemill {

// These words stand behind the program's name, and before the path.
inline constexpr char kReadVolumeWord[] = "read-volume";  // then the options (import_options_text.h)
inline constexpr char kReadSeriesWord[] = "read-series";

// Runs the reader's own end if the words of the command line call it, and does not return then.
void runReaderIfCalled(int argc, char** argv);

// From now on importVolume() and listSeries() start this program as a reader: `haptic_server`'s main says it
// first of all.
void setReaderProgram(const std::string& program);
bool hasReaderProgram();

// Do what importVolume() and listSeries() do. Throw UserError.
RawVolume importByProgram(const std::filesystem::path& path, const ImportOptions& options);
std::vector<std::string> listByProgram(const std::filesystem::path& path);

}  // namespace bonemill
