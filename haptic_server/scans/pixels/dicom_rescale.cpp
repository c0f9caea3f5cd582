#include "haptic_server/scans/pixels/dicom_rescale.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

#include "common/base/user_error.h"

namespace bonemill {
namespace {

std::optional<double> decimalNumber(const std::string& padded) {
    const std::string unpadded = withoutPadding(padded);
    std::string_view text = unpadded;
    if (text.starts_with('+') && !text.starts_with("+-")) text.remove_prefix(1);
    double number = 0;
    const auto [end, error] = std::from_chars(text.data(), text.data() + text.size(), number);
    if (error != std::errc() || end != text.data() + text.size() || !std::isfinite(number))
        return std::nullopt;
    return number;
}

double scaleNumber(const std::string& text, const char* what, const std::string& image) {
    const auto numbers = decimalNumbers(text);
    if (!numbers || numbers->size() != 1)
        throw UserError(image + ": its " + what + " \"" + text + "\" is no number; the header is damaged");
    return numbers->front();
}

}  // namespace

std::string withoutPadding(const std::string& text) {
    constexpr std::string_view kPadding(" \0", 2);
    const auto first = text.find_first_not_of(kPadding);
    if (first == std::string::npos) return {};
    return text.substr(first, text.find_last_not_of(kPadding) - first + 1);
}

std::optional<std::vector<double>> decimalNumbers(const std::string& text) {
    std::vector<double> numbers;
    for (size_t begin = 0; begin <= text.size();) {
        const size_t end = std::min(text.find('\\', begin), text.size());
        const auto number = decimalNumber(text.substr(begin, end - begin));
        if (!number) return std::nullopt;
        numbers.push_back(*number);
        begin = end + 1;
    }
    return numbers;
}

std::optional<DicomRescale> rescaleFromTexts(const std::string& slope, const std::string& intercept,
                                             const std::string& image) {
    if (slope.empty() && intercept.empty()) return std::nullopt;
    if (slope.empty() || intercept.empty())
        throw UserError(
            image + ": states a Rescale " +
            (slope.empty() ? "Intercept without a Rescale Slope" : "Slope without a Rescale Intercept") +
            "; export it anew with both");
    const DicomRescale rescale{scaleNumber(slope, "Rescale Slope", image),
                               scaleNumber(intercept, "Rescale Intercept", image)};
    if (rescale.slope == 0)
        throw UserError(image + ": its Rescale Slope is 0, which makes all values the same; export it anew");
    return rescale;
}

}  // namespace bonemill
