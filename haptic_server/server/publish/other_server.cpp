#include "haptic_server/server/publish/other_server.h"

#include <spdlog/fmt/chrono.h>
#include <spdlog/fmt/fmt.h>
#include <spdlog/spdlog.h>

#include <algorithm>
#include <ctime>
#include <thread>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/dds/endpoint.h"
#include "proto/topics.pb.h"

namespace bonemill {
namespace {

using namespace std::chrono_literals;

constexpr auto kLookForOthers = 300ms, kLookForSecuredOthers = 1500ms;  // who must prove itself takes longer
constexpr size_t kLongestStatus = 1 << 20;

}  // namespace

PublisherOptions soleServerOf(uint32_t domain, uint32_t session, const dds::NetworkOptions& network) {
    const auto patience = network.secure.empty() ? kLookForOthers : kLookForSecuredOthers;
    if (const auto other = findOtherServer(dds::Participant(domain), session, patience))
        throw UserError(refusalText(*other, domain, session));
    if (dds::isOpenToOthers(network))
        spdlog::warn(
            "anyone in this network can watch this session and command it; --secure closes it "
            "(docs/howto/security.md)");
    return {.domain = domain, .session = session, .epoch = 0, .secure = network.secure};
}

std::string printableName(std::string name) {
    constexpr size_t kLongest = 80;
    name.resize(std::min(name.size(), kLongest));
    std::ranges::replace_if(
        name, [](char c) { return c < ' ' || c > '~'; }, '?');
    return name;
}

std::optional<OtherServer> findOtherServer(const dds::Participant& participant, uint32_t session,
                                           std::chrono::milliseconds patience) {
    using Clock = std::chrono::steady_clock;
    constexpr std::chrono::milliseconds kLookEvery{5};
    dds::Reader<dds::StatusSample> reader(participant);
    std::optional<OtherServer> found;
    for (const auto end = Clock::now() + patience; !found && Clock::now() < end;) {
        std::this_thread::sleep_for(kLookEvery);
        reader.take(dds::AnyReader::kBatch,
                    [&](const dds::StatusSample& sample, const dds::SampleInfo& info) {
                        const auto payload = dds::payloadOf(sample);
                        topics::Status status;
                        if (!info.has_data || sample.session != session || payload.size() > kLongestStatus ||
                            !status.ParseFromArray(payload.data(), int(payload.size())))
                            return;
                        found = OtherServer{printableName(status.scene()), status.epoch()};
                    });
    }
    return found;
}

std::string refusalText(const OtherServer& other, uint32_t domain, uint32_t session) {
    const auto start = std::time_t(other.epoch_ns / uint64_t(kNsPerSecond));
    return fmt::format(
        "session {} of domain {} has a server already, with the scene '{}' since {:%Y-%m-%d %H:%M:%S}: end "
        "that one "
        "(render_client --session {} --command shutdown), or choose another --session",
        session, domain, other.scene, fmt::localtime(start), session);
}

}  // namespace bonemill
