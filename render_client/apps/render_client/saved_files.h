// What the user of a window saves for itself: pictures and the attempts of a lesson. It belongs to the thread
// of the OpenGL context.
#pragma once

#include <filesystem>
#include <optional>
#include <string>

#include "proto/topics.pb.h"
#include "render_client/look/gl/gl_api.h"
#include "render_client/look/hud/hud.h"

namespace bonemill {

// Returns the first free name in the current folder. `format` has one %d.
std::filesystem::path nextName(const char* format);

// These say where the file is, or why there is none.
//
// The picture is what the bound framebuffer of this size (pixels) shows. It goes into the folder `pictures`
// of the class, where there is one, and else into the current folder.
HudNotice savePicture(const GlApi& gl, int width, int height, const std::string& class_folder,
                      const std::string& scene);
HudNotice saveAttempts(const topics::Lesson& lesson);
// Speaks this language from now on, and remembers it; no code changes nothing. Returns why it is not
// remembered.
std::optional<HudNotice> changeLanguage(const std::string& code);

}  // namespace bonemill
