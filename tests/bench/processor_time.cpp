#include "tests/bench/processor_time.h"

#include <unistd.h>

#include <fstream>
#include <string>
#include <thread>

namespace bonemill::bench {

double processorSeconds(int pid) {
    std::ifstream stat("/proc/" + std::to_string(pid) + "/stat");
    std::string word;
    for (int field = 1; field < 14; ++field) stat >> word;
    double user = 0, system = 0;
    stat >> user >> system;
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
