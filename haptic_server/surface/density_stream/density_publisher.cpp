#include "haptic_server/surface/density_stream/density_publisher.h"

#include <cmath>
#include <map>

#include "common/rt/clock.h"

namespace bonemill {
namespace {

constexpr size_t kMaxWishes = 256;         // taken per round
constexpr size_t kMaxWishesOfWriter = 16;  // of them, read: 3200 per second
constexpr int64_t kLongestRound_ns = 2 * kNsPerMillisecond;
constexpr size_t kMinCharge = 1024;  // bytes: a small brick costs time, too

uint16_t stepsOf(const DensityScale& scale) {
    const double values = scale.value_at_65535 - scale.value_at_0;
    return values >= 1 && values <= 65535 ? uint16_t(std::lround(values)) : uint16_t(65535);
}

}  // namespace

topics::DensityGrid densityGridOf(const DensitySource& source, const DensityScale& scale) {
    topics::DensityGrid grid;
    for (int axis = 0; axis < 3; ++axis) {
        grid.add_voxels(uint32_t(source.geometry().dims[axis]));
        grid.add_spacing_m(source.geometry().spacing[axis]);
        grid.add_origin_m(0);
    }
    grid.set_brick_edge(DensitySource::kBrickVoxels);
    grid.set_value_at_0(scale.value_at_0);
    grid.set_value_at_65535(scale.value_at_65535);
    grid.set_iso_value(scale.iso_value);
    grid.set_air(source.airBits());
    return grid;
}

DensityPublisher::DensityPublisher(const dds::Participant& participant, uint32_t session, uint64_t epoch,
                                   const DensitySource& source, const DensityScale& scale)
    : session_(session), stream_(source, epoch, stepsOf(scale)), writer_(participant), reader_(participant) {}

void DensityPublisher::takeWishes(int64_t now_ns) {
    std::map<uint64_t, size_t> taken;  // by writer
    reader_.take(kMaxWishes, [&](const dds::DensityWishSample& sample, const dds::SampleInfo& info) {
        if (!info.has_data || sample.session != session_ || ++taken[info.writer] > kMaxWishesOfWriter) return;
        stream_.receive(sample.sender, reader_.participantOf(info.writer), dds::payloadOf(sample), now_ns);
    });
}

size_t DensityPublisher::round(int64_t now_ns, int64_t most_bytes) {
    takeWishes(now_ns);
    if (most_bytes <= 0 || !stream_.isWished(now_ns) || writer_.matchedReaders() == 0) return 0;
    size_t charged = 0;
    stream_.round(now_ns, [&](uint32_t brick, const std::string& payload) {
        dds::DensityBrickSample sample{};
        sample.session = session_;
        sample.brick = brick;
        dds::setPayload(sample, payload);
        written_bricks_ += writer_.write(sample);
        charged += std::max(payload.size(), kMinCharge);
        return int64_t(charged) < most_bytes && monotonicNowNs() - now_ns < kLongestRound_ns;
    });
    return charged;
}

}  // namespace bonemill
