// What goes through the pipe from the process that looks into an archive to the one that writes its files:
// for each file its name, then its bytes in parts; at last the end.
#pragma once

#include "haptic_server/scans/confined/guarded_process.h"

namespace bonemill {

inline constexpr uint8_t kFileWords = kErrorWords + 1, kBytesWords = kFileWords + 1,
                         kEndWords = kBytesWords + 1;

}  // namespace bonemill
