#include "render_client/look/hud/utf8.h"

namespace bonemill {

std::vector<uint32_t> decodeUtf8(std::string_view text) {
    constexpr uint32_t kReplacement = 0xfffd;
    std::vector<uint32_t> code_points;
    for (size_t i = 0; i < text.size();) {
        const auto lead = uint8_t(text[i]);
        const size_t length = lead < 0x80         ? 1
                              : lead >> 5 == 0x6  ? 2
                              : lead >> 4 == 0xe  ? 3
                              : lead >> 3 == 0x1e ? 4
                                                  : 0;
        uint32_t code_point = length <= 1 ? lead : lead & (0x7fu >> length);
        bool valid = length > 0 && i + length <= text.size();
        for (size_t k = 1; valid && k < length; ++k) {
            const auto byte = uint8_t(text[i + k]);
            valid = byte >> 6 == 0x2;
            code_point = code_point << 6 | (byte & 0x3fu);
        }
        code_points.push_back(valid ? code_point : kReplacement);
        i += valid ? length : 1;
    }
    return code_points;
}

}  // namespace bonemill
