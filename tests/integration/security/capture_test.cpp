// What somebody sees who listens to the network: everything of an open session, nothing of a secured one.
#include <arpa/inet.h>
#include <linux/if_packet.h>
#include <net/ethernet.h>
#include <signal.h>
#include <sys/socket.h>

#include <algorithm>

#include "tests/integration/security/secured_slab.h"
#include "tests/support/virtual_network.h"

namespace bonemill {
namespace {

using test::SecuredSlab;

// It hears all interfaces of this process' network.
class Ear {
  public:
    Ear() : socket_(socket(AF_PACKET, SOCK_RAW | SOCK_CLOEXEC | SOCK_NONBLOCK, htons(ETH_P_ALL))) {
        const int bytes = 256 << 20;
        setsockopt(socket_.number(), SOL_SOCKET, SO_RCVBUFFORCE, &bytes, sizeof bytes);
    }
    bool listens() const { return socket_.number() >= 0; }
    void listen() {
        std::string packet(1 << 17, '\0');
        for (ssize_t size; (size = recv(socket_.number(), packet.data(), packet.size(), 0)) > 0;)
            packets_.push_back(packet.substr(0, size_t(size)));
    }
    bool heard(const std::string& bytes) const {
        return std::ranges::any_of(
            packets_, [&](const std::string& packet) { return packet.find(bytes) != std::string::npos; });
    }
    const std::vector<std::string>& packets() const { return packets_; }

  private:
    test::Descriptor socket_;
    std::vector<std::string> packets_;
};

class Capture : public testing::Test {
  protected:
    void SetUp() override {
        if (const std::string missing = test::VirtualNetwork::enter(); !missing.empty())
            GTEST_SKIP() << missing;
        ASSERT_EQ(test::run({"/usr/sbin/ip", "link", "set", "lo", "up", "multicast", "on"}).exit_code, 0);
        ASSERT_EQ(test::run({"/usr/sbin/ip", "route", "add", "224.0.0.0/4", "dev", "lo"}).exit_code, 0);
    }
    // Listens until a viewer has the whole model.
    static Ear listenTo(const SecuredSlab& slab, bool is_secured) {
        Ear ear;
        EXPECT_TRUE(ear.listens());
        const auto server = slab.server(is_secured);
        const auto viewer = slab.probe(is_secured ? slab.folderOf("Otto") : "");
        EXPECT_TRUE(test::waitFor([&] {
            ear.listen();
            return SecuredSlab::isComplete(*viewer);
        })) << viewer->errSoFar();
        server->signal(SIGTERM);
        server->wait();
        ear.listen();
        return ear;
    }
    // Returns pieces of the largest packets of a session: those are meshes.
    static std::vector<std::string> meshPieces(const Ear& ear) {
        std::vector<std::string> pieces;
        for (const std::string& packet : ear.packets())
            if (packet.size() > 1500) pieces.push_back(packet.substr(packet.size() / 2, 24));
        return pieces;
    }
};

TEST_F(Capture, ShowsEverythingOfAnOpenSessionAndNothingOfASecuredOne) {
    const SecuredSlab slab;
    const Ear open = listenTo(slab, false);
    EXPECT_TRUE(open.heard("told_to_nobody")) << "the scene's name";
    const auto pieces = meshPieces(open);
    ASSERT_GE(pieces.size(), 1u);

    const Ear secured = listenTo(slab, true);
    EXPECT_GT(secured.packets().size(), 20u);
    EXPECT_FALSE(secured.heard("told_to_nobody"));
    EXPECT_TRUE(std::ranges::none_of(pieces, [&](const std::string& piece) { return secured.heard(piece); }));
}

}  // namespace
}  // namespace bonemill
