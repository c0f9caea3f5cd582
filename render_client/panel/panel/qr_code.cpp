#include "render_client/panel/panel/qr_code.h"

#include <qrencode.h>

#include <memory>

namespace bonemill {

QrCode qrCodeOf(const std::string& text) {
    constexpr int kAnyVersion = 0, kWithLetterCase = 1;
    const std::unique_ptr<QRcode, void (*)(QRcode*)> code(
        QRcode_encodeString(text.c_str(), kAnyVersion, QR_ECLEVEL_M, QR_MODE_8, kWithLetterCase),
        QRcode_free);
    if (!code) return {};
    QrCode squares{code->width, {}};
    for (int n = 0; n < code->width * code->width; ++n) squares.is_dark.push_back(code->data[n] & 1);
    return squares;
}

}  // namespace bonemill
