#include "haptic_server/scans/pixels/decimal_numbers.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <string_view>

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

}  // namespace bonemill
