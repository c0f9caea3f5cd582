#include "device_daemon/ares/emulator/faulty_wire.h"

#include <algorithm>
#include <cmath>
#include <limits>

#include "common/base/units.h"

namespace bonemill {
namespace {

constexpr size_t kMaxUnderWay = 1024;
constexpr double kOvertakenPeriods = 1.5;

}  // namespace

FaultyWire::FaultyWire(const std::vector<FaultSpec>& faults, uint32_t seed, int64_t period_ns)
    : random_(seed), period_ns_(period_ns), under_way_(kMaxUnderWay) {
    std::copy_if(faults.begin(), faults.end(), std::back_inserter(faults_),
                 [](const FaultSpec& fault) { return fault.isOfPackets(); });
}

void FaultyWire::put(std::span<const std::byte> bytes, const wire::Endpoint& other, double engaged_s,
                     int64_t now_ns) noexcept {
    Datagram changed;
    changed.size = std::min(bytes.size(), changed.bytes.size());
    std::copy_n(bytes.begin(), changed.size, changed.bytes.begin());
    int64_t due_ns = now_ns;
    int copies = 1;
    for (const FaultSpec& fault : faults_) {
        if (!happens(fault, engaged_s)) continue;
        if (fault.kind == FaultKind::kDrop || fault.kind == FaultKind::kUnplug) copies = 0;
        if (fault.kind == FaultKind::kDuplicate) copies *= 2;
        if (fault.kind == FaultKind::kDelay) due_ns += std::llround(fault.delay * double(kNsPerSecond));
        if (fault.kind == FaultKind::kReorder) due_ns += std::llround(kOvertakenPeriods * double(period_ns_));
        if (fault.kind == FaultKind::kCorrupt && changed.size > 0) {
            const size_t bit = random_() % (8 * changed.size);
            changed.bytes[bit / 8] ^= std::byte(1u << bit % 8);
        }
    }
    for (int i = 0; i < copies; ++i) enter(changed.content(), other, due_ns);
}

bool FaultyWire::happens(const FaultSpec& fault, double engaged_s) noexcept {
    constexpr double kRange = double(std::mt19937::max()) + 1;
    return fault.isActive(engaged_s) && double(random_()) < fault.chance * kRange;
}

void FaultyWire::enter(std::span<const std::byte> bytes, const wire::Endpoint& other,
                       int64_t due_ns) noexcept {
    if (count_ == under_way_.size()) return;
    Datagram& place = under_way_[count_++];
    place.due_ns = due_ns;
    place.other = other;
    place.size = bytes.size();
    std::copy(bytes.begin(), bytes.end(), place.bytes.begin());
}

// Of those that are due together the one that entered first.
FaultyWire::Datagram* FaultyWire::firstDue() noexcept {
    const auto end = under_way_.begin() + std::ptrdiff_t(count_);
    const auto first = std::min_element(
        under_way_.begin(), end, [](const Datagram& a, const Datagram& b) { return a.due_ns < b.due_ns; });
    return first == end ? nullptr : &*first;
}

bool FaultyWire::take(Datagram& datagram, int64_t now_ns) noexcept {
    Datagram* first = firstDue();
    if (!first || first->due_ns > now_ns) return false;
    datagram = *first;
    std::move(first + 1, under_way_.data() + count_, first);
    --count_;
    return true;
}

int64_t FaultyWire::nextDueNs() const noexcept {
    int64_t due_ns = std::numeric_limits<int64_t>::max();
    for (size_t i = 0; i < count_; ++i) due_ns = std::min(due_ns, under_way_[i].due_ns);
    return due_ns;
}

}  // namespace bonemill
