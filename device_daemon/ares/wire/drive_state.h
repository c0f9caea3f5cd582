// This is the state machine of CiA 402 as far as a controller of ours needs it: a host asks with
// controlwords, and faults are latched. Force flows in kOperationEnabled only.
//
// It is RT-safe, for one thread.
#pragma once

#include <cstdint>

namespace bonemill::wire {

enum class DriveState : uint8_t {
    kNotReady,
    kSwitchOnDisabled,
    kReady,
    kSwitchedOn,
    kOperationEnabled,
    kQuickStop,
    kFault,
};

// The state's bits of a statusword.
uint16_t statuswordOf(DriveState state) noexcept;
// The state that a statusword says, whatever its other bits; a fault reaction counts as kFault.
DriveState driveStateOf(uint16_t statusword) noexcept;

// Returns the controlword that leads a host to its wish: one step nearer to kOperationEnabled, or off.
uint16_t controlwordTowards(bool is_wanted, DriveState state) noexcept;

class DriveStateMachine {
  public:
    DriveState state() const noexcept { return state_; }
    // With the bits "voltage enabled" (while powered) and "remote".
    uint16_t statusword() const noexcept;

    // Obeys a controlword. `may_enable`: nothing speaks against force.
    void command(uint16_t controlword, bool may_enable) noexcept;
    // Says in each period which faults there are now (Fault bits); any one leads to kFault, and stays latched
    // until a host resets it. The first call ends kNotReady.
    void report(uint32_t faults, bool is_powered) noexcept;
    // Leaves for kSwitchOnDisabled unless there is a fault: the host that asked for more has gone.
    void disable() noexcept;

    // What led to kFault; 0 elsewhere.
    uint32_t firstFault() const noexcept { return first_fault_; }
    uint32_t activeFaults() const noexcept { return active_faults_; }

  private:
    DriveState state_ = DriveState::kNotReady;
    uint16_t last_controlword_ = 0;
    bool is_powered_ = false;
    uint32_t first_fault_ = 0;
    uint32_t active_faults_ = 0;
};

}  // namespace bonemill::wire
