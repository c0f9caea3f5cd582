#include "render_client/look/offscreen/picture.h"

#include <png.h>

#include "common/base/user_error.h"
#include "common/files/whole_file.h"

namespace bonemill {

void writePng(const Picture& picture, const std::filesystem::path& path) {
    png_image header{};
    header.version = PNG_IMAGE_VERSION;
    header.width = png_uint_32(picture.width());
    header.height = png_uint_32(picture.height());
    header.format = PNG_FORMAT_RGB;
    WholeFile file(path);
    if (!png_image_write_to_file(&header, file.part().c_str(), 0, picture.row(0), 0, nullptr))
        throw UserError("cannot write " + path.string() + ": " + header.message);
    file.finish();
}

}  // namespace bonemill
