#include "common/rt/page_faults.h"

#include <fstream>
#include <sstream>
#include <string>

namespace bonemill {

std::optional<PageFaults> pageFaultsOf(pid_t thread) {
    std::ifstream file("/proc/self/task/" + std::to_string(thread) + "/stat");
    std::string line;
    if (!std::getline(file, line)) return std::nullopt;
    // The name stands in parentheses and may hold anything. After it come the state, six numbers, flags,
    // minflt, cminflt and majflt.
    std::istringstream rest(line.substr(line.rfind(')') + 1));
    std::string skipped;
    for (int n = 0; n < 7; ++n) rest >> skipped;
    PageFaults faults;
    uint64_t minor_of_children = 0;
    rest >> faults.minor >> minor_of_children >> faults.major;
    return rest ? std::optional(faults) : std::nullopt;
}

}  // namespace bonemill
