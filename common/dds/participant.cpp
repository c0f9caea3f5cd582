#include "common/dds/participant.h"

#include <dds/dds.h>

#include <map>
#include <mutex>
#include <optional>

#include "common/dds/log_sink.h"
#include "common/dds/network.h"
#include "common/process_limits.h"
#include "common/user_error.h"

#ifdef __SANITIZE_THREAD__
// Debian's Cyclone is not instrumented and synchronises with atomics of its own, which ThreadSanitizer cannot
// see: its inner calls are not judged, our code around it is.
extern "C" const char* __tsan_default_suppressions();
extern "C" const char* __tsan_default_suppressions() {
    return "called_from_lib:libddsc.so\n";
}
#endif

namespace bonemill::dds {

// This is the configured domain, shared by every participant of this process: Cyclone creates each domain
// id only once.
class Domain {
  public:
    Domain(uint32_t id, const std::string& configuration) {
        if (configuration.empty()) return;  // Cyclone reads CYCLONEDDS_URI itself
        entity_ =
            requireEntity(dds_create_domain(id, configuration.c_str()), "DDS domain " + std::to_string(id));
    }

  private:
    Entity entity_;
};

namespace {

// Cyclone aborts the program where it cannot start its threads, with stacks of 8 MiB each.
constexpr size_t kDomainBytes = size_t(160) << 20;

// The mutex spans creation and deletion: a domain being deleted must be gone before it is created again.
std::mutex domains_mutex;
std::optional<std::string> chosen_configuration;  // guarded by domains_mutex

std::shared_ptr<Domain> acquireDomain(uint32_t id) {
    static std::map<uint32_t, std::weak_ptr<Domain>> domains;
    const std::lock_guard lock(domains_mutex);
    std::shared_ptr<Domain> domain = domains[id].lock();
    if (!domain) {
        requireMemory(kDomainBytes, "the network");
        limitCycloneLog();
        domain = std::make_shared<Domain>(
            id, chosen_configuration ? *chosen_configuration : networkConfiguration({}));
        domains[id] = domain;
    }
    return domain;
}

}  // namespace

Participant::Participant(uint32_t domain) {
    if (domain > kMaxDomain) {
        throw UserError("DDS domain " + std::to_string(domain) + " does not exist: choose 0 to " +
                        std::to_string(kMaxDomain));
    }
    domain_ = acquireDomain(domain);
    entity_ = requireEntity(dds_create_participant(domain, nullptr, nullptr),
                            "participant in DDS domain " + std::to_string(domain));
}

Participant::Participant(Participant&&) noexcept = default;

void Participant::setConfiguration(std::string configuration) {
    const std::lock_guard lock(domains_mutex);
    chosen_configuration = std::move(configuration);
}

Participant::~Participant() {
    entity_ = Entity();
    const std::lock_guard lock(domains_mutex);
    domain_.reset();
}

}  // namespace bonemill::dds
