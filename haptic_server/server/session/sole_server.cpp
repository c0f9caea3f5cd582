#include "haptic_server/server/session/sole_server.h"

#include <spdlog/spdlog.h>

#include <chrono>

#include "common/base/user_error.h"
#include "haptic_server/server/publish/other_server.h"

namespace bonemill {
namespace {

using namespace std::chrono_literals;

constexpr auto kLookForOthers = 300ms, kLookForSecuredOthers = 1500ms;  // who must prove itself takes longer

}  // namespace

PublisherOptions soleServerOf(uint32_t domain, uint32_t session, const dds::NetworkOptions& network) {
    const auto patience = network.secure.empty() ? kLookForOthers : kLookForSecuredOthers;
    if (const auto other = findOtherServer(dds::Participant(domain), session, patience))
        throw UserError(refusalText(*other, domain, session));
    if (dds::isOpenToOthers(network))
        spdlog::warn(
            "anyone in this network can watch this session and command it; --secure closes it "
            "(docs/lab/security.md)");
    return {.domain = domain, .session = session, .epoch = 0, .secure = network.secure};
}

}  // namespace bonemill
