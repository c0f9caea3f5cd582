// Numbers and words as reports write them. The functions are pure; any thread may call them.
#pragma once

#include <string>
#include <string_view>

#include "common/base/units.h"

namespace bonemill {

// Text as HTML and SVG may hold it, in elements and in quoted attributes. What is no UTF-8, or a control
// character, becomes "?".
std::string escaped(std::string_view text);
// Three significant digits, without an exponent where that is short: 0.0123, 4.5, 120.
std::string roundedText(double value);
// The number with its unit as people write it: "4.5 mm³", "12 %", "48 °C".
std::string valueText(double value, std::string_view unit);
// 1:02.5 for 62.5 s.
std::string clockText(double t_s);
// For attributes of SVG: two decimals at most.
std::string coordinate(double value);
std::string base64(std::string_view bytes);
// An element of HTML; content and attributes are HTML already.
std::string element(const std::string& name, const std::string& content, const std::string& attributes = "");

// What stands below the picture of over- and under-cut; `scale` in m: from there on colours are full.
inline std::string deviationCaption(double scale) {
    return "Red: cut too far. Blue: not far enough. Full colour from " +
           valueText(scale * kPerMillimetre, "mm") + " on.";
}

}  // namespace bonemill
