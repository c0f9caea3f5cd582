// Runs deploy/check-realtime on machines that are only files: what does it say of each lack, and what is its
// exit code?
#include <gtest/gtest.h>

#include <algorithm>
#include <regex>

#include "tests/support/places.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

using test::Finished;

constexpr const char* kNothingMissing = "Nothing that is needed is missing; ";
const std::string kCpu = "sys/devices/system/cpu/cpu3/";

// The PC has four cores, is set up as well as can be, and runs its tick on core 3.
class CheckRealtime : public testing::Test {
  protected:
    CheckRealtime() {
        setLimits("90", "unlimited");
        setProcess("1000", "0000000000000000");
        set("proc/sys/kernel/version", "#1 SMP PREEMPT_RT Debian 6.1.0-1 (2026-01-01)\n");
        set("proc/sys/kernel/osrelease", "6.1.0-rt-amd64\n");
        set("proc/sys/kernel/sched_rt_runtime_us", "950000\n");
        set("proc/meminfo", "MemTotal:       32000000 kB\nSwapTotal:             0 kB\n");
        set("proc/cpuinfo", "flags\t\t: fpu sse2 avx2\n");
        set("sys/devices/system/cpu/isolated", "2-3\n");
        set(kCpu + "cpufreq/scaling_governor", "performance\n");
        set(kCpu + "cpuidle/state0/latency", "2\n");
        set(kCpu + "cpuidle/state0/disable", "0\n");
        set(kCpu + "cpuidle/state1/latency", "400\n");
        set(kCpu + "cpuidle/state1/disable", "1\n");
        set(kCpu + "topology/thread_siblings_list", "3\n");
    }
    void set(const std::string& file, const std::string& content) {
        const std::filesystem::path path = root_ / file;
        std::filesystem::create_directories(path.parent_path());
        test::writeFile(path, content);
    }
    void setLimits(const std::string& priority, const std::string& memory_bytes) {
        const auto row = [](std::string name, std::string value, const char* units) {
            name.resize(26, ' ');
            value.resize(21, ' ');
            return name + value + value + units + "\n";
        };
        set("proc/self/limits", row("Limit", "Soft Limit", "Units") +
                                    row("Max locked memory", memory_bytes, "bytes") +
                                    row("Max realtime priority", priority, ""));
    }
    void setProcess(const std::string& user, const std::string& effective_capabilities) {
        set("proc/self/status", "Name:\tbash\nUid:\t" + user + "\t" + user + "\t" + user + "\t" + user +
                                    "\nCapPrm:\t000001ffffffffff\nCapEff:\t" + effective_capabilities + "\n");
    }
    Finished check(const std::vector<std::string>& more = {"--core", "3"}) {
        std::vector<std::string> arguments{test::sourceDir() + "/deploy/check-realtime", "--root",
                                           root_.path()};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return test::run(arguments);
    }
    // Nothing but this is found wanting: "MISSING  what: why", "better   what: why".
    static void expectOnly(const Finished& finished, const std::string& line, const std::string& command) {
        const bool is_needed = line.rfind("MISSING", 0) == 0;
        EXPECT_EQ(finished.exit_code, is_needed ? 1 : 0) << finished.out;
        EXPECT_NE(finished.out.find("  " + line + "\n"), std::string::npos) << finished.out;
        EXPECT_NE(finished.out.find("\n             " + command), std::string::npos) << finished.out;
        EXPECT_EQ(lacks(finished), 1) << finished.out;
        const std::string last =
            is_needed ? "\n1 needed, 0 to improve.\n" : std::string(kNothingMissing) + "1 to improve.\n";
        EXPECT_NE(finished.out.find(last), std::string::npos) << finished.out;
        EXPECT_EQ(finished.err, "");
    }
    static long lacks(const Finished& finished) {
        const std::regex lack("  (MISSING|better)  ");
        return std::distance(std::sregex_iterator(finished.out.begin(), finished.out.end(), lack), {});
    }

    test::TemporaryFolder root_;
};

TEST_F(CheckRealtime, AWellSetUpMachineLacksNothing) {
    const Finished finished = check();
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    EXPECT_EQ(lacks(finished), 0) << finished.out;
    EXPECT_NE(finished.out.find(std::string(kNothingMissing) + "0 to improve."), std::string::npos);
    EXPECT_EQ(finished.err, "");
}

TEST_F(CheckRealtime, LowPriorityLimitIsMissing) {
    setLimits("0", "unlimited");
    expectOnly(check(), "MISSING  real-time priority: you may use 0 of the 80 that the loop asks for",
               "echo '@haptics - rtprio 90' | sudo tee -a /etc/security/limits.d/haptics.conf");
    setLimits("79", "unlimited");
    EXPECT_EQ(check().exit_code, 1);
    setLimits("80", "unlimited");
    EXPECT_EQ(check().exit_code, 0);
}

TEST_F(CheckRealtime, LowMemoryLimitIsMissing) {
    setLimits("90", "8388608");
    expectOnly(check(), "MISSING  locked memory: you may lock 8192 KiB; a scan takes hundreds of MiB",
               "echo '@haptics - memlock unlimited' | sudo tee -a /etc/security/limits.d/haptics.conf");
}

TEST_F(CheckRealtime, BothLimitsAreCounted) {
    setLimits("0", "65536");
    const Finished finished = check();
    EXPECT_EQ(finished.exit_code, 1);
    EXPECT_NE(finished.out.find("2 needed, 0 to improve."), std::string::npos) << finished.out;
}

constexpr const char* kSysNice = "0000000000800000";  // linux/capability.h: bit 23
constexpr const char* kIpcLock = "0000000000004000";  // bit 14

TEST_F(CheckRealtime, CapabilitiesNeedNoLimits) {
    setLimits("0", "65536");
    for (const char* user : {"0", "1000"}) {
        for (const char* capabilities : {"000001ffffffffff", "ffffffffffffffff", "0000000000804000"}) {
            setProcess(user, capabilities);
            EXPECT_EQ(lacks(check()), 0) << user << ' ' << capabilities;
        }
    }
}

TEST_F(CheckRealtime, EachCapabilityIsForOneLimitOnly) {
    setLimits("0", "65536");
    setProcess("0", kSysNice);
    expectOnly(check(), "MISSING  locked memory: you may lock 64 KiB; a scan takes hundreds of MiB",
               "echo '@haptics - memlock unlimited' | sudo tee -a /etc/security/limits.d/haptics.conf");
    setProcess("0", kIpcLock);
    expectOnly(check(), "MISSING  real-time priority: you may use 0 of the 80 that the loop asks for",
               "echo '@haptics - rtprio 90' | sudo tee -a /etc/security/limits.d/haptics.conf");
}

TEST_F(CheckRealtime, RootOfAContainerWithoutCapabilitiesNeedsLimits) {
    setLimits("0", "65536");
    setProcess("0", "00000000a00425fb");
    EXPECT_EQ(check().exit_code, 1);
    EXPECT_EQ(lacks(check()), 2) << check().out;
}

TEST_F(CheckRealtime, AKernelThatKeepsTimeFromRealTimeThreadsIsMissing) {
    set("proc/sys/kernel/sched_rt_runtime_us", "500000\n");
    expectOnly(
        check(),
        "MISSING  time for real-time threads: the kernel takes the core away after 500000 of 1000000 us",
        "echo 950000 | sudo tee /proc/sys/kernel/sched_rt_runtime_us");
}

TEST_F(CheckRealtime, AKernelWithoutPreemptRtCouldBeBetter) {
    set("proc/sys/kernel/version", "#1 SMP PREEMPT_DYNAMIC Debian 6.1.0-1 (2026-01-01)\n");
    set("proc/sys/kernel/osrelease", "6.1.0-amd64\n");
    expectOnly(check(),
               "better   PREEMPT_RT kernel: this one (6.1.0-amd64) may hold a wake-up back for milliseconds",
               "sudo apt install linux-image-rt-amd64");
    set("sys/kernel/realtime", "1\n");
    EXPECT_EQ(lacks(check()), 0) << "a kernel may also say so itself";
}

TEST_F(CheckRealtime, ACoreThatIsNotIsolatedCouldBeBetter) {
    for (const char* others : {"", "0-2", "1", "0,2", "13,30-33"}) {
        set("sys/devices/system/cpu/isolated", std::string(others) + "\n");
        expectOnly(check(), "better   a core of its own: other threads run on core 3 too",
                   "add 'isolcpus=3 nohz_full=3 rcu_nocbs=3' to GRUB_CMDLINE_LINUX");
    }
    for (const char* with_it : {"3", "1,3", "0,2-5"}) {
        set("sys/devices/system/cpu/isolated", std::string(with_it) + "\n");
        EXPECT_EQ(lacks(check()), 0) << with_it;
    }
}

TEST_F(CheckRealtime, ASavingGovernorCouldBeBetter) {
    set(kCpu + "cpufreq/scaling_governor", "powersave\n");
    expectOnly(check(),
               "better   clock frequency: the governor 'powersave' slows the core down between ticks",
               "echo performance | sudo tee /sys/devices/system/cpu/cpu*/cpufreq/scaling_governor");
}

TEST_F(CheckRealtime, DeepSleepCouldBeBetter) {
    set(kCpu + "cpuidle/state1/disable", "0\n");
    expectOnly(check(), "better   sleep states: core 3 may sleep so deeply that it takes 400 us to wake up",
               "add 'intel_idle.max_cstate=1 processor.max_cstate=1' to GRUB_CMDLINE_LINUX");
}

TEST_F(CheckRealtime, SwapCouldBeBetter) {
    set("proc/meminfo", "SwapTotal:       2097148 kB\n");
    expectOnly(check(), "better   swap: what is not locked may be written to disk", "sudo swapoff -a");
}

TEST_F(CheckRealtime, ASecondThreadOnTheCoreCouldBeBetter) {
    set(kCpu + "topology/thread_siblings_list", "1,3\n");
    expectOnly(check(), "better   second thread of the core: threads 1,3 share its caches and units",
               "leave the other one idle (isolcpus=1,3), or switch SMT off");
}

TEST_F(CheckRealtime, AVirtualMachineCouldBeBetter) {
    set("proc/cpuinfo", "flags\t\t: fpu sse2 hypervisor avx2\n");
    expectOnly(check(),
               "better   a real machine: this is a virtual one: its host takes the core away when it likes",
               "no command helps; train on hardware");
}

TEST_F(CheckRealtime, WrongUseIsRefused) {
    const std::vector<std::vector<std::string>> wrong{
        {"--core", "9"},        {"--core", "last"}, {"--cores", "3"}, {"--core"},
        {"--root", "/no/such"}, {"--root"},         {"--root", ""}};
    for (const auto& arguments : wrong) {
        const Finished finished = check(arguments);
        EXPECT_EQ(finished.exit_code, 2) << arguments[0];
        EXPECT_EQ(finished.err.rfind("check-realtime: ", 0), 0u) << finished.err;
        EXPECT_EQ(std::count(finished.err.begin(), finished.err.end(), '\n'), 1) << finished.err;
    }
    EXPECT_NE(check({"--root"}).err.find("--root needs a folder"), std::string::npos);
    EXPECT_NE(check({"--core", "9"}).err.find("this PC has no core 9"), std::string::npos);
}

TEST_F(CheckRealtime, LooksAtThisMachineWithoutARoot) {
    const Finished finished = test::run({test::sourceDir() + "/deploy/check-realtime"});
    EXPECT_TRUE(finished.exit_code == 0 || finished.exit_code == 1) << finished.err;
    EXPECT_NE(finished.out.find("to improve."), std::string::npos) << finished.out;
    EXPECT_EQ(finished.err, "");
}

}  // namespace
}  // namespace bonemill
