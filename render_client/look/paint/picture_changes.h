// Finds which pixels of a resting view have to be drawn anew. It is for one thread.
#pragma once

#include <Eigen/Geometry>
#include <optional>
#include <vector>

#include "render_client/look/camera/camera.h"
#include "render_client/look/paint/frame.h"
#include "render_client/look/paint/pixel_tiles.h"

namespace bonemill {

class PictureChanges {
  public:
    // What is another one than in the last picture.
    struct Changed {
        Eigen::AlignedBox3f bone_V;               // around triangles that came or went
        std::vector<Eigen::AlignedBox3f> look_V;  // the bone has the same shape there, but looks different
        PixelTiles moving;                        // of what moves before the bone, now
        // Numbers that are the same only while all that moves stands still as it is; empty: it does not.
        std::vector<float> still_like;
    };
    // What the next picture must draw.
    struct Dirty {
        bool is_whole;
        PixelBox bone;      // its shape, and what it looks like
        PixelTiles look;    // what it looks like only
        PixelTiles moving;  // what moves before the bone, now or in the last picture
    };

    // Returns a range that holds the needed one, and stays the same as long as it can while the camera rests.
    DepthRange range(const Camera& camera, const DepthRange& needed);

    // All is dirty when anything but what `changed` says is another one.
    Dirty next(const Frame& frame, int width, int height, Changed changed);

    // The next picture is drawn whole.
    void forget() { signature_.clear(); }

  private:
    std::vector<float> signature_;  // of the last view
    Camera camera_;
    DepthRange range_;
    std::optional<PixelTiles> moving_;  // in the last picture
    std::vector<float> still_like_;     // in the last picture
};

}  // namespace bonemill
