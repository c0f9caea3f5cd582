#include "render_client/start_window/start_screen/card_pictures.h"

#include <fstream>
#include <iterator>
#include <utility>

namespace bonemill {
namespace {

constexpr uint32_t kMostPixels = 2048;  // of a side

}  // namespace

const CardPicture& CardPictures::of(const std::string& file) {
    const auto [entry, is_new] = pictures_.try_emplace(file);
    CardPicture& picture = entry->second;
    if (!is_new || file.empty()) return picture;
    std::ifstream stream(file, std::ios::binary);
    const std::string bytes(std::istreambuf_iterator<char>(stream), {});
    if (auto pixels = pixelsOfPng(bytes, kMostPixels)) picture = {++last_number_, std::move(*pixels)};
    return picture;
}

}  // namespace bonemill
