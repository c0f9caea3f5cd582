#include "render_client/panel/panel/scene_pictures.h"

#include <set>
#include <utility>

namespace bonemill {
namespace {

constexpr uint32_t kMaxSide = 512;  // pixels

ScenePicture decoded(const std::string& png) {
    ScenePicture picture{.png = png, .pixels = {}};
    if (auto pixels = pixelsOfPng(png, kMaxSide)) picture.pixels = std::move(*pixels);
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
        if (picture.pixels.width > 0) picture.number = ++last_number_;
    }
    std::erase_if(pictures_, [&](const auto& entry) { return !known.contains(entry.first); });
}

}  // namespace bonemill
