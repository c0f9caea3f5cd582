// A SpaceMouse as the hand: device_daemon --device spacemouse. It is read through spacenavd, which must run.
//
// The cap moves the tool as it would move in the picture: to the right, up, and pushed away into the picture;
// turned, it turns the tool. Button 0 (left) removes, button 1 adds, and the others held make everything
// slow. Models count differently; a full deflection is kUsualCounts, and more when more has been seen.
//
// The thread rules are those of RateDevice.
#pragma once

#include <string>

#include "device_daemon/hands/input/input_reader.h"
#include "device_daemon/hands/input/rate_device.h"
#include "device_daemon/hands/input/spnav.h"

namespace bonemill {

// The largest count of a device, learnt as it is used.
class FullScale {
  public:
    static constexpr float kUsualCounts = 350;
    static constexpr float kMaxCounts = 3500;  // more than any model gives: nonsense

    // Returns -1 to 1; 0 for what is not believed.
    float shareOf(int32_t counts) noexcept;

  private:
    float full_counts_ = kUsualCounts;
};

class SpaceMouseDevice final : public RateDevice, private InputSource {
  public:
    // The socket is spacenavd's; by default spnavSocketPath(). Nothing need be there yet.
    SpaceMouseDevice(const RateConfig& config, const Pose& X_DT_start, std::string socket_path = {});

  private:
    int open() override;
    bool take(std::span<const std::byte> bytes) override;
    bool rest() override;
    void lost() override;
    void tell();

    const std::string path_;

    // These belong to the reading thread.
    int socket_ = -1;
    int64_t opened_ns_ = 0;
    bool is_settled_ = false;  // which protocol it speaks is known
    bool was_there_ = false;
    SpnavStream stream_;
    FullScale full_scale_;

    InputReader reader_;
};

}  // namespace bonemill
