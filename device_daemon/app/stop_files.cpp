#include "device_daemon/app/stop_files.h"

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <string>
#include <utility>
#include <vector>

namespace bonemill {
namespace {

namespace fs = std::filesystem;

bool isStopFile(const fs::directory_entry& entry) {
    std::error_code error;
    const std::string name = entry.path().filename();
    return entry.symlink_status(error).type() == fs::file_type::regular && name.starts_with("stop_") &&
           name.ends_with(".csv");
}

void makeRoomIn(const fs::path& dir) {
    std::error_code error;
    std::vector<std::pair<fs::file_time_type, fs::path>> files;
    for (const fs::directory_entry& entry : fs::directory_iterator(dir, error))
        if (isStopFile(entry)) files.emplace_back(entry.last_write_time(error), entry.path());
    std::sort(files.begin(), files.end());
    for (size_t i = 0; i + kMostStopFiles <= files.size(); ++i) fs::remove(files[i].second, error);
}

}  // namespace

fs::path defaultStopDir() {
    if (const char* state = std::getenv("XDG_STATE_HOME"); state && *state)
        return fs::path(state) / "bonemill";
    const char* home = std::getenv("HOME");
    return fs::path(home && *home ? home : ".") / ".local/state/bonemill";
}

fs::path stopFile(const fs::path& dir, uint32_t session, StopCause cause) {
    std::error_code error;
    fs::create_directories(dir, error);
    makeRoomIn(dir);
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
