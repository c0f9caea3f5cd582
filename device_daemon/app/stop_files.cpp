#include "device_daemon/app/stop_files.h"

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <string>

namespace bonemill {

std::filesystem::path defaultStopDir() {
    if (const char* state = std::getenv("XDG_STATE_HOME"); state && *state)
        return std::filesystem::path(state) / "bonemill";
    const char* home = std::getenv("HOME");
    return std::filesystem::path(home && *home ? home : ".") / ".local/state/bonemill";
}

std::filesystem::path stopFile(const std::filesystem::path& dir, uint32_t session, StopCause cause) {
    std::error_code error;
    std::filesystem::create_directories(dir, error);
    timespec now{};
    clock_gettime(CLOCK_REALTIME, &now);
    std::tm local{};
    localtime_r(&now.tv_sec, &local);
    char time[32];
    std::strftime(time, sizeof(time), "%Y-%m-%d_%H-%M-%S", &local);
    std::string name = "stop_" + std::to_string(session) + '_' + time + '_' +
                       std::to_string(now.tv_nsec / 1'000'000) + '_' + nameOf(cause) + ".csv";
    std::replace(name.begin(), name.end(), ' ', '_');
    return dir / name;
}

}  // namespace bonemill
