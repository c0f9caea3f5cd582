// A node of ROS 2 that counts what it hears of /bonemill for some seconds, and says it in one line:
//
//   ros_listener cyclone|fast DOMAIN SECONDS
//
// messages of measured_cp and measured_cf, how many of the ticks between their first and last are not among
// them, in percent, the rate, and the nodes of the bone. measured_cp and measured_cf are read reliably, as
// rviz2 and rosbag2 do.
#include <unistd.h>

#include <algorithm>
#include <chrono>
#include <cmath>
#include <cstdio>
#include <cstdlib>
#include <functional>
#include <set>
#include <string>
#include <vector>

#include "common/process/run_program.h"
#include "common/ros/ros_domain.h"
#include "common/ros/ros_endpoint.h"
#include "tests/integration/ros2/fast_peer.h"

namespace {

using namespace bonemill;
using Clock = std::chrono::steady_clock;

// Stamps are when ticks began, a millisecond apart.
struct Heard {
    std::set<int64_t> stamps;

    double rate() const {
        return stamps.size() < 2
                   ? 0
                   : double(stamps.size() - 1) * 1e9 / double(*stamps.rbegin() - *stamps.begin());
    }
    // A gap of 2.9 ms lacks two ticks.
    double lossPercent() const {
        double missing = 0;
        int64_t before = stamps.empty() ? 0 : *stamps.begin();
        for (const int64_t stamp : stamps) {
            missing += std::max(0.0, std::round(double(stamp - before) / 1e6) - 1);
            before = stamp;
        }
        return 100 * missing / (missing + double(stamps.size()));
    }
};

struct Counts {
    Heard cp, cf;
    std::set<int32_t> bone;
};

void print(const char* name, const Heard& heard) {
    std::printf("%s: %zu messages, %.3f %% missing, %.1f Hz; ", name, heard.stamps.size(),
                heard.lossPercent(), heard.rate());
}

void listen(double seconds, const std::function<void()>& take) {
    const auto end = Clock::now() + std::chrono::duration<double>(seconds);
    while (Clock::now() < end) {
        usleep(2000);
        take();
    }
}

int64_t stampOf(const ros2::Header& header) {
    return int64_t(header.stamp.sec) * 1'000'000'000 + header.stamp.nanosec;
}

void listenByCyclone(uint32_t domain, double seconds, Counts& counts) {
    const dds::Participant participant = ros2::joinRos({domain});
    const auto reliable = ros2::Delivery::kStream;
    ros2::Reader<ros2::PoseStamped> cp(participant, "bonemill/measured_cp", reliable);
    ros2::Reader<ros2::WrenchStamped> cf(participant, "bonemill/measured_cf", reliable);
    ros2::Reader<ros2::MarkerArray> bone(participant, "bonemill/bone", reliable);
    listen(seconds, [&] {
        cp.take([&](const ros2::PoseStamped& m, const dds::SampleInfo&) {
            counts.cp.stamps.insert(stampOf(m.header));
        });
        cf.take([&](const ros2::WrenchStamped& m, const dds::SampleInfo&) {
            counts.cf.stamps.insert(stampOf(m.header));
        });
        bone.take([&](const ros2::MarkerArray& m, const dds::SampleInfo&) {
            for (uint32_t i = 0; i < m.markers._length; ++i)
                if (m.markers._buffer[i].action == 0) counts.bone.insert(m.markers._buffer[i].id);
        });
    });
}

void takeStamps(test::FastNode::Reader& reader, Heard& heard) {
    for (const auto& bytes : reader.take()) {
        test::CdrBytes cdr(bytes);
        const int64_t seconds = cdr.i32();
        heard.stamps.insert(seconds * 1'000'000'000 + cdr.u32());
    }
}

void listenByFast(uint32_t domain, double seconds, Counts& counts) {
    test::FastNode node(domain, ros2::isLocalhostOnly());
    const std::string geometry = "geometry_msgs::msg::dds_::";
    auto cp = node.read("rt/bonemill/measured_cp", geometry + "PoseStamped_", {.depth = 1000});
    auto cf = node.read("rt/bonemill/measured_cf", geometry + "WrenchStamped_", {.depth = 1000});
    auto bone = node.read("rt/bonemill/bone", "visualization_msgs::msg::dds_::MarkerArray_");
    listen(seconds, [&] {
        takeStamps(cp, counts.cp);
        takeStamps(cf, counts.cf);
        // Of each message the first marker's id is enough to see that the bone comes.
        for (const auto& bytes : bone.take()) {
            test::CdrBytes cdr(bytes);
            cdr.u32(), cdr.i32(), cdr.u32(), cdr.text(), cdr.text();
            counts.bone.insert(cdr.i32());
        }
    });
}

int run(int argc, char** argv) {
    if (argc != 4) return 2;
    Counts counts;
    const bool is_fast = std::string(argv[1]) == "fast";
    (is_fast ? listenByFast : listenByCyclone)(uint32_t(std::atoi(argv[2])), std::atof(argv[3]), counts);
    print("measured_cp", counts.cp);
    print("measured_cf", counts.cf);
    std::printf("bone: %zu nodes\n", counts.bone.size());
    return 0;
}

}  // namespace

int main(int argc, char** argv) {
    return bonemill::runProgram([&] { return run(argc, argv); });
}
