// The mouse in a viewer's window holds the tool: device_daemon --device pointer.
//
// Viewers publish on the topic HandPointer where they want the tool (docs/howto/mouse.md). A thread of
// this class reads them and hands the newest wish of who holds to the loop through a seqlock; the loop moves
// a VirtualHandle, which feels the wrench of haptic_server. Wishes are the tool's, in W; the handle is in D,
// with X_WD of the scene, and moves as its HandSpace says.
//
// A wish with a new number of placements puts the handle there without a way there, and so does the beginning
// of an attempt, where the scene begins; the server's tool goes along, if there is no bone.
//
// What a silent viewer leaves behind: its buttons count for kButtonSilence, and after kHoldSilence the hand
// lets go and the handle stays where it is. Ages count in the loop's own time. The functions of HapticDevice
// are RT-safe and belong to the loop's thread; the rest is for the owner's.
#pragma once

#include <array>
#include <atomic>
#include <optional>
#include <thread>

#include "common/dds/endpoint.h"
#include "common/geometry/hand_space.h"
#include "common/rt/clock.h"
#include "common/rt/seqlock.h"
#include "device_daemon/hands/pointer/hand_wish.h"
#include "device_daemon/hands/virtual_handle/virtual_handle.h"

namespace bonemill {

struct PointerConfig {
    uint32_t domain = 0;   // DDS domain of the viewers
    uint32_t session = 1;  // that of server and viewers
    uint64_t epoch = 0;    // of the server's run: followRun()
    Pose X_WD = {};
    HandSpace hand_space = {};
    Pose X_DT_start = {};  // the handle rests there until a viewer holds it
};

class PointerDevice final : public HapticDevice {
  public:
    static constexpr double kButtonSilence = 0.2;  // s
    static constexpr double kHoldSilence = 1;      // s

    // Throws UserError when the DDS domain cannot be joined.
    explicit PointerDevice(const PointerConfig& config);
    ~PointerDevice() override;

    DeviceCapabilities capabilities() const noexcept override;
    bool read(double elapsed, DeviceReading& reading) noexcept override;
    void write(const DeviceOrder& order) noexcept override;
    void beginAttempt() noexcept override { attempts_.fetch_add(1, std::memory_order_relaxed); }

    // Wishes of viewers that still show another run do not count; with 0 all do.
    void followRun(uint64_t epoch) noexcept override { epoch_.store(epoch, std::memory_order_relaxed); }

    // Counts the messages that made no sense; for any thread.
    uint64_t malformedWishes() const noexcept { return malformed_; }

  private:
    // From the reading thread to the loop.
    struct HeldWish {
        std::array<double, 3> p_DT;
        std::array<double, 4> q_DT;  // w, x, y, z
        uint32_t buttons;
        uint32_t is_held;
        uint32_t placements;  // counts the wishes for a sudden place, whoever's
    };

    void listen();
    void takeWishes();
    // Logs who holds the tool, if that is another one now.
    void nameChange(const std::optional<uint64_t>& before, const std::optional<uint64_t>& after,
                    int64_t now_ns);
    void publish(const HandWish& wish) noexcept;
    void follow(double elapsed) noexcept;
    void place(const Pose& X_DT) noexcept;
    void letGo() noexcept;

    const PointerConfig config_;
    const Pose X_DW_;
    Seqlock<HeldWish> newest_;
    std::atomic<uint64_t> malformed_ = 0;
    std::atomic<uint64_t> epoch_;
    std::atomic<uint32_t> attempts_ = 0;  // that have begun

    // These belong to the loop.
    VirtualHandle handle_;
    Wrench wrench_hand_D_;
    uint32_t seen_version_ = Seqlock<HeldWish>::kNeverWritten;
    double age_ = 0;  // s since a wish came
    bool is_held_ = false;
    uint32_t buttons_ = 0;
    uint32_t placements_ = 0;
    uint32_t seen_placements_ = 0, seen_attempts_ = 0;

    // These belong to the reading thread.
    PointerHolder holder_;
    uint64_t placed_by_ = 0;  // the viewer that wished for a sudden place last
    uint32_t placed_as_ = 0;  // its number of that
    uint32_t wished_placements_ = 0;
    const int64_t start_ns_ = monotonicNowNs();
    int64_t named_changes_ = 0;
    dds::Participant participant_;
    dds::Reader<dds::HandPointerSample> reader_;
    dds::WaitSet wait_set_;
    std::atomic<bool> should_stop_ = false;
    std::thread listener_;
};

}  // namespace bonemill
