#include "render_client/offscreen/picture.h"

#include <png.h>

#include <system_error>

#include "common/user_error.h"

namespace bonemill {

void writePng(const Picture& picture, const std::filesystem::path& path) {
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    header.width = png_uint_32(picture.width());
    header.height = png_uint_32(picture.height());
    header.format = PNG_FORMAT_RGB;
    std::filesystem::path unfinished = path;
    unfinished += ".part";
    if (!png_image_write_to_file(&header, unfinished.c_str(), 0, picture.row(0), 0, nullptr)) {
        std::error_code ignored;
        std::filesystem::remove(unfinished, ignored);
        throw UserError("cannot write " + path.string() + ": " + header.message);
    }
    std::error_code failure;
    std::filesystem::rename(unfinished, path, failure);
    if (failure) throw UserError("cannot write " + path.string() + ": " + failure.message());
}

}  // namespace bonemill
