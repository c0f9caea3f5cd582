// Says when a viewer has to tell of what it sees: 20 times per second at most, and only when that changed. It
// is a plain value, for any one thread.
#pragma once

#include <Eigen/Geometry>
#include <chrono>
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

}  // namespace bonemill
