// Parts of a picture, in pixels. They are plain values, for any thread.
#pragma once

#include <Eigen/Core>
#include <Eigen/Geometry>
#include <cstdint>
#include <vector>

namespace bonemill {

// It is a rectangle of pixels, half open, counted from the picture's lower left corner as OpenGL does.
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
    // Returns where it lies in a picture of this height that stands on its head.
    PixelBox upsideDown(int height) const { return {x0, height - y1, x1, height - y0}; }

    // Returns every pixel that the box (in the frame that clip_from_model takes) may touch in a picture of
    // this size; this is the whole picture when part of the box is at or behind the eye.
    static PixelBox around(const Eigen::AlignedBox3f& box, const Eigen::Matrix4f& clip_from_model, int width,
                           int height);

    // Returns what scales clip space so that this box fills it, to leave out what lies beside it.
    Eigen::Matrix4f zoom(int picture_width, int picture_height) const;
};

// Cuts the box across this axis into so many.
std::vector<Eigen::AlignedBox3f> sliced(const Eigen::AlignedBox3f& box, Eigen::Index axis, int count);
// Cuts it across its longest one.
std::vector<Eigen::AlignedBox3f> sliced(const Eigen::AlignedBox3f& box, int count);

// It is a part of a picture of any shape, as square tiles: what is added takes all tiles that it touches.
class PixelTiles {
  public:
    static constexpr int kTile = 16;  // pixels, each side

    // A picture of this size, and nothing of it.
    PixelTiles(int width, int height);
    static PixelTiles whole(int width, int height);

    void add(const PixelBox& box);
    void add(const PixelTiles& other);   // of the same picture
    void keep(const PixelTiles& other);  // only what both have
    bool isEmpty() const;
    bool operator==(const PixelTiles&) const = default;

    // Returns them with all that lies at most so many pixels beside them.
    PixelTiles grown(int pixels) const;
    // Returns the smallest box around them.
    PixelBox bounds() const;
    // Returns boxes that are these tiles together, and share no pixel.
    std::vector<PixelBox> boxes() const;

  private:
    bool has(int column, int row) const { return has_[size_t(row * columns_ + column)] != 0; }
    std::vector<PixelBox> runs(int row) const;

    int width_, height_, columns_, rows_;
    std::vector<uint8_t> has_;
};

}  // namespace bonemill
