#include "device_daemon/hands/pointer/pointer_device.h"

#include <spdlog/spdlog.h>
#include <time.h>

#include <chrono>
#include <utility>

#include "common/rt/clock.h"

namespace bonemill {
namespace {

constexpr std::chrono::milliseconds kStopDelay{50};  // how late the thread may notice that it shall end
constexpr size_t kMaxWishesAtOnce = 256;             // more are a flood of foreign sessions
constexpr uint64_t kMaxNamedWishes = 4;              // malformed ones in the log
// So often the log says at once who holds, and so often beyond that: hostile viewers must not fill it.
constexpr int64_t kNamedAtOnce = 100, kNameEveryNs = kNsPerSecond;

}  // namespace

PointerDevice::PointerDevice(const PointerConfig& config)
    : config_(config),
      X_DW_(config.X_WD.inverse()),
      epoch_(config.epoch),
      handle_(config.X_DT_start),
      participant_(config.domain),
      reader_(participant_),
      wait_set_(participant_) {
    wait_set_.add([this] { return reader_.handle(); });
    listener_ = std::thread([this] { listen(); });
}

PointerDevice::~PointerDevice() {
    should_stop_ = true;
    listener_.join();
}

DeviceCapabilities PointerDevice::capabilities() const noexcept {
    return handleCapabilities(DeviceKind::kPointer, "mouse in the viewer");
}

bool PointerDevice::read(double elapsed, DeviceReading& reading) noexcept {
    follow(elapsed);
    handle_.advance(elapsed, wrench_hand_D_);
    reading = readingOf(handle_, wrench_hand_D_, buttons_);
    reading.placements = placements_;
    if (is_held_) reading.status |= kStatusEnabled;
    return true;
}

void PointerDevice::write(const DeviceOrder& order) noexcept {
    wrench_hand_D_ = feltWrench(order);
}

void PointerDevice::place(const Pose& X_DT) noexcept {
    handle_.place(X_DT);
    ++placements_;
}

void PointerDevice::follow(double elapsed) noexcept {
    const uint32_t attempts = attempts_.load(std::memory_order_relaxed);
    if (std::exchange(seen_attempts_, attempts) != attempts) place(config_.X_DT_start);
    HeldWish wish;
    uint32_t version = seen_version_;
    age_ += elapsed;
    if (newest_.tryRead(wish, &version) && version != seen_version_) {
        seen_version_ = version;
        if (!wish.is_held) return letGo();
        age_ = 0;
        is_held_ = true;
        buttons_ = wish.buttons;
        const auto& [w, x, y, z] = wish.q_DT;
        const Pose X_DT{Eigen::Vector3d(wish.p_DT.data()), Eigen::Quaterniond(w, x, y, z)};
        const bool is_sudden = std::exchange(seen_placements_, wish.placements) != wish.placements;
        is_sudden ? place(X_DT) : handle_.want(X_DT);
    }
    if (age_ > kButtonSilence) buttons_ = 0;
    if (is_held_ && age_ > kHoldSilence) letGo();
}

void PointerDevice::letGo() noexcept {
    is_held_ = false;
    buttons_ = 0;
    handle_.letGo();
}

void PointerDevice::listen() {
    while (!should_stop_) {
        if (wait_set_.wait(kStopDelay)) takeWishes();
    }
}

void PointerDevice::takeWishes() {
    reader_.take(kMaxWishesAtOnce, [this](const dds::HandPointerSample& sample, const dds::SampleInfo& info) {
        if (!info.has_data || sample.session != config_.session) return;
        const auto wish = parseHandWish(dds::payloadOf(sample), sample.sender);
        if (!wish) {
            if (++malformed_ <= kMaxNamedWishes)
                spdlog::warn("dropped a malformed wish of viewer {}", sample.sender);
            return;
        }
        const uint64_t epoch = epoch_.load(std::memory_order_relaxed);
        if (wish->is_holding && epoch != 0 && wish->epoch != epoch) return;
        const int64_t now_ns = monotonicNowNs();
        const auto before = holder_.holder(now_ns);
        if (!holder_.take(*wish, now_ns)) return;
        nameChange(before, holder_.holder(now_ns), now_ns);
        publish(*wish);
    });
}

void PointerDevice::nameChange(const std::optional<uint64_t>& before, const std::optional<uint64_t>& after,
                               int64_t now_ns) {
    if (before == after || named_changes_ >= kNamedAtOnce + (now_ns - start_ns_) / kNameEveryNs) return;
    ++named_changes_;
    if (after)
        spdlog::info("viewer {} holds the tool", *after);
    else
        spdlog::info("viewer {} lets the tool go", *before);
}

// A wish that is lost between thread and loop loses no placement: the loop compares counts.
void PointerDevice::publish(const HandWish& wish) noexcept {
    const bool is_placed = wish.is_holding && wish.placements != 0 &&
                           (wish.sender != placed_by_ || wish.placements != placed_as_);
    if (is_placed) {
        placed_by_ = wish.sender;
        placed_as_ = wish.placements;
        ++wished_placements_;
    }
    const Pose X_DT = config_.hand_space.poseAtHand(X_DW_ * wish.X_WT);
    const Eigen::Vector3d& p_DT = X_DT.position;
    const Eigen::Quaterniond& q = X_DT.rotation;
    newest_.write({.p_DT = {p_DT.x(), p_DT.y(), p_DT.z()},
                   .q_DT = {q.w(), q.x(), q.y(), q.z()},
                   .buttons = wish.buttons,
                   .is_held = wish.is_holding,
                   .placements = wished_placements_});
}

}  // namespace bonemill
