#include "haptic_server/scans/confined/free_memory.h"

#include <sys/resource.h>
#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <optional>
#include <sstream>
#include <string_view>

namespace bonemill {
namespace {

namespace fs = std::filesystem;

// What one version of control groups calls the files of a group.
struct GroupFiles {
    const char *limit, *used;
    const char* cached[2];  // in memory.stat
};

constexpr GroupFiles kVersion1{
    "memory.limit_in_bytes", "memory.usage_in_bytes", {"total_inactive_file", "total_active_file"}};
constexpr GroupFiles kVersion2{"memory.max", "memory.current", {"inactive_file", "active_file"}};

// Without a limit version 2 says "max" and version 1 a number near 2^63.
constexpr uint64_t kNoLimit = uint64_t(1) << 60;

std::optional<uint64_t> numberIn(const fs::path& file) {
    uint64_t number = 0;
    if (!(std::ifstream(file) >> number)) return std::nullopt;
    return number;
}

uint64_t cachedBytes(const fs::path& group, const GroupFiles& files) {
    std::ifstream stat(group / "memory.stat");
    uint64_t bytes = 0, number = 0;
    for (std::string key; stat >> key >> number;)
        for (const char* const cached : files.cached)
            if (key == cached) bytes += number;
    return bytes;
}

// A place where groups are mounted, as a line of mountinfo says it: "... / MOUNT_ROOT MOUNT_POINT ... - TYPE
// SOURCE OPTIONS".
struct Mount {
    std::string root, point, type, options;
};

// Blanks and others are written as \040.
std::string unescaped(const std::string& text) {
    std::string plain;
    for (size_t n = 0; n < text.size(); ++n) {
        if (text[n] == '\\' && n + 3 < text.size()) {
            plain += char(std::strtol(text.substr(n + 1, 3).c_str(), nullptr, 8));
            n += 3;
        } else {
            plain += text[n];
        }
    }
    return plain;
}

std::optional<Mount> mountOf(const std::string& line) {
    std::istringstream words(line);
    Mount mount;
    std::string word;
    for (int skipped = 0; skipped < 3; ++skipped) words >> word;
    words >> mount.root >> mount.point;
    while (words >> word && word != "-") {
    }
    if (!(words >> mount.type >> word >> mount.options)) return std::nullopt;
    mount.root = unescaped(mount.root);
    mount.point = unescaped(mount.point);
    return mount;
}

bool holdsWord(const std::string& list, std::string_view word) {
    std::istringstream words(list);
    for (std::string one; std::getline(words, one, ',');)
        if (one == word) return true;
    return false;
}

bool isOfVersion(const Mount& mount, int version) {
    return version == 2 ? mount.type == "cgroup2"
                        : mount.type == "cgroup" && holdsWord(mount.options, "memory");
}

// This process's group, as a line "ID:CONTROLLERS:PATH" says it.
std::optional<std::string> groupOf(const fs::path& proc, int version) {
    std::ifstream lines(proc / "self/cgroup");
    for (std::string line; std::getline(lines, line);) {
        const size_t first = line.find(':'), second = line.find(':', first + 1);
        if (second == std::string::npos) continue;
        const std::string controllers = line.substr(first + 1, second - first - 1);
        if (version == 2 ? line.starts_with("0::") : holdsWord(controllers, "memory"))
            return line.substr(second + 1);
    }
    return std::nullopt;
}

FreeMemory leftIn(const fs::path& folder, const std::string& name, const GroupFiles& files) {
    const auto limit = numberIn(folder / files.limit), used = numberIn(folder / files.used);
    if (!limit || !used || *limit >= kNoLimit) return {};
    const uint64_t held = *used - std::min(*used, cachedBytes(folder, files));
    return {std::max<uint64_t>(1, *limit - std::min(held, *limit)),
            "a limit of " + std::to_string(*limit >> 20) + " MiB on " + name};
}

FreeMemory least(const FreeMemory& a, const FreeMemory& b) {
    if (a.bytes == 0 || b.bytes == 0) return a.bytes == 0 ? b : a;
    return b.bytes < a.bytes ? b : a;
}

// A container sees only a part of the groups' tree: what is mounted begins at `root`.
FreeMemory leftAround(const std::string& group, const Mount& mount, const GroupFiles& files) {
    const bool is_part = mount.root != "/" && group.starts_with(mount.root);
    fs::path below = fs::path(is_part ? group.substr(mount.root.size()) : group).relative_path();
    FreeMemory left = leftIn(mount.point, "all that runs here", files);
    for (; !below.empty(); below = below.parent_path())
        left = least(left, leftIn(fs::path(mount.point) / below, "/" + below.string(), files));
    return left;
}

FreeMemory leftInGroups(const fs::path& proc, int version) {
    const auto group = groupOf(proc, version);
    if (!group) return {};
    FreeMemory left;
    std::ifstream lines(proc / "self/mountinfo");
    for (std::string line; std::getline(lines, line);)
        if (const auto mount = mountOf(line); mount && isOfVersion(*mount, version))
            left = least(left, leftAround(*group, *mount, version == 2 ? kVersion2 : kVersion1));
    return left;
}

uint64_t own_address_limit = 0;

FreeMemory leftOfAddresses(const fs::path& proc) {
    const auto pages = numberIn(proc / "self/statm");
    rlimit limit{};
    if (!pages || getrlimit(RLIMIT_AS, &limit) != 0 || limit.rlim_max == RLIM_INFINITY ||
        limit.rlim_max == own_address_limit)
        return {};
    const uint64_t used = *pages * uint64_t(sysconf(_SC_PAGESIZE)), most = limit.rlim_max;
    return {std::max<uint64_t>(1, most - std::min(used, most)),
            "a limit of " + std::to_string(most >> 20) + " MiB on addresses, ulimit -v"};
}

FreeMemory leftOnMachine(const fs::path& proc) {
    std::ifstream meminfo(proc / "meminfo");
    std::string key, unit;
    uint64_t kib = 0;
    while (meminfo >> key >> kib) {
        std::getline(meminfo, unit);
        if (key == "MemAvailable:") return {kib * 1024, {}};
    }
    return {};
}

}  // namespace

std::string FreeMemory::text() const {
    return "only " + std::to_string(bytes >> 20) + " MiB of memory are free" +
           (limit.empty() ? "" : " (" + limit + ")");
}

FreeMemory freeMemory(const fs::path& proc) {
    const FreeMemory in_groups = least(leftInGroups(proc, 1), leftInGroups(proc, 2));
    return least(least(leftOnMachine(proc), leftOfAddresses(proc)), in_groups);
}

void noteOwnAddressLimit(uint64_t bytes) noexcept {
    own_address_limit = bytes;
}

}  // namespace bonemill
