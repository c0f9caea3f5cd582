// The message for a field of the scene that cannot be followed.
#pragma once

#include <string>

#include "common/base/user_error.h"
#include "common/config/scene_file.h"

namespace bonemill {

// Throws UserError: where the field stands, its name, why.
[[noreturn]] inline void refuseField(const LoadedScene& loaded, const std::string& path,
                                     const std::string& why) {
    throw UserError(placeOf(loaded.file.string(), loaded.lines, path) + "field `" + path + "`" + why);
}

}  // namespace bonemill
