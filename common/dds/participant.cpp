#include "common/dds/participant.h"

#include <dds/dds.h>
#include <dds/ddsrt/log.h>
#include <dlfcn.h>
#include <fcntl.h>
#include <spdlog/spdlog.h>
#include <sys/socket.h>

#include <algorithm>
#include <cerrno>
#include <cstring>
#include <filesystem>
#include <map>
#include <mutex>
#include <set>
#include <string_view>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/dds/network.h"
#include "common/dds/topic_traits.h"
#include "common/log/log.h"
#include "common/process/run_program.h"
#include "common/rt/clock.h"

#ifdef __SANITIZE_THREAD__
// Debian's Cyclone is not instrumented and synchronises with atomics of its own, which ThreadSanitizer cannot
// see: its inner calls are not judged, our code around it is.
extern "C" const char* __tsan_default_suppressions();
extern "C" const char* __tsan_default_suppressions() {
    return "called_from_lib:libddsc.so\n";
}
#endif

namespace bonemill::dds {
namespace {

constexpr char kLoopback[] = "lo";

std::set<int> openDescriptors() {
    std::set<int> descriptors;
    std::error_code error;
    for (std::filesystem::directory_iterator entry("/proc/self/fd", error), end; !error && entry != end;
         entry.increment(error))
        descriptors.insert(std::stoi(entry->path().filename().string()));
    // The folder's own is closed again: its number may be the next socket's.
    std::erase_if(descriptors, [](int descriptor) { return fcntl(descriptor, F_GETFD) < 0; });
    return descriptors;
}

int optionOf(int descriptor, int option) {
    int value = -1;
    socklen_t size = sizeof value;
    return getsockopt(descriptor, SOL_SOCKET, option, &value, &size) == 0 ? value : -1;
}

bool isUdp(int descriptor) {
    return optionOf(descriptor, SO_DOMAIN) == AF_INET && optionOf(descriptor, SO_TYPE) == SOCK_DGRAM;
}

// Keeps Cyclone's sockets to this PC: it binds those that receive to all addresses, whatever interface it is
// told to use, and would hear every host on the LAN. Ties all UDP sockets to the loopback that were opened
// since these. Throws UserError where the kernel does not let it.
void tieToLoopback(const std::set<int>& before) {
    for (const int descriptor : openDescriptors()) {
        if (before.contains(descriptor) || !isUdp(descriptor)) continue;
        if (setsockopt(descriptor, SOL_SOCKET, SO_BINDTODEVICE, kLoopback, sizeof kLoopback) != 0)
            throw UserError(std::string("profile one-pc: a socket cannot be tied to the loopback: ") +
                            std::strerror(errno));
    }
}

// Cyclone's own messages go to the program's log, but not more of them than are read: ten at once, and over a
// long time one a minute.
void sayWithinLimit(void*, const dds_log_data_t* data) {
    static std::mutex mutex;
    static LogLimit limit(10, 60 * kNsPerSecond);
    const std::lock_guard lock(mutex);
    const int64_t left_out = limit.ask(monotonicNowNs());
    if (left_out < 0) return;
    std::string_view text(data->message, data->size);
    text = text.substr(0, std::min(text.find_last_not_of("\r\n") + 1, text.size()));
    if (left_out > 0) spdlog::warn("Cyclone DDS: {} messages were left out", left_out);
    spdlog::warn("Cyclone DDS: {}", text);
}

}  // namespace

Entity::~Entity() {
    if (handle_ > 0) dds_delete(handle_);
}

Entity requireEntity(int32_t result, const std::string& what) {
    if (result < 0) {
        throw UserError("cannot create " + what + " (" + dds_strretcode(result) +
                        "): check the network interfaces and the profile (docs/howto/network.md)");
    }
    return Entity(result);
}

// This is the configured domain, shared by every participant of this process: Cyclone creates each domain
// id only once.
class Domain {
  public:
    Domain(uint32_t id, const std::string& configuration) {
        if (configuration.empty()) return;  // Cyclone reads CYCLONEDDS_URI itself
        const std::set<int> before = openDescriptors();
        entity_ =
            requireEntity(dds_create_domain(id, configuration.c_str()), "DDS domain " + std::to_string(id));
        if (isOnePc(configuration)) tieToLoopback(before);
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

// Within this process a foreigners' domain has its number plus this one; on the network it has its own.
constexpr uint32_t kFirstForeign = 1000;

// `configuration`: none is the one that was chosen.
std::shared_ptr<Domain> acquireDomain(uint32_t id, const std::optional<std::string>& configuration = {}) {
    static std::map<uint32_t, std::weak_ptr<Domain>> domains;
    const std::lock_guard lock(domains_mutex);
    std::shared_ptr<Domain> domain = domains[id].lock();
    if (!domain) {
        requireMemory(kDomainBytes, "the network");
        dds_set_log_sink(sayWithinLimit, nullptr);
        domain = std::make_shared<Domain>(id, configuration          ? *configuration
                                              : chosen_configuration ? *chosen_configuration
                                                                     : networkConfiguration({}));
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
    Qos qos = makeQos();
    for (const auto& [name, value] : security.properties(pluginFolder(libraryFolder())))
        dds_qset_prop(qos.get(), name.c_str(), value.c_str());
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

void requireDomain(uint32_t domain) {
    if (domain <= kMaxDomain) return;
    throw UserError("DDS domain " + std::to_string(domain) + " does not exist: choose 0 to " +
                    std::to_string(kMaxDomain));
}

}  // namespace

Participant::Participant(uint32_t domain) {
    requireDomain(domain);
    domain_ = acquireDomain(domain);
    const std::optional<SecurityFolder> security = chosenSecurity();
    entity_ = requireEntity(
        dds_create_participant(domain, security ? secured(*security).get() : nullptr, nullptr),
        "participant in DDS domain " + std::to_string(domain) + (security ? ", with --secure" : ""));
    if (security) requireInForce(*security, entity_.handle());
}

Participant::Participant(std::shared_ptr<Domain> domain, Entity entity) noexcept
    : domain_(std::move(domain)), entity_(std::move(entity)) {}

Participant Participant::ofForeigners(uint32_t domain, const std::string& configuration) {
    requireDomain(domain);
    const std::string own_number = "<CycloneDDS><Domain Id=\"any\"><Discovery><ExternalDomainId>" +
                                   std::to_string(domain) +
                                   "</ExternalDomainId></Discovery></Domain></CycloneDDS>";
    const uint32_t id = kFirstForeign + domain;
    std::shared_ptr<Domain> joined =
        acquireDomain(id, configuration + (configuration.empty() ? "" : ",") + own_number);
    Entity entity = requireEntity(dds_create_participant(id, nullptr, nullptr),
                                  "participant in DDS domain " + std::to_string(domain));
    return {std::move(joined), std::move(entity)};
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
