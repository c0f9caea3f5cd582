// It is a rectangle of pixels, half open, counted from the picture's lower left corner as OpenGL does.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>

namespace bonemill {

struct PixelBox {
    int x0 = 0, y0 = 0, x1 = 0, y1 = 0;

    static PixelBox whole(int width, int height) { return {0, 0, width, height}; }

    bool isEmpty() const { return x1 <= x0 || y1 <= y0; }
    int width() const { return x1 - x0; }
    int height() const { return y1 - y0; }
    bool operator==(const PixelBox&) const = default;

    // joined() is the smallest box around both, within() the part in the other one, grown() wider by so
    // many pixels on each side.
    PixelBox joined(const PixelBox& other) const;
    PixelBox within(const PixelBox& other) const;
    PixelBox grown(int pixels) const { return {x0 - pixels, y0 - pixels, x1 + pixels, y1 + pixels}; }

    // Returns every pixel that the box (in the frame that clip_from_model takes) may touch in a picture of
    // this size; this is the whole picture when part of the box is at or behind the eye.
    static PixelBox around(const Eigen::AlignedBox3f& box, const Eigen::Matrix4f& clip_from_model, int width,
                           int height);

    // Returns what scales clip space so that this box fills it, to leave out what lies beside it.
    Eigen::Matrix4f zoom(int picture_width, int picture_height) const;
};

}  // namespace bonemill
