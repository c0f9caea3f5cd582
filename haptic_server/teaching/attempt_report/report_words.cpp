#include "haptic_server/teaching/attempt_report/report_words.h"

#include <cmath>
#include <cstdint>
#include <cstdio>

#include "haptic_server/assessment/measures/figure.h"

namespace bonemill {
namespace {

// How many bytes the letter of UTF-8 has that begins there; 0: it is none.
size_t lettersBytes(std::string_view text, size_t at) {
    const auto byte = [&](size_t i) { return i < text.size() ? uint8_t(text[i]) : uint8_t(0); };
    const uint8_t first = byte(at);
    if (first < 0x80) return first >= 0x20 && first != 0x7f ? 1 : 0;
    const size_t count = first >= 0xf0 ? 4 : first >= 0xe0 ? 3 : 2;
    if (first < 0xc2 || first > 0xf4) return 0;
    for (size_t i = 1; i < count; ++i)
        if ((byte(at + i) & 0xc0) != 0x80) return 0;
    const bool is_overlong = (first == 0xe0 && byte(at + 1) < 0xa0) || (first == 0xf0 && byte(at + 1) < 0x90);
    const bool is_no_letter =
        (first == 0xed && byte(at + 1) > 0x9f) || (first == 0xf4 && byte(at + 1) > 0x8f);
    return is_overlong || is_no_letter || (first == 0xc2 && byte(at + 1) < 0xa0) ? 0 : count;
}

std::string withoutZeros(std::string text) {
    if (text.find('.') == std::string::npos) return text;
    while (text.back() == '0') text.pop_back();
    if (text.back() == '.') text.pop_back();
    return text == "-0" ? "0" : text;
}

}  // namespace

std::string escaped(std::string_view text) {
    std::string out;
    for (size_t at = 0; at < text.size();) {
        const size_t bytes = lettersBytes(text, at);
        if (bytes == 0) {
            out += '?';
            ++at;
            continue;
        }
        switch (text[at]) {
            case '&':
                out += "&amp;";
                break;
            case '<':
                out += "&lt;";
                break;
            case '>':
                out += "&gt;";
                break;
            case '"':
                out += "&quot;";
                break;
            case '\'':
                out += "&#39;";
                break;
            default:
                out += text.substr(at, bytes);
        }
        at += bytes;
    }
    return out;
}

std::string roundedText(double value) {
    if (!std::isfinite(value)) return "–";
    const double size = std::abs(value);
    char text[48];
    if (value == 0) return "0";
    if (size >= 1e7 || size < 1e-3) {
        std::snprintf(text, sizeof text, "%.2e", value);
        return text;
    }
    const int decimals = std::max(0, 2 - int(std::floor(std::log10(size))));
    std::snprintf(text, sizeof text, "%.*f", decimals, value);
    return withoutZeros(text);
}

std::string valueText(double value, std::string_view unit) {
    const std::string_view written = writtenUnit(unit);
    const std::string number = roundedText(value);
    if (written.empty()) return number;
    return number + (written == "°" ? "" : " ") + std::string(written);
}

std::string clockText(double t_s) {
    const double tenths = std::round(std::max(0.0, t_s) * 10);
    const auto minutes = int64_t(tenths / 600);
    char text[48];
    std::snprintf(text, sizeof text, "%lld:%04.1f", static_cast<long long>(minutes),
                  (tenths - double(minutes) * 600) / 10);
    return text;
}

std::string coordinate(double value) {
    char text[48];
    std::snprintf(text, sizeof text, "%.2f", value);
    return withoutZeros(text);
}

std::string base64(std::string_view bytes) {
    static constexpr char kLetters[] = "ABCDEFGHIJKLMNOPQRSTUVWXYZabcdefghijklmnopqrstuvwxyz0123456789+/";
    std::string out;
    for (size_t at = 0; at < bytes.size(); at += 3) {
        uint32_t three = 0;
        for (size_t i = 0; i < 3; ++i)
            three = three << 8 | (at + i < bytes.size() ? uint8_t(bytes[at + i]) : 0);
        for (size_t i = 0; i < 4; ++i)
            out += at + i <= bytes.size() ? kLetters[three >> (18 - 6 * i) & 63] : '=';
    }
    return out;
}

}  // namespace bonemill
