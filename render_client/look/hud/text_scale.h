// Says how large text is. The function is pure; any thread may call it.
#pragma once

namespace bonemill {

// Text is so much larger than in a picture of 1280x800 pixels: it grows with the picture, whatever the
// desktop is set to, and is no smaller than can be read on this desktop. `chosen` is the user's own factor.
float textScale(int width, int height, double chosen = 1, float desktop_scale = 1);

}  // namespace bonemill
