// How a picture of the window that is saved is called. It is for any thread; not RT-safe.
#pragma once

#include <ctime>
#include <filesystem>
#include <string>

namespace bonemill {

// Returns the first free name in this folder, by the time here and what the scene calls itself, so that names
// sort by time: bonemill_2026-11-28_121530_tooth_corridor.png. Signs of the scene's name that do not belong
// into a file's become "_"; a scene that is not known is left out.
std::filesystem::path pictureName(const std::filesystem::path& folder, const std::string& scene,
                                  std::time_t time);

}  // namespace bonemill
