// The text log of a program is spdlog's default logger on stderr. It is never used in the tick.
#pragma once

#include <string>

namespace bonemill {

struct RealtimeReport;

// `level` is trace, debug, info, warn, error or off (as `--log-level`). Throws UserError on any other word.
void setUpLog(const std::string& program, const std::string& level);

// Says what this machine grants a thread that keeps deadlines: its lacks as warnings, advice as information.
void logRealtime(const RealtimeReport& report);

}  // namespace bonemill
