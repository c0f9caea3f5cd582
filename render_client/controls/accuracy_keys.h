// Which accuracy settings the window's digit keys ask the server for: key n means the n-th, as the argument
// of Command.set_accuracy.
#pragma once

#include <string_view>

namespace bonemill {

inline constexpr std::string_view kAccuracyOfKey[] = {"scene", "thesis_2012", "fast", "balanced", "exact"};

}  // namespace bonemill
