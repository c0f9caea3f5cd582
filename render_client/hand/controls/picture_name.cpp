#include "render_client/hand/controls/picture_name.h"

#include <algorithm>
#include <array>
#include <cctype>

namespace bonemill {
namespace {

constexpr size_t kLongestScene = 64;  // signs of the scene's name

std::string fileWords(const std::string& scene) {
    std::string words = scene.substr(0, kLongestScene);
    std::ranges::replace_if(
        words, [](unsigned char sign) { return !std::isalnum(sign) && sign != '-'; }, '_');
    return words;
}

}  // namespace

std::filesystem::path pictureName(const std::filesystem::path& folder, const std::string& scene,
                                  std::time_t time) {
    std::tm local{};
    localtime_r(&time, &local);
    std::array<char, 32> stamp{};
    std::strftime(stamp.data(), stamp.size(), "%Y-%m-%d_%H%M%S", &local);
    const std::string stem =
        std::string("bonemill_") + stamp.data() + (scene.empty() ? "" : "_" + fileWords(scene));
    std::filesystem::path name = folder / (stem + ".png");
    std::error_code none;
    for (int n = 2; std::filesystem::exists(name, none); ++n)
        name = folder / (stem + "_" + std::to_string(n) + ".png");
    return name;
}

}  // namespace bonemill
