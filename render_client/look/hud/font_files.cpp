#include "render_client/look/hud/font_files.h"

#include <filesystem>

#include "common/base/user_error.h"

namespace bonemill {

std::string fontFile(FontStyle style) {
    const std::string path = std::string(BONEMILL_FONT_DIR) +
                             (style == FontStyle::kPlain ? "/DejaVuSans.ttf" : "/DejaVuSans-Bold.ttf");
    if (!std::filesystem::exists(path))
        throw UserError("cannot read the font " + path + ": install the package fonts-dejavu-core");
    return path;
}

}  // namespace bonemill
