#include "render_client/panel/panel/scene_pictures.h"

#include <png.h>

#include <set>

namespace bonemill {
namespace {

constexpr png_uint_32 kMostPixels = 512;  // per side

ScenePicture decoded(const std::string& png) {
    ScenePicture picture{.png = png, .rgba = {}};
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    if (png.empty() || !png_image_begin_read_from_memory(&header, png.data(), png.size())) return picture;
    header.format = PNG_FORMAT_RGBA;
    if (header.width <= kMostPixels && header.height <= kMostPixels) {
        picture.rgba.resize(PNG_IMAGE_SIZE(header));
        if (png_image_finish_read(&header, nullptr, picture.rgba.data(), 0, nullptr)) {
            picture.width = int(header.width);
            picture.height = int(header.height);
        }
    }
    png_image_free(&header);
    return picture;
}

}  // namespace

void ScenePictures::follow(const topics::Lesson& lesson) {
    std::set<std::string> known;
    for (const topics::SceneChoice& scene : lesson.scenes()) {
        if (!known.insert(scene.id()).second) continue;  // two of one name would take turns
        ScenePicture& picture = pictures_[scene.id()];
        if (picture.png == scene.picture()) continue;
        picture = decoded(scene.picture());
        if (picture.width > 0) picture.number = ++last_number_;
    }
    std::erase_if(pictures_, [&](const auto& entry) { return !known.contains(entry.first); });
}

}  // namespace bonemill
