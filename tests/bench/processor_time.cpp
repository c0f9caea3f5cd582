#include "tests/bench/processor_time.h"

#include <unistd.h>

#include <algorithm>
#include <fstream>
#include <sstream>
#include <string>
#include <thread>

namespace bonemill::bench {

double processorSeconds(int pid) {
    std::ifstream stat("/proc/" + std::to_string(pid) + "/stat");
    std::string text;
    std::getline(stat, text);
    std::istringstream fields(text.substr(std::min(text.rfind(')') + 1, text.size())));
    std::string skipped;
    for (int n = 3; n < 14; ++n) fields >> skipped;  // proc(5): 14 is utime, 15 stime
    double user = 0, system = 0;
    fields >> user >> system;
    return (user + system) / double(sysconf(_SC_CLK_TCK));
}

double shareOfACore(int pid, std::chrono::seconds time) {
    const double before = processorSeconds(pid);
    std::this_thread::sleep_for(time);
    return (processorSeconds(pid) - before) / double(time.count());
}

size_t residentBytesOf(int pid) {
    std::ifstream statm("/proc/" + std::to_string(pid) + "/statm");
    size_t whole = 0, resident = 0;
    statm >> whole >> resident;
    return resident * size_t(sysconf(_SC_PAGESIZE));
}

}  // namespace bonemill::bench
