#include "common/picture/picture.h"

#include <png.h>

#include "common/base/user_error.h"
#include "common/files/whole_file.h"

namespace bonemill {
namespace {

png_image headerOf(const Picture& picture) {
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    header.width = png_uint_32(picture.width());
    header.height = png_uint_32(picture.height());
    header.format = PNG_FORMAT_RGB;
    return header;
}

}  // namespace

std::string pngOf(const Picture& picture) {
    png_image header = headerOf(picture);
    png_alloc_size_t bytes = PNG_IMAGE_PNG_SIZE_MAX(header);
    std::string png(bytes, '\0');
    if (!png_image_write_to_memory(&header, png.data(), &bytes, 0, picture.row(0), 0, nullptr)) return {};
    png.resize(bytes);
    return png;
}

void writePng(const Picture& picture, const std::filesystem::path& path) {
    png_image header = headerOf(picture);
    WholeFile file(path);
    if (!png_image_write_to_file(&header, file.part().c_str(), 0, picture.row(0), 0, nullptr))
        throw UserError("cannot write " + path.string() + ": " + header.message);
    file.finish();
}

std::optional<RgbaPixels> pixelsOfPng(std::string_view png, uint32_t max_side) {
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    if (png.empty() || !png_image_begin_read_from_memory(&header, png.data(), png.size()))
        return std::nullopt;
    header.format = PNG_FORMAT_RGBA;
    std::optional<RgbaPixels> pixels;
    if (header.width <= max_side && header.height <= max_side) {
        pixels = {int(header.width), int(header.height), std::vector<uint8_t>(PNG_IMAGE_SIZE(header))};
        if (!png_image_finish_read(&header, nullptr, pixels->rgba.data(), 0, nullptr)) pixels.reset();
    }
    png_image_free(&header);
    return pixels;
}

}  // namespace bonemill
