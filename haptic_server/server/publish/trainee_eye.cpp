#include "haptic_server/server/publish/trainee_eye.h"

#include <google/protobuf/stubs/logging.h>

#include <cmath>
#include <numbers>

#include "common/base/make_room.h"

namespace bonemill {
namespace {

constexpr size_t kLongestAnnouncement = 4096;  // many times what any needs
constexpr double kFarthestEye = 1e3;           // m
constexpr double kUnitSlack = 1e-3;

std::optional<SeenEye> eyeIn(const topics::Viewer& viewer) {
    const topics::Eye& eye = viewer.eye();
    if (eye.p_wc_m_size() != 3 || eye.q_wc_size() != 4) return std::nullopt;
    const auto& q = eye.q_wc();
    SeenEye seen{{Eigen::Vector3d(eye.p_wc_m().data()), Eigen::Quaterniond(q[0], q[1], q[2], q[3])},
                 eye.field_of_view_rad(),
                 viewer.sender()};
    if (!seen.X_WC.isFinite() || seen.X_WC.position.norm() > kFarthestEye ||
        !(std::abs(seen.X_WC.rotation.norm() - 1) < kUnitSlack) ||
        !(seen.field_of_view > 0 && seen.field_of_view < std::numbers::pi))
        return std::nullopt;
    seen.X_WC.rotation.normalize();
    return seen;
}

bool isUsable(const topics::Viewer& viewer, uint64_t sender) {
    return sender != 0 && viewer.sender() == sender && topics::Viewer::Role_IsValid(viewer.role()) &&
           (!viewer.has_eye() || eyeIn(viewer));
}

}  // namespace

bool SeenEye::operator==(const SeenEye& other) const {
    return X_WC.position == other.X_WC.position && X_WC.rotation.coeffs() == other.X_WC.rotation.coeffs() &&
           field_of_view == other.field_of_view && sender == other.sender;
}

bool TraineeEye::hear(std::span<const uint8_t> payload, uint64_t sender, uint64_t participant,
                      std::optional<topics::Viewer::Role> proven, Clock::time_point now) {
    const google::protobuf::LogSilencer silencer;  // a hostile peer must not fill the log
    topics::Viewer viewer;
    if (payload.size() > kLongestAnnouncement ||
        !viewer.ParseFromArray(payload.data(), int(payload.size())) || !isUsable(viewer, sender))
        return false;
    const topics::Viewer::Role role = proven.value_or(viewer.role());
    const bool is_named = viewer.is_trainee() && role == topics::Viewer::INSTRUCTOR;
    if (!viewer.has_eye() || (role != topics::Viewer::OPERATOR && !is_named)) return true;  // only looks on
    const auto known = operators_.find(sender);
    if (known == operators_.end())
        makeRoomFor(
            participant, operators_, {kMaxViewers, kMaxOfParticipant},
            [](const auto& entry) { return entry.second.participant; },
            [](const auto& entry) { return entry.second.at; });
    else if (known->second.participant != participant)
        return true;  // until the other one falls silent
    operators_[sender] = {*eyeIn(viewer), viewer.is_trainee(), participant, now};
    return true;
}

std::optional<SeenEye> TraineeEye::takeChanged(Clock::time_point now) {
    std::erase_if(operators_, [now](const auto& entry) { return now - entry.second.at > kTimeout; });
    const auto is_named = [](const auto& entry) { return entry.second.is_named; };
    const auto same = operators_.find(named_);
    if (same == operators_.end() || !same->second.is_named) {  // the first one that was named keeps it
        const auto named = std::ranges::find_if(operators_, is_named);
        named_ = named == operators_.end() ? 0 : named->first;
    }
    const auto trainee = named_ != 0              ? operators_.find(named_)
                         : operators_.size() == 1 ? operators_.begin()
                                                  : operators_.end();
    if (trainee == operators_.end() || trainee->second.eye == taken_) return std::nullopt;
    return taken_ = trainee->second.eye;
}

}  // namespace bonemill
