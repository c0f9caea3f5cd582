#include "common/log/log.h"

#include <spdlog/sinks/stdout_color_sinks.h>
#include <spdlog/spdlog.h>

#include "common/base/user_error.h"
#include "common/rt/realtime.h"

namespace bonemill {

void setUpLog(const std::string& program, const std::string& level) {
    // spdlog turns an unknown word into "off", which would silence the log over a typing error.
    const spdlog::level::level_enum parsed = spdlog::level::from_str(level);
    if (parsed == spdlog::level::off && level != "off") {
        throw UserError("log level '" + level +
                        "' is unknown: choose trace, debug, info, warn, error or off");
    }
    spdlog::drop(program);
    spdlog::set_default_logger(spdlog::stderr_color_mt(program));
    spdlog::set_pattern("%H:%M:%S.%e %n %^%l%$ %v");
    spdlog::set_level(parsed);
    spdlog::flush_on(spdlog::level::warn);
}

void logRealtime(const RealtimeReport& report) {
    for (const std::string& advice : report.advice) spdlog::info("real time: {}", advice);
    if (report.missing.empty()) return;
    std::string lacks;
    for (const std::string& missing : report.missing) lacks += " " + missing;
    spdlog::warn("real time: going on without, good for a look (deploy/check-realtime says what to type):{}",
                 lacks);
}

}  // namespace bonemill
