// Plays device_daemon towards a bridge, and reads what a stand-in library has written down.
//
// Times are real, since bridges have clocks of their own; limits only end a test that hangs.
#pragma once

#include <gtest/gtest.h>

#include <functional>
#include <ios>
#include <string>
#include <vector>

#include "device_daemon/ares/wire/drive_state.h"
#include "device_daemon/ares/wire/host_session.h"
#include "tests/support/process.h"

namespace bonemill::test {

using WrenchValues = std::array<float, 6>;

class BridgeHost {
  public:
    // Waits until the bridge says where it listens. `watchdog_us` is long by default, for builds and machines
    // that are slow.
    explicit BridgeHost(Process& bridge, uint32_t watchdog_us = wire::kLongestWatchdogUs);

    // Commands in every period until the condition holds; false when it never did.
    bool runUntil(const std::function<bool()>& condition);
    void runPeriods(int count);
    // Leads the bridge to "operation enabled", once it is.
    bool engage();
    // What is commanded from now on. Faults are reset as they come, for a busy machine trips watchdogs.
    void want(bool is_wanted, const WrenchValues& wrench = {});

    const wire::PoseState& state() const { return link_.session().state(); }
    const wire::Describe& description() const { return link_.session().description(); }
    wire::DriveState drive() const { return wire::driveStateOf(state().statusword); }
    // Latched or there now.
    uint32_t faults() const { return state().first_fault | state().active_faults; }
    bool hasState() const { return link_.session().hasState(); }

  private:
    void period();

    wire::HostLink<wire::PosePackets> link_;
    bool is_wanted_ = false;
    uint64_t periods_ = 0;
    WrenchValues wrench_{};
};

// The port that a bridge prints in its first line; 0 if it ended before.
uint16_t listeningPort(Process& bridge);

struct RecordedCall {
    std::string name;
    std::vector<double> values;
    double forceNorm() const;
    double torqueNorm() const;
};

// Reads what a stand-in writes while it writes it: each look parses only what is new, so that a host that
// looks in every period is not late for it.
class CallRecord {
  public:
    explicit CallRecord(const std::string& file) : file_(file) {}
    const std::vector<RecordedCall>& calls();

  private:
    std::string file_;
    std::streamoff read_ = 0;  // bytes
    std::vector<RecordedCall> calls_;
};

// The last call of this name; nothing in it if there is none.
RecordedCall lastOf(const std::vector<RecordedCall>& record, const std::string& name);
std::vector<RecordedCall> without(const std::vector<RecordedCall>& record, const std::string& name);
int countOf(const std::vector<RecordedCall>& record, const std::string& name);

// Checks what holds in every run, whatever the library does: all wrenches are finite, none is above the
// limits, none but zero comes while the motors are off. `enable` names the call that switches them, `force`
// the wrench's.
void expectHarmless(const std::vector<RecordedCall>& record, double max_force, double max_torque = 0);

// Starts a bridge with a stand-in library under the words of STAND_IN.
std::vector<std::string> bridgeCommand(const std::string& program, const std::string& library,
                                       const std::string& words, const std::string& record_file,
                                       const std::vector<std::string>& more = {});

// A bridge and what its stand-in writes down.
class BridgeTest : public testing::Test {
  protected:
    const std::vector<RecordedCall>& record() { return record_.calls(); }
    RecordedCall lastForce() { return lastOf(record(), "force"); }
    // After what the test has done the bridge waits for the arm's calibration.
    void expectNotEnabled(const BridgeHost& host) {
        EXPECT_FALSE(host.state().inputs & wire::kInputHomed);
        EXPECT_NE(host.drive(), wire::DriveState::kOperationEnabled);
        EXPECT_EQ(countOf(record(), "enable"), 0);
    }

    TemporaryFolder folder_;
    const std::string record_file_ = folder_ / "record";

  private:
    CallRecord record_{record_file_};
};

}  // namespace bonemill::test
