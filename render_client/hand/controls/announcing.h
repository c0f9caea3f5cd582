// What a viewer tells the others of itself, and when. They are plain values, for any one thread.
#pragma once

#include <Eigen/Geometry>
#include <chrono>
#include <deque>
#include <optional>

#include "proto/topics.pb.h"
#include "render_client/look/camera/camera.h"

namespace bonemill {

// W is the world, C the camera's frame.
inline topics::Eye eyeOf(const Camera& camera) {
    topics::Eye eye;
    eye.mutable_p_wc_m()->Assign(camera.eye_W.begin(), camera.eye_W.end());
    const Eigen::Quaterniond q_WC(camera.R_WC);
    for (const double part : {q_WC.w(), q_WC.x(), q_WC.y(), q_WC.z()}) eye.add_q_wc(part);
    eye.set_field_of_view_rad(camera.field_of_view);
    return eye;
}

// Says when a viewer has to tell of what it sees: 20 times per second at most, and only when that changed.
class EyeReporter {
  public:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::milliseconds kPeriod{50};
    static constexpr double kMinMove = 1e-4;      // m
    static constexpr double kMinTurn = 1.745e-3;  // rad: 0.1 degree; also of the angle of view

    bool isDue(Clock::time_point now, const Camera& camera) const {
        return !told_ || (now - told_at_ >= kPeriod && hasMoved(camera));
    }
    void told(Clock::time_point now, const Camera& camera) {
        told_ = camera;
        told_at_ = now;
    }

  private:
    bool hasMoved(const Camera& camera) const {
        const Eigen::AngleAxisd turn(Eigen::Matrix3d(told_->R_WC.transpose() * camera.R_WC));
        return (camera.eye_W - told_->eye_W).norm() > kMinMove || turn.angle() > kMinTurn ||
               std::abs(camera.field_of_view - told_->field_of_view) > kMinTurn;
    }

    std::optional<Camera> told_;
    Clock::time_point told_at_;
};

// Says when a viewer has to tell the others of itself: once per second, 30 times per second while it points,
// and at once when it starts or stops pointing.
class AnnounceClock {
  public:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::nanoseconds kPeriod = std::chrono::seconds(1);
    static constexpr std::chrono::nanoseconds kPointingPeriod = kPeriod / 30;

    // Returns true when it is time now, which then counts as done.
    bool isDue(Clock::time_point now, bool is_pointing) {
        const auto period = is_pointing ? kPointingPeriod : kPeriod;
        if (last_ && is_pointing == was_pointing_ && now - *last_ < period) return false;
        last_ = now;
        was_pointing_ = is_pointing;
        return true;
    }

  private:
    std::optional<Clock::time_point> last_;
    bool was_pointing_ = false;
};

// Counts pictures per second over the last second.
class FrameRate {
  public:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::seconds kWindow{1};

    void countPicture(Clock::time_point now) {
        pictures_.push_back(now);
        // The picture before the window began marks where the first interval starts.
        while (pictures_.size() > 2 && now - pictures_[1] >= kWindow) pictures_.pop_front();
    }
    // It is 0 before the second picture.
    double perSecond() const {
        if (pictures_.size() < 2) return 0;
        const std::chrono::duration<double> span = pictures_.back() - pictures_.front();
        return span.count() > 0 ? double(pictures_.size() - 1) / span.count() : 0;
    }

  private:
    std::deque<Clock::time_point> pictures_;
};

}  // namespace bonemill
