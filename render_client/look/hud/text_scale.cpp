#include "render_client/look/hud/text_scale.h"

#include <algorithm>

namespace bonemill {

float textScale(int width, int height, double chosen, float desktop_scale) {
    constexpr float kUsualWidth = 1280, kUsualHeight = 800, kSmallestText = 0.7f;
    const float fitting = std::min(float(width) / kUsualWidth, float(height) / kUsualHeight);
    return std::max(fitting, kSmallestText * desktop_scale) * float(chosen);
}

}  // namespace bonemill
