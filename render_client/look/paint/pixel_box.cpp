#include "render_client/look/paint/pixel_box.h"

#include <algorithm>
#include <cmath>

namespace bonemill {

PixelBox PixelBox::joined(const PixelBox& other) const {
    if (isEmpty()) return other;
    if (other.isEmpty()) return *this;
    return {std::min(x0, other.x0), std::min(y0, other.y0), std::max(x1, other.x1), std::max(y1, other.y1)};
}

PixelBox PixelBox::within(const PixelBox& other) const {
    return {std::max(x0, other.x0), std::max(y0, other.y0), std::min(x1, other.x1), std::min(y1, other.y1)};
}

PixelBox PixelBox::around(const Eigen::AlignedBox3f& box, const Eigen::Matrix4f& clip_from_model, int width,
                          int height) {
    if (box.isEmpty()) return {};
    Eigen::AlignedBox2f ndc;
    for (int i = 0; i < 8; ++i) {
        const Eigen::Vector4f corner =
            clip_from_model * box.corner(static_cast<Eigen::AlignedBox3f::CornerType>(i)).homogeneous();
        if (!(corner.w() > 0) || !(corner.z() >= -corner.w()) || !corner.allFinite())
            return whole(width, height);
        ndc.extend(Eigen::Vector2f(corner.head<2>() / corner.w()));
    }
    const auto pixel = [](float value, int size) {
        return std::clamp((value + 1) / 2 * float(size), -1.0f, float(size) + 1);
    };
    constexpr int kRounding = 1;  // rasterisation may round either way
    const PixelBox touched{
        int(std::floor(pixel(ndc.min().x(), width))), int(std::floor(pixel(ndc.min().y(), height))),
        int(std::ceil(pixel(ndc.max().x(), width))), int(std::ceil(pixel(ndc.max().y(), height)))};
    return touched.grown(kRounding).within(whole(width, height));
}

Eigen::Matrix4f PixelBox::zoom(int picture_width, int picture_height) const {
    const float scale_x = float(picture_width) / float(width()),
                scale_y = float(picture_height) / float(height());
    const float middle_x = float(x0 + x1) / float(picture_width) - 1;
    const float middle_y = float(y0 + y1) / float(picture_height) - 1;
    Eigen::Matrix4f zoom = Eigen::Matrix4f::Identity();
    zoom(0, 0) = scale_x;
    zoom(1, 1) = scale_y;
    zoom(0, 3) = -middle_x * scale_x;
    zoom(1, 3) = -middle_y * scale_y;
    return zoom;
}

}  // namespace bonemill
