// Measures what the ways to the hand add on one PC: from a controller's state to the command that answers it
// over the UDP wire (a bridge's is the same wire), and from a sample to its wrench through the memory that
// device_daemon and haptic_server share, beside a bare exchange of datagrams between two threads, in turns in
// the same run. It asserts nothing. What is added is the difference to the bare exchange; the rest is the
// machine's.
#include <unistd.h>

#include <CLI/CLI.hpp>
#include <array>
#include <atomic>
#include <cmath>
#include <cstdio>
#include <cstring>

#include "common/cli/command_line.h"
#include "common/ipc/device_link.h"
#include "common/process/run_program.h"
#include "common/rt/clock.h"
#include "common/rt/periodic_timer.h"
#include "common/rt/realtime.h"
#include "device_daemon/ares/driver/udp_device.h"
#include "device_daemon/ares/wire/controller_session.h"
#include "tests/bench/bench_output.h"

namespace bonemill::bench {
namespace {

struct LinkRun {
    LatencyHistogram round_trip;  // from before a packet is sent until its answer was taken
    uint64_t exchanges = 0, unanswered = 0;
    uint64_t watchdog_trips = 0;
};

constexpr int64_t kWaitNs = 100 * kNsPerMillisecond;  // of an answering side, for the end

class Threads {
  public:
    explicit Threads(int answering_core, int asking_core)
        : answering_core_(answering_core), asking_core_(asking_core) {}

    // Lets one answer for as long as the other asks.
    void run(const std::function<void(const std::atomic<bool>&)>& answer, const std::function<void()>& ask) {
        std::atomic<bool> is_over = false;
        RealtimeThread answering(
            {.request = {.core = answering_core_}, .what = "the answer"}, [&] { answer(is_over); },
            [&](const RealtimeReport& r) { note(r); });
        RealtimeThread asking({.request = {.core = asking_core_}, .what = "the question"}, ask,
                              [](const RealtimeReport&) {});
        asking.join();
        is_over = true;
    }

  private:
    void note(const RealtimeReport& report) {
        if (has_told_) return;
        has_told_ = true;
        for (const std::string& missing : report.missing) std::printf("not granted: %s\n", missing.c_str());
    }
    int answering_core_, asking_core_;
    bool has_told_ = false;
};

// Sends questions by the clock, and counts what comes of them. `ask` sends one, waits for its answer until
// the deadline, and says whether it came.
template <class Ask>
void askByTheClock(int64_t period_ns, int exchanges, LinkRun& run, const Ask& ask) {
    PeriodicTimer timer(period_ns, monotonicNowNs());
    for (int i = 0; i < exchanges; ++i) {
        const int64_t due_ns = timer.waitNext();
        const int64_t sent_ns = monotonicNowNs();
        ++run.exchanges;
        if (ask(sent_ns, due_ns + period_ns))
            run.round_trip.record(monotonicNowNs() - sent_ns);
        else
            ++run.unanswered;
    }
}

// Two threads throw datagrams of the packets' sizes to and fro.
void pingPong(Threads& threads, int64_t period_ns, int exchanges, LinkRun& run) {
    wire::UdpSocket asking, answering;
    using Buffer = std::array<std::byte, wire::kMaxPacket>;
    const auto answer = [&](const std::atomic<bool>& is_over) {
        while (!is_over) {
            Buffer buffer;
            wire::Endpoint from;
            answering.waitUntil(monotonicNowNs() + kWaitNs);
            while (!answering.receive(buffer, from).empty()) {
                answering.send(std::span(buffer).first(sizeof(wire::JointCommand)), from);
            }
        }
    };
    threads.run(answer, [&] {
        Buffer question{}, buffer;
        wire::Endpoint from;
        int number = 0;
        askByTheClock(period_ns, exchanges, run, [&](int64_t, int64_t deadline_ns) {
            ++number;
            std::memcpy(question.data(), &number, sizeof(number));
            asking.send(std::span(question).first(sizeof(wire::JointState)), answering.local());
            while (asking.waitUntil(deadline_ns)) {
                if (asking.receive(buffer, from).size() == sizeof(wire::JointCommand) &&
                    std::memcmp(buffer.data(), &number, sizeof(number)) == 0)
                    return true;
            }
            return false;
        });
    });
}

wire::Describe description(double rate_hz) {
    wire::Describe d{};
    d.max_actuator_force = 50;
    d.stroke = 0.15;
    d.watchdog_us = wire::kDefaultWatchdogUs;
    d.rate_hz = uint32_t(std::lround(rate_hz));
    return d;
}

void answerNext(UdpJointDevice& host) {
    JointReading reading;
    if (!host.waitForSample(monotonicNowNs() + kWaitNs) || !host.readJoints(0, reading)) return;
    host.applyForces({.forces = reading.q, .is_wanted = true, .is_engaged = true});
}

// The controller sends its states; the host is the device that device_daemon uses.
void overTheWire(Threads& threads, int64_t period_ns, double rate_hz, int exchanges, LinkRun& run) {
    wire::ControllerLink<wire::JointPackets> controller(description(rate_hz), {wire::kLoopback, 0});
    UdpJointDevice host({.controller = controller.local()});
    const auto answer = [&](const std::atomic<bool>& is_over) {
        while (!is_over) answerNext(host);
    };
    threads.run(answer, [&] {
        controller.waitForCommand(monotonicNowNs() + kNsPerSecond);
        askByTheClock(period_ns, exchanges, run, [&](int64_t now_ns, int64_t deadline_ns) {
            wire::JointState state{};
            state.inputs = wire::kInputChainClosed | wire::kInputHomed;
            controller.poll(now_ns);
            controller.session().step(0, true, now_ns);
            if (!controller.send(state, now_ns)) return false;
            while (monotonicNowNs() < deadline_ns) {
                if (controller.waitForCommand(deadline_ns) &&
                    controller.session().newestCommand().reflected_sequence == state.header.sequence)
                    return true;
            }
            return false;
        });
        run.watchdog_trips += controller.session().watchdogTrips();
    });
}

// The daemon writes its samples; the server answers each as it comes.
void throughSharedMemory(Threads& threads, int64_t period_ns, int exchanges, LinkRun& run) {
    const auto session = uint32_t(getpid());
    DeviceLink server = DeviceLink::create(session, LinkSide::kServer);
    DeviceLink daemon = DeviceLink::create(session, LinkSide::kDaemon);
    const auto answer = [&](const std::atomic<bool>& is_over) {
        while (!is_over) {
            DeviceSample sample;
            if (!server.waitForSample(monotonicNowNs() + kWaitNs) || !server.readSample(sample)) continue;
            WrenchCommand command{};
            command.answers_sequence = sample.sequence;
            server.writeCommand(command);
        }
    };
    threads.run(answer, [&] {
        askByTheClock(period_ns, exchanges, run, [&](int64_t now_ns, int64_t deadline_ns) {
            DeviceSample sample{};
            sample.stamp_ns = now_ns;
            sample.q_DT[0] = 1;
            const uint64_t sequence = daemon.writeSample(sample);
            WrenchCommand command{};
            while (monotonicNowNs() < deadline_ns) {
                if (daemon.waitForCommand(deadline_ns) && daemon.readCommand(command) &&
                    command.answers_sequence == sequence)
                    return true;
            }
            return false;
        });
    });
}

struct Options {
    double rate_hz = 1000, seconds = 20;
    int rounds = 5;
    int answering_core = -1, asking_core = -1;
    std::string json;
};

nlohmann::json toJson(const LinkRun& run) {
    return {{"exchanges", run.exchanges},
            {"unanswered", run.unanswered},
            {"watchdog_trips", run.watchdog_trips},
            {"round_trip_us", microseconds(run.round_trip)}};
}

void measure(const Options& o) {
    const int64_t period_ns = std::llround(double(kNsPerSecond) / o.rate_hz);
    const int exchanges = std::max(1, int(o.rate_hz * o.seconds / o.rounds));
    Threads threads(o.answering_core, o.asking_core);
    LinkRun bare, joints, memory;
    for (int round = 0; round < o.rounds; ++round) {
        pingPong(threads, period_ns, exchanges, bare);
        overTheWire(threads, period_ns, o.rate_hz, exchanges, joints);
        throughSharedMemory(threads, period_ns, exchanges, memory);
    }
    Table table({"us", "mean", "p50", "p99", "p99.9", "max"});
    table.add({"bare UDP, there and back"}, bare.round_trip);
    table.add({"joints: state to command"}, joints.round_trip);
    table.add({"shared memory: sample to wrench"}, memory.round_trip);
    table.print();
    std::printf("of %llu each, not answered within the period: bare %llu, joints %llu, memory %llu\n",
                (unsigned long long)bare.exchanges, (unsigned long long)bare.unanswered,
                (unsigned long long)joints.unanswered, (unsigned long long)memory.unanswered);
    writeJson(o.json, {{"rate_hz", o.rate_hz},
                       {"bare", toJson(bare)},
                       {"joints", toJson(joints)},
                       {"memory", toJson(memory)}});
}

}  // namespace
}  // namespace bonemill::bench

int main(int argc, char** argv) {
    using namespace bonemill;
    bench::Options o;
    CLI::App app("what wire and shared memory add on one PC, beside a bare exchange of datagrams");
    app.add_option("--rate-hz", o.rate_hz)->check(CLI::Range(500.0, 8000.0))->capture_default_str();
    app.add_option("--seconds", o.seconds, "of each of the three")
        ->check(CLI::Range(0.1, 3600.0))
        ->capture_default_str();
    app.add_option("--rounds", o.rounds, "in which they take turns")
        ->check(CLI::Range(1, 1000))
        ->capture_default_str();
    app.add_option("--host-core", o.answering_core, "core of the host's thread (-1: any)")
        ->capture_default_str();
    app.add_option("--controller-core", o.asking_core, "core of the controller's thread (-1: any)")
        ->capture_default_str();
    bench::addJsonOption(app, o.json);
    return runProgram([&] {
        if (parseCommandLine(app, argc, argv, "link_bench")) bench::measure(o);
        return 0;
    });
}
