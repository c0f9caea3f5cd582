// Text log of a program: spdlog's default logger on stderr. Never in the tick.
#pragma once

#include <string>

namespace bonemill {

// level: trace, debug, info, warn, error or off (as `--log-level`). Throws UserError on any other word.
void setUpLog(const std::string& program, const std::string& level);

}  // namespace bonemill
