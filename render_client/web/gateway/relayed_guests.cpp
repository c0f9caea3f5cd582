#include "render_client/web/gateway/relayed_guests.h"

#include <utility>

namespace bonemill::gateway {
namespace {

constexpr size_t kMaxArrivals = 256;  // that the gateway has not taken yet

}  // namespace

RelayedGuests::RelayedGuests(const RelayPlace& relay, std::function<void()> wake)
    : wake_(std::move(wake)), dialer_(relay, [this](Descriptor line, const PeerAddress& guest) {
          {
              const std::lock_guard lock(mutex_);
              if (arrivals_.size() >= kMaxArrivals) return;
              arrivals_.push_back({std::move(line), {textOf(guest), true}});
          }
          wake_();
      }) {}

std::vector<RelayedGuests::Arrival> RelayedGuests::take() {
    const std::lock_guard lock(mutex_);
    return std::exchange(arrivals_, {});
}

}  // namespace bonemill::gateway
