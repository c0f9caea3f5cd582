// A volume's reader as a program of its own: haptic_server starts itself once more for it.
//
// A child that is forked while other threads run may only call what is safe in a signal handler: a lock that
// another thread held stays locked in it for ever. A process that is spawned begins anew, and the kernel
// copies no page table of locked memory for it, which the tick would feel.
#pragma once

#include "haptic_server/volume/import/import_volume.h"

namespace bonemill {

// The word behind the program's name, and before the path and the options (import_options_text.h).
inline constexpr char kReadVolumeWord[] = "read-volume";

// From now on importVolume() starts this program as a reader: `haptic_server`'s main says it first of all.
void setReaderProgram(const std::string& program);
bool hasReaderProgram();

// Does what importVolume() does. Throws UserError.
RawVolume importByProgram(const std::filesystem::path& path, const ImportOptions& options);

// The reader's own end: hands the volume to the process that has started it, and ends.
[[noreturn]] void runReaderProgram(const std::filesystem::path& path, const ImportOptions& options);

}  // namespace bonemill
