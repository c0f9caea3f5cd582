#include "device_daemon/device_setup/stop_files.h"

#include <fnmatch.h>

#include <algorithm>
#include <cstdlib>
#include <ctime>
#include <string>
#include <utility>
#include <vector>

namespace bonemill {
namespace {

namespace fs = std::filesystem;

// A folder that a user has chosen may hold files of the user's own: only names of stopFile() count.
bool isStopFile(const fs::directory_entry& entry) {
    constexpr char kDate[] = "[0-9][0-9][0-9][0-9]-[0-9][0-9]-[0-9][0-9]",
                   kTime[] = "[0-9][0-9]-[0-9][0-9]-[0-9][0-9]";
    static const std::string kPattern = std::string("stop_[0-9]*_") + kDate + '_' + kTime + "_[0-9]*_*.csv";
    std::error_code error;
    return entry.symlink_status(error).type() == fs::file_type::regular &&
           fnmatch(kPattern.c_str(), entry.path().filename().c_str(), 0) == 0;
}

// One that has just gone counts as the oldest.
fs::file_time_type lastWriteTime(const fs::directory_entry& entry) {
    std::error_code error;
    return entry.last_write_time(error);
}

void makeRoomIn(const fs::path& dir) {
    std::error_code error;
    std::vector<std::pair<fs::file_time_type, fs::path>> files;
    for (fs::directory_iterator entry(dir, error), end; !error && entry != end; entry.increment(error))
        if (isStopFile(*entry)) files.emplace_back(lastWriteTime(*entry), entry->path());
    std::sort(files.begin(), files.end());
    for (size_t i = 0; i + kMaxStopFiles <= files.size(); ++i) fs::remove(files[i].second, error);
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
