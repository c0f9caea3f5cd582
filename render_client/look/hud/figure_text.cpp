#include "render_client/look/hud/figure_text.h"

#include <algorithm>
#include <cmath>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <sstream>

#include "render_client/language/language.h"

namespace bonemill {
namespace {

std::vector<std::string> splitSigns(const std::string& utf8) {
    std::vector<std::string> signs;
    for (const char byte : utf8) {
        const bool continues = (uint8_t(byte) & 0xc0) == 0x80;
        if (signs.empty() || !continues) signs.emplace_back();
        signs.back() += byte;
    }
    return signs;
}

}  // namespace

std::string roleName(topics::Viewer::Role role) {
    switch (role) {
        case topics::Viewer::VIEWER:
            return trMark("viewer");
        case topics::Viewer::OPERATOR:
            return trMark("operator");
        case topics::Viewer::INSTRUCTOR:
            return trMark("instructor");
        case topics::Viewer::EXAMINER:
            return trMark("examiner");
        default:
            return "?";
    }
}

std::string watcherName(const std::string& name) {
    return name.empty() ? tr("(no name)") : name;
}

std::string watcherText(const topics::Viewer& watcher) {
    const std::string role = tr(roleName(watcher.role()).c_str());
    return (watcher.link().empty() ? role : tr("{1} by {2}", {role, watcher.link()})) + ", " +
           figureText(watcher.frame_rate_hz(), 0, " Hz") +
           (watcher.is_holding() ? tr(", holds the tool") : "") +
           (watcher.is_complete() ? "" : tr(", incomplete"));
}

std::string clockText(double seconds) {
    if (!(seconds >= 0) || !std::isfinite(seconds)) return kNoNumber;
    const auto whole = static_cast<unsigned long long>(std::min(seconds, 1e9));
    char text[32];
    std::snprintf(text, sizeof text, "%llu:%02llu:%02llu", whole / 3600, whole / 60 % 60, whole % 60);
    return text;
}

std::string figureText(double value, int decimals, const char* unit) {
    if (!std::isfinite(value)) return kNoNumber;
    char text[64];
    std::snprintf(text, sizeof text, "%.*f%s", decimals, value, unit);
    const bool is_zero = std::strtod(text, nullptr) == 0;
    return is_zero && text[0] == '-' ? text + 1 : text;
}

std::string readableText(double value, const char* unit) {
    const double magnitude = std::abs(value);
    return figureText(value, magnitude < 10 ? 2 : magnitude < 1000 ? 1 : 0, unit);
}

std::string lengthText(std::span<const double> v, double scale, const char* unit) {
    return v.size() == 3 ? readableText(std::hypot(v[0], v[1], v[2]) * scale, unit) : kNoNumber;
}

// The text is cut between code points.
std::string shortenedText(const std::string& text, size_t most) {
    const std::vector<std::string> signs = splitSigns(text);
    if (signs.size() <= most) return text;
    std::string result;
    for (size_t i = 0; i + 1 < most; ++i) result += signs[i];
    return result + "\u2026";
}

std::vector<std::string> wrappedText(const std::string& text, size_t most) {
    std::vector<std::string> lines(1);
    std::istringstream words(text);
    for (std::string word; words >> word;) {
        if (!lines.back().empty() && lines.back().size() + 1 + word.size() > most) lines.emplace_back();
        lines.back() += (lines.back().empty() ? "" : " ") + word;
    }
    return lines;
}

}  // namespace bonemill
