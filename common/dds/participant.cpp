#include "common/dds/participant.h"

#include <dds/dds.h>
#include <dlfcn.h>

#include <algorithm>
#include <map>
#include <mutex>
#include <optional>

#include "common/base/user_error.h"
#include "common/dds/log_sink.h"
#include "common/dds/loopback_only.h"
#include "common/dds/network.h"
#include "common/dds/qos.h"
#include "common/process/process_limits.h"

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
        const LoopbackOnly loopback_only;
        entity_ =
            requireEntity(dds_create_domain(id, configuration.c_str()), "DDS domain " + std::to_string(id));
        if (isOnePc(configuration)) loopback_only.tie();
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
std::optional<SecurityFolder> chosen_security;    // guarded by domains_mutex

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

std::optional<SecurityFolder> chosenSecurity() {
    const std::lock_guard lock(domains_mutex);
    return chosen_security;
}

// The plugins lie beside the library that this program has loaded.
std::filesystem::path libraryFolder() {
    Dl_info info{};
    if (dladdr(reinterpret_cast<void*>(&dds_create_participant), &info) == 0) return "/usr/lib";
    std::error_code error;
    return std::filesystem::canonical(info.dli_fname, error).parent_path();
}

// What a participant says of itself goes before what CYCLONEDDS_URI says of security.
Qos secured(const SecurityFolder& security) {
    Qos qos;
    for (const auto& [name, value] : security.properties(pluginFolder(libraryFolder())))
        qos.property(name, value);
    return qos;
}

// An authenticated participant's GUID says whose it is; one that was made without security has any other.
void requireInForce(const SecurityFolder& security, dds_entity_t participant) {
    dds_guid_t guid{};
    const GuidPrefix& prefix = security.self().prefix;
    if (dds_get_guid(participant, &guid) == DDS_RETCODE_OK &&
        std::equal(prefix.begin(), prefix.end(), std::begin(guid.v)))
        return;
    throw UserError("--secure " + security.folder().string() +
                    ": this Cyclone DDS joins without security; is it Debian's, and not built without it?");
}

}  // namespace

Participant::Participant(uint32_t domain) {
    if (domain > kMaxDomain) {
        throw UserError("DDS domain " + std::to_string(domain) + " does not exist: choose 0 to " +
                        std::to_string(kMaxDomain));
    }
    domain_ = acquireDomain(domain);
    const std::optional<SecurityFolder> security = chosenSecurity();
    entity_ = requireEntity(
        dds_create_participant(domain, security ? secured(*security).get() : nullptr, nullptr),
        "participant in DDS domain " + std::to_string(domain) + (security ? ", with --secure" : ""));
    if (security) requireInForce(*security, entity_.handle());
}

Participant::Participant(Participant&&) noexcept = default;

void Participant::setConfiguration(std::string configuration) {
    const std::lock_guard lock(domains_mutex);
    chosen_configuration = std::move(configuration);
}

void Participant::setSecurity(std::optional<SecurityFolder> security) {
    const std::lock_guard lock(domains_mutex);
    chosen_security = std::move(security);
}

Participant::~Participant() {
    entity_ = Entity();
    const std::lock_guard lock(domains_mutex);
    domain_.reset();
}

}  // namespace bonemill::dds
