// Knows what the trainee sees: of all viewers that tell of their eye it believes one, that which was named as
// the trainee's (render_client --trainee), or else the only operator's. Frames are W and the camera's C.
//
// It is bounded, whatever senders are invented, as the viewers' own list of each other is. For one thread.
#pragma once

#include <chrono>
#include <cstdint>
#include <map>
#include <optional>
#include <span>

#include "common/geometry/pose.h"
#include "proto/topics.pb.h"

namespace bonemill {

struct SeenEye {
    Pose X_WC;                 // x right, y up, z towards the eye
    double field_of_view = 0;  // rad, vertical
    uint64_t sender = 0;       // of the viewer

    bool operator==(const SeenEye& other) const;
};

class TraineeEye {
  public:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::seconds kTimeout{4};  // a viewer tells of itself once per second
    static constexpr size_t kMaxViewers = 256;
    static constexpr size_t kMaxOfParticipant = 64;  // a gateway's guests

    // Takes the payload of a Viewer sample. `participant` is who tells of this viewer, and `proven` the role
    // that its certificate proves, where it has one. Returns false for bytes that make no sense.
    bool hear(std::span<const uint8_t> payload, uint64_t sender, uint64_t participant,
              std::optional<topics::Viewer::Role> proven, Clock::time_point now);

    // Returns what the trainee sees, if that is known and has changed since the last call.
    std::optional<SeenEye> takeChanged(Clock::time_point now);

  private:
    struct Heard {
        SeenEye eye;
        bool is_named = false;
        uint64_t participant = 0;
        Clock::time_point at;
    };
    std::map<uint64_t, Heard> operators_;  // by sender
    uint64_t named_ = 0;                   // sender; 0: none was named
    std::optional<SeenEye> taken_;
};

}  // namespace bonemill
