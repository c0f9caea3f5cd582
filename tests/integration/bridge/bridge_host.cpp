#include "tests/integration/bridge/bridge_host.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>
#include <sstream>

#include "common/rt/clock.h"
#include "tests/support/places.h"

namespace bonemill::test {
namespace {

constexpr int64_t kPeriodNs = kNsPerMillisecond;
constexpr int64_t kLimitNs = 60 * kNsPerSecond;

double normOf(const std::vector<double>& values, size_t first) {
    double sum = 0;
    for (size_t i = first; i < std::min(values.size(), first + 3); ++i) sum += values[i] * values[i];
    return std::sqrt(sum);
}

RecordedCall callOf(const std::string& line) {
    std::istringstream words(line);
    RecordedCall call;
    words >> call.name;
    for (std::string word; words >> word;) call.values.push_back(std::stod(word));
    return call;
}

}  // namespace

uint16_t listeningPort(Process& bridge) {
    const std::string begin = "listening on 127.0.0.1:";
    std::string out;
    waitFor([&] {
        out = bridge.outSoFar();
        return out.find('\n') != std::string::npos || !bridge.isRunning();
    });
    return out.starts_with(begin) ? uint16_t(std::stoi(out.substr(begin.size()))) : 0;
}

BridgeHost::BridgeHost(Process& bridge, uint32_t watchdog_us)
    : link_({{wire::kLoopback, listeningPort(bridge)}, watchdog_us, wire::randomSeed()},
            {wire::kLoopback, 0}) {}

void BridgeHost::want(bool is_wanted, const WrenchValues& wrench) {
    is_wanted_ = is_wanted;
    wrench_ = wrench;
}

void BridgeHost::period() {
    link_.waitForState(monotonicNowNs() + kPeriodNs);
    wire::PoseCommand command{};
    // A reset counts when its bit rises, and only once the fault has gone: it is tried again and again.
    const bool resets_now = drive() == wire::DriveState::kFault && ++periods_ % 2 == 0;
    command.controlword =
        resets_now ? uint16_t(wire::kControlFaultReset) : wire::controlwordTowards(is_wanted_, drive());
    command.mode = wire::kModeTorque;
    std::copy(wrench_.begin(), wrench_.end(), command.wrench);
    link_.send(command, monotonicNowNs());
}

void BridgeHost::runPeriods(int count) {
    for (int i = 0; i < count; ++i) period();
}

bool BridgeHost::runUntil(const std::function<bool()>& condition) {
    const int64_t deadline_ns = monotonicNowNs() + kLimitNs;
    while (!condition()) {
        if (monotonicNowNs() > deadline_ns) return false;
        period();
    }
    return true;
}

bool BridgeHost::engage() {
    want(true);
    return runUntil([this] { return drive() == wire::DriveState::kOperationEnabled; });
}

double RecordedCall::forceNorm() const {
    return normOf(values, 0);
}

double RecordedCall::torqueNorm() const {
    return normOf(values, 3);
}

const std::vector<RecordedCall>& CallRecord::calls() {
    std::ifstream file(file_);
    file.seekg(read_);
    // A line without an end is still being written.
    for (std::string line; std::getline(file, line) && !file.eof(); read_ += std::streamoff(line.size()) + 1)
        calls_.push_back(callOf(line));
    return calls_;
}

RecordedCall lastOf(const std::vector<RecordedCall>& record, const std::string& name) {
    const auto found = std::find_if(record.rbegin(), record.rend(),
                                    [&](const RecordedCall& call) { return call.name == name; });
    return found == record.rend() ? RecordedCall{} : *found;
}

std::vector<RecordedCall> without(const std::vector<RecordedCall>& record, const std::string& name) {
    std::vector<RecordedCall> others = record;
    std::erase_if(others, [&](const RecordedCall& call) { return call.name == name; });
    return others;
}

int countOf(const std::vector<RecordedCall>& record, const std::string& name) {
    return int(std::count_if(record.begin(), record.end(),
                             [&](const RecordedCall& call) { return call.name == name; }));
}

void expectHarmless(const std::vector<RecordedCall>& record, double max_force, double max_torque) {
    constexpr double kRounding = 1e-6;
    bool is_on = false;
    for (const RecordedCall& call : record) {
        if (call.name == "enable") is_on = call.values.at(0) != 0;
        if (call.name != "force") continue;
        for (const double value : call.values) ASSERT_TRUE(std::isfinite(value));
        ASSERT_LE(call.forceNorm(), (is_on ? max_force : 0) + kRounding);
        ASSERT_LE(call.torqueNorm(), (is_on ? max_torque : 0) + kRounding);
    }
}

std::vector<std::string> bridgeCommand(const std::string& program, const std::string& library,
                                       const std::string& words, const std::string& record_file,
                                       const std::vector<std::string>& more) {
    std::vector<std::string> command{"/usr/bin/env", "STAND_IN=" + words, "STAND_IN_RECORD=" + record_file,
                                     binDir() + "/" + program};
    if (!library.empty()) command.insert(command.end(), {"--library", helperDir() + "/" + library});
    command.insert(command.end(), more.begin(), more.end());
    return command;
}

}  // namespace bonemill::test
