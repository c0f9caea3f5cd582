// Checks the bounds of a number on the command line. CLI::Range and CLI::PositiveNumber would let NaN pass.
#pragma once

#include <CLI/CLI.hpp>

namespace bonemill {

inline constexpr double kMaxSeconds = 1e7;  // 115 days, which still fits into 64 bits of nanoseconds

inline CLI::Validator within(double low, double high) {
    return {[=](std::string& text) -> std::string {
                double value = 0;
                if (CLI::detail::lexical_cast(text, value) && value >= low && value <= high) return {};
                return text + " is not a number from " + CLI::detail::to_string(low) + " to " +
                       CLI::detail::to_string(high);
            },
            "NUMBER"};
}

}  // namespace bonemill
