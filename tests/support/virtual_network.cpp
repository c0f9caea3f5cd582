#include "tests/support/virtual_network.h"

#include <arpa/inet.h>
#include <fcntl.h>
#include <sched.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cstring>
#include <sstream>
#include <stdexcept>
#include <thread>
#include <utility>

#include "tests/support/places.h"

namespace bonemill::test {
namespace {

using namespace std::chrono_literals;

constexpr char kIp[] = "/usr/sbin/ip";
constexpr char kSwitch[] = "switch";

std::string lastError(const std::string& what) {
    return what + " (" + std::strerror(errno) + ")";
}

// Runs for example ip("link set lo up"), in this thread's namespace.
void ip(const std::string& words) {
    std::vector<std::string> arguments{kIp};
    std::istringstream stream(words);
    for (std::string word; stream >> word;) arguments.push_back(word);
    const Finished finished = run(arguments);
    if (finished.exit_code != 0) throw std::runtime_error("ip " + words + ": " + finished.err);
}

Descriptor ownNamespace() {
    Descriptor descriptor(open("/proc/self/ns/net", O_RDONLY | O_CLOEXEC));
    if (descriptor.number() < 0) throw std::runtime_error(lastError("/proc/self/ns/net"));
    return descriptor;
}

// Programs started by this process see it so.
std::string pathOf(const Descriptor& descriptor) {
    return "/proc/" + std::to_string(getpid()) + "/fd/" + std::to_string(descriptor.number());
}

// This thread is in another namespace as long as the object lives.
class Inside {
  public:
    explicit Inside(const Descriptor& there) : before_(ownNamespace()) {
        if (setns(there.number(), CLONE_NEWNET) != 0) throw std::runtime_error(lastError("setns"));
    }
    Inside(const Inside&) = delete;
    Inside& operator=(const Inside&) = delete;
    ~Inside() { setns(before_.number(), CLONE_NEWNET); }

  private:
    Descriptor before_;
};

Descriptor newNamespace() {
    const Descriptor before = ownNamespace();
    if (unshare(CLONE_NEWNET) != 0) throw std::runtime_error(lastError("unshare"));
    Descriptor made = ownNamespace();
    setns(before.number(), CLONE_NEWNET);
    return made;
}

// Without root it becomes root of a user namespace.
bool becomeRootOfOwn() {
    const std::string user = std::to_string(geteuid()), group = std::to_string(getegid());
    if (unshare(CLONE_NEWUSER | CLONE_NEWNET) != 0) return false;
    writeFile("/proc/self/setgroups", "deny");
    writeFile("/proc/self/uid_map", "0 " + user + " 1\n");
    writeFile("/proc/self/gid_map", "0 " + group + " 1\n");
    return geteuid() == 0;
}

}  // namespace

Descriptor::Descriptor(Descriptor&& other) noexcept : number_(std::exchange(other.number_, -1)) {}

Descriptor& Descriptor::operator=(Descriptor&& other) noexcept {
    std::swap(number_, other.number_);
    return *this;
}

Descriptor::~Descriptor() {
    if (number_ >= 0) close(number_);
}

std::unique_ptr<Process> Host::start(const std::vector<std::string>& arguments) const {
    const Inside inside(namespace_);
    return std::make_unique<Process>(arguments);
}

Descriptor Host::udpSocket(int port) const {
    const Inside inside(namespace_);
    Descriptor made(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0));
    sockaddr_in address{};
    address.sin_family = AF_INET;
    address.sin_port = htons(uint16_t(port));
    const timeval patience{5, 0};
    if (setsockopt(made.number(), SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience) != 0 ||
        bind(made.number(), reinterpret_cast<const sockaddr*>(&address), sizeof address) != 0)
        throw std::runtime_error(lastError("UDP socket"));
    return made;
}

Host::Traffic Host::traffic() const {
    std::istringstream table(readFile("/proc/self/net/dev"));
    for (std::string line; std::getline(table, line);) {
        std::istringstream words(line);
        std::string name;
        uint64_t into_switch = 0, out_of_switch = 0, other = 0;
        words >> name >> into_switch;
        for (int column = 0; column < 7; ++column) words >> other;
        words >> out_of_switch;
        if (name == port_ + ":") return {into_switch, out_of_switch};
    }
    throw std::runtime_error(port_ + " is not in /proc/self/net/dev");
}

void Host::unplug() const {
    ip("link set " + port_ + " down");
}

void Host::plugIn() const {
    ip("link set " + port_ + " up");
}

std::string VirtualNetwork::enter() {
    if (access(kIp, X_OK) != 0) return "the program ip is missing (package iproute2)";
    if (unshare(CLONE_NEWNET) != 0 && !becomeRootOfOwn())
        return "no network namespaces: neither root nor unprivileged user namespaces "
               "(kernel.unprivileged_userns_clone)";
    if (run({kIp, "link", "add", kSwitch, "type", "bridge", "mcast_snooping", "0"}).exit_code != 0)
        return "this kernel has no network bridge (module bridge)";
    if (run({kIp, "link", "add", "probe0", "type", "veth", "peer", "name", "probe1"}).exit_code != 0)
        return "this kernel has no pairs of interfaces (module veth)";
    ip("link del probe0");
    return "";
}

std::string VirtualNetwork::missingForLines() {
    const bool is_open = Descriptor(open("/dev/net/tun", O_RDWR | O_CLOEXEC)).number() >= 0;
    return is_open ? "" : lastError("/dev/net/tun cannot be opened");
}

VirtualNetwork::VirtualNetwork() {
    ip(std::string("link set ") + kSwitch + " up");
}

Host VirtualNetwork::newHost() {
    Host host;
    host.namespace_ = newNamespace();
    const std::string number = std::to_string(++hosts_);
    host.address_ = "10.77.0." + number;
    host.port_ = "port" + number;
    return host;
}

void VirtualNetwork::setUpInside(const Host& host) const {
    ip("link set " + host.port_ + " master " + kSwitch + " up");
    const Inside inside(host.namespace_);
    ip("link set lo up");
    ip("addr add " + host.address_ + "/24 dev eth0");
    ip("link set eth0 up");
}

Host VirtualNetwork::addHost() {
    Host host = newHost();
    ip("link add " + host.port_ + " type veth peer name eth0 netns " + pathOf(host.namespace_));
    setUpInside(host);
    return host;
}

Host VirtualNetwork::addHost(const LineQuality& line) {
    Host host = newHost();
    host.relay_ = std::make_unique<Process>(
        std::vector<std::string>{test::helperDir() + "/link_relay", host.port_, pathOf(host.namespace_),
                                 "eth0", std::to_string(line.rate_kbit_per_s), std::to_string(line.delay_ms),
                                 std::to_string(line.loss_per_mille), std::to_string(line.queue_kib)});
    for (int i = 0; i < 500 && host.relay_->outSoFar().empty(); ++i) {
        if (!host.relay_->isRunning()) throw std::runtime_error(host.relay_->errSoFar());
        std::this_thread::sleep_for(10ms);
    }
    setUpInside(host);
    return host;
}

}  // namespace bonemill::test
