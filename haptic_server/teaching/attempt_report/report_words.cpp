#include "haptic_server/teaching/attempt_report/report_words.h"

#include <cmath>
#include <cstdint>
#include <cstdio>

#include "common/text/text_encoding.h"
#include "haptic_server/assessment/measures/figure.h"

namespace bonemill {
namespace {

std::string withoutZeros(std::string text) {
    if (text.find('.') == std::string::npos) return text;
    while (text.back() == '0') text.pop_back();
    if (text.back() == '.') text.pop_back();
    return text == "-0" ? "0" : text;
}

}  // namespace

std::string element(const std::string& name, const std::string& content, const std::string& attributes) {
    return '<' + name + (attributes.empty() ? "" : " " + attributes) + '>' + content + "</" + name + '>';
}

std::string escaped(std::string_view text) {
    std::string out;
    for (size_t at = 0; at < text.size();) {
        const size_t bytes = letterBytes(text, at);
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
