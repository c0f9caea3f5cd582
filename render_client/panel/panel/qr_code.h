// A text as a QR code, for a telephone's camera.
#pragma once

#include <string>
#include <vector>

namespace bonemill {

// Squares along an edge, and row by row which are dark; no squares where the text is too long for a code. The
// reader wants a light border of kQuietSquares around it.
struct QrCode {
    static constexpr int kQuietSquares = 4;
    int width = 0;
    std::vector<bool> is_dark;
};

QrCode qrCodeOf(const std::string& text);

}  // namespace bonemill
