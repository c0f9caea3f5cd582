// Units for people: figures have them in ASCII, as "mm3", and texts as "mm³".
#pragma once

#include <array>
#include <string_view>
#include <utility>

namespace bonemill {

inline std::string_view writtenUnit(std::string_view unit) {
    using Pair = std::pair<std::string_view, std::string_view>;
    static constexpr std::array kWritten = {
        Pair("mm3", "mm³"),     Pair("mm2", "mm²"),     Pair("percent", "%"),
        Pair("degC", "°C"),     Pair("deg", "°"),       Pair("N s", "N·s"),
        Pair("mm3/s", "mm³/s"), Pair("J/mm3", "J/mm³"), Pair("mm/mm3", "mm/mm³")};
    for (const auto& [plain, with_signs] : kWritten)
        if (unit == plain) return with_signs;
    return unit;
}

}  // namespace bonemill
