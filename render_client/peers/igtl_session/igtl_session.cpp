#include "render_client/peers/igtl_session/igtl_session.h"

#include <spdlog/spdlog.h>

#include <cstdio>
#include <utility>

#include "common/base/user_error.h"
#include "common/commands/role_rules.h"
#include "common/igtl_wire/igtl_messages.h"
#include "common/secrets/secrets.h"
#include "common/text/foreign_text.h"
#include "render_client/link/subscribe/command_words.h"
#include "render_client/peers/igtl_session/patient_axes.h"

namespace bonemill::igtl {
namespace {

constexpr std::chrono::milliseconds kStep{5}, kIdleStep{50};
constexpr std::chrono::milliseconds kPosePeriod{15};  // 60 Hz come from the server
constexpr std::chrono::seconds kStatusPeriod{1}, kAnnouncePeriod{1};
constexpr double kBytesPerMbit = 125'000;
constexpr int kMostOpenOrders = 8;
constexpr const char* kSecretDevice = "bonemill_secret";

int64_t unixNow() {
    return std::chrono::nanoseconds(std::chrono::system_clock::now().time_since_epoch()).count();
}

Blob blobOf(std::string frame) {
    return std::make_shared<const std::string>(std::move(frame));
}

Blob poseBlob(const char* device, const topics::ToolState& state,
              const google::protobuf::RepeatedField<double>& p_m,
              const google::protobuf::RepeatedField<double>& q) {
    return blobOf(transformFrame(device, state.stamp_ns(), rasOf(poseOf(p_m, q))));
}

// Force (N) and torque (N·m) on the hand, about the tool point, with axes RAS.
Blob wrenchBlob(const topics::ToolState& state) {
    const Eigen::Vector3d force = rasOf({state.force_n(0), state.force_n(1), state.force_n(2)});
    const Eigen::Vector3d torque = rasOf({state.torque_nm(0), state.torque_nm(1), state.torque_nm(2)});
    const std::array<double, 6> numbers{force.x(), force.y(), force.z(), torque.x(), torque.y(), torque.z()};
    return blobOf(numbersFrame("bonemill_wrench", state.stamp_ns(), numbers));
}

}  // namespace

IgtlSession::IgtlSession(const IgtlOptions& options)
    : options_(options),
      subscriber_(options.subscriber),
      port_(options.address, options.port,
            {kWantedString, {"GET_IMAGE", 0, 0}, {"GET_POLYDATA", 0, 0}, {"GET_STATUS", 0, 0}},
            options.bounds, *this) {}

void IgtlSession::step() {
    port_.step(guests_.empty() ? kIdleStep : kStep);
    const auto now = Clock::now();
    bone_.apply(subscriber_.poll());
    if (subscriber_.sceneInfo()) bone_.place(*subscriber_.sceneInfo());
    if (now >= pose_due_) showTool();
    showBone(now);
    showImage(now);
    showNews(now);
    showOutcomes();
    announce(now);
}

void IgtlSession::came(Line& line) {
    IgtlGuest guest(line, options_.bone_mbit_per_s * kBytesPerMbit, Clock::now());
    guest.sayText(statusNow());
    guests_.emplace(line.number(), guest);
}

void IgtlSession::gone(const Line& line) {
    guests_.erase(line.number());
}

void IgtlSession::heard(Line& line, const Frame& frame) {
    const auto guest = guests_.find(line.number());
    if (guest == guests_.end()) return;
    if (frame.type == "STRING") hearText(guest->second, frame);
    if (frame.type == "GET_IMAGE") askForImage(guest->second);
    if (frame.type == "GET_POLYDATA") guest->second.forgetBone();
    if (frame.type == "GET_STATUS") guest->second.sayText(statusNow());
}

void IgtlSession::hearText(IgtlGuest& guest, const Frame& frame) {
    const auto text = stringOf(frame.body);
    if (!text) return guest.line().refuse("it sent a STRING that is none");
    frame.device == kSecretDevice ? hearSecret(guest, *text) : order(guest, *text);
}

// Nobody has a second guess on one line.
void IgtlSession::hearSecret(IgtlGuest& guest, const std::string& secret) {
    if (options_.secret.empty()) return answer(guest, "refused: nobody orders here");
    if (!guest.line().isOfThisPc())
        return answer(guest, "refused: a secret from another PC can be read on its way; come by ssh -L");
    if (!isSameSecret(secret, options_.secret)) return guest.line().refuse("it said a wrong secret");
    guest.allowOrders();
    answer(guest, "orders are taken");
}

std::string IgtlSession::whyNot(const IgtlGuest& guest, const std::string& text) const {
    if (!guest.mayOrder()) return "say the secret first, as STRING " + std::string(kSecretDevice);
    if (!subscriber_.hasServer() || !subscriber_.sceneInfo() || !subscriber_.status())
        return "there is no session";
    if (guest.open_orders >= kMostOpenOrders) return "too many orders at once";
    return commandProblem(text);
}

void IgtlSession::order(IgtlGuest& guest, const std::string& text) {
    if (const std::string problem = whyNot(guest, text); !problem.empty())
        return answer(guest, text + ": refused: " + problem);
    try {
        const topics::Command command = commandOf(text, *subscriber_.sceneInfo(), *subscriber_.status());
        if (const std::string why_not = whyNotOrder(options_.subscriber.role, command.action_case());
            !why_not.empty())
            return answer(guest, text + ": refused: " + why_not);
        whose_order_[subscriber_.sendCommand(command)] = guest.line().number();
        ++guest.open_orders;
    } catch (const UserError& error) {
        answer(guest, text + ": refused: " + error.what());
    }
}

void IgtlSession::answer(IgtlGuest& guest, const std::string& text) {
    guest.sayText(blobOf(stringFrame("bonemill_answer", unixNow(), printableLine(text, kLongestString))));
}

void IgtlSession::showOutcomes() {
    for (const CommandOutcome& outcome : subscriber_.takeOutcomes()) {
        const auto whose = whose_order_.extract(outcome.sequence);
        const auto guest = whose ? guests_.find(whose.mapped()) : guests_.end();
        if (guest == guests_.end()) continue;
        --guest->second.open_orders;
        answer(guest->second, outcomeText(outcome));
    }
}

void IgtlSession::sayAll(const Blob& frame, void (IgtlGuest::*say)(const Blob&)) {
    for (auto& [number, guest] : guests_) (guest.*say)(frame);
}

void IgtlSession::showTool() {
    const auto& state = subscriber_.toolState();
    if (guests_.empty() || !state) return;
    if (std::exchange(tick_, state->tick()) == state->tick()) return;
    pose_due_ = Clock::now() + kPosePeriod;
    sayAll(poseBlob("bonemill_tool", *state, state->p_wt_m(), state->q_wt()), &IgtlGuest::sayPose);
    sayAll(poseBlob("bonemill_hand", *state, state->p_wt_device_m(), state->q_wt_device()),
           &IgtlGuest::sayPose);
    sayAll(wrenchBlob(*state), &IgtlGuest::sayPose);
}

void IgtlSession::showBone(Clock::time_point now) {
    if (!subscriber_.sceneInfo()) return;
    for (auto& [number, guest] : guests_) guest.showPiece(bone_, unixNow(), now);
}

void IgtlSession::askForImage(IgtlGuest& guest) {
    const std::string problem = image_.ask(subscriber_, Clock::now());
    guest.wants_image = problem.empty();
    if (!problem.empty())
        guest.sayText(blobOf(statusFrame("bonemill_volume", unixNow(), StatusCode::kNotFound, problem)));
}

void IgtlSession::showImage(Clock::time_point now) {
    const bool was_asked = image_.isAsked();
    const Blob frame = image_.follow(subscriber_, now);
    if (image_.isAsked() || !was_asked) return;
    for (auto& [number, guest] : guests_) {
        if (!std::exchange(guest.wants_image, false)) continue;
        guest.sayText(frame ? frame
                            : blobOf(statusFrame("bonemill_volume", unixNow(), StatusCode::kUnknownError,
                                                 "the scan did not come in time")));
    }
}

Blob IgtlSession::statusNow() const {
    const auto& status = subscriber_.status();
    if (!subscriber_.hasServer() || !status)
        return blobOf(statusFrame("bonemill", unixNow(), StatusCode::kNotReady, "no session"));
    char figures[96];
    std::snprintf(figures, sizeof figures, ", %.1f s, %.2f mm3 removed", status->session_s(),
                  status->removed_mm3());
    return blobOf(
        statusFrame("bonemill", unixNow(), StatusCode::kOk, printableLine(status->scene()) + figures));
}

void IgtlSession::showNews(Clock::time_point now) {
    for (const std::string& line : news_.take(subscriber_))
        sayAll(blobOf(stringFrame("bonemill_event", unixNow(), printableLine(line, kLongestString))),
               &IgtlGuest::sayText);
    if (now < status_due_ || guests_.empty()) return;
    status_due_ = now + kStatusPeriod;
    sayAll(statusNow(), &IgtlGuest::sayText);
}

void IgtlSession::announce(Clock::time_point now) {
    if (now < announce_due_) return;
    announce_due_ = now + kAnnouncePeriod;
    subscriber_.announce(0, std::nullopt);
}

}  // namespace bonemill::igtl
