// Finds which pixels of a resting view have to be drawn anew. It is a plain value, for one thread.
#pragma once

#include <vector>

#include "render_client/look/paint/frame.h"
#include "render_client/look/paint/pixel_box.h"

namespace bonemill {

class PictureChanges {
  public:
    struct Dirty {
        PixelBox bone;  // bone and background
        PixelBox all;   // and what moves before them
    };

    // Returns a range that holds the needed one, and stays the same as long as it can while the camera rests.
    DepthRange range(const Camera& camera, const DepthRange& needed);

    // Returns what the next picture of this size must draw: all of it when anything but nodes and
    // moving things has changed. changed_V is the box around the nodes that changed, `moving` are the
    // pixels of what moves now, and still_like are numbers that are the same only while all of it stands
    // still as it is (empty: it does not).
    Dirty next(const Frame& frame, int width, int height, const Eigen::AlignedBox3f& changed_V,
               const PixelBox& moving, std::vector<float> still_like);

    // The next picture is drawn whole.
    void forget() { signature_.clear(); }

  private:
    std::vector<float> signature_;  // of the last view
    Camera camera_;
    DepthRange range_;
    PixelBox moving_;                // in the last picture
    std::vector<float> still_like_;  // in the last picture
};

}  // namespace bonemill
