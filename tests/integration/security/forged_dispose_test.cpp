// Whoever has no certificate, but knows the GUID of a writer and how far it has counted, as everybody does
// who listens, says in its name that what it wrote is gone. In a closed session nobody believes it, of no
// topic.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <sys/socket.h>
#include <unistd.h>

#include <chrono>
#include <map>
#include <memory>
#include <sstream>
#include <thread>

#include "tests/integration/dds/child_process.h"
#include "tests/support/dds_session.h"
#include "tests/support/process.h"
#include "tests/support/secured_session.h"

namespace bonemill {
namespace {

std::string bytesOf(const std::string& hex) {
    std::string bytes;
    for (size_t n = 0; n + 1 < hex.size(); n += 2) bytes += char(std::stoi(hex.substr(n, 2), nullptr, 16));
    return bytes;
}

std::string bigEndian(uint32_t number) {
    return {char(number >> 24), char(number >> 16), char(number >> 8), char(number)};
}

// RTPS 2.5, 9.4: a message with one DATA submessage, which has a key's hash and the status "disposed", and no
// payload.
std::string disposal(const std::string& writer_guid, uint32_t sequence, const std::string& key_hash) {
    using namespace std::string_literals;
    const std::string inline_qos =
        "\x00\x70\x00\x10"s + key_hash + "\x00\x71\x00\x04\x00\x00\x00\x01"s + "\x00\x01\x00\x00"s;
    const std::string content = "\x00\x00\x00\x10\x00\x00\x00\x00"s + writer_guid.substr(12) + bigEndian(0) +
                                bigEndian(sequence) + inline_qos;
    return "RTPS\x02\x01\x01\x10"s + writer_guid.substr(0, 12) + "\x15\x02"s + char(content.size() >> 8) +
           char(content.size()) + content;
}

// Sends to all that listen to the domain on this PC.
class Forger {
  public:
    Forger() : socket_(socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0)) {
        const in_addr loopback{htonl(INADDR_LOOPBACK)};
        setsockopt(socket_, IPPROTO_IP, IP_MULTICAST_IF, &loopback, sizeof loopback);
        to_.sin_family = AF_INET;
        to_.sin_port =
            htons(uint16_t(7400 + 250 * testDomain() + 1));  // RTPS 2.5, 9.6.2: its multicast for data
        inet_pton(AF_INET, "239.255.0.1", &to_.sin_addr);
    }
    ~Forger() { close(socket_); }
    Forger(const Forger&) = delete;
    Forger& operator=(const Forger&) = delete;

    void send(const std::string& packet) const {
        EXPECT_EQ(sendto(socket_, packet.data(), packet.size(), 0, reinterpret_cast<const sockaddr*>(&to_),
                         sizeof to_),
                  ssize_t(packet.size()));
    }

  private:
    int socket_;
    sockaddr_in to_{};
};

class TopicSession {
  public:
    // `folders` are those of the parts; empty: the session is open.
    explicit TopicSession(const std::map<std::string, std::string>& folders) {
        for (const char* part : {"server", "device", "operator", "observer"}) {
            const auto folder = folders.find(part);
            parts_.push_back(std::make_unique<ChildProcess>(
                "topic_holder", std::string(part) + ":" + (folder == folders.end() ? "" : folder->second)));
        }
    }
    // The writers' GUIDs by topic.
    std::map<std::string, std::string> writers() {
        std::map<std::string, std::string> all;
        for (const auto& part : parts_) {
            std::istringstream words(part->ask("writers"));
            for (std::string topic, guid; words >> topic >> guid;) all[topic] = bytesOf(guid);
        }
        return all;
    }
    struct State {
        std::string state, key_hash;
    };
    std::map<std::string, State> states() {
        std::map<std::string, State> all;
        for (const auto& part : parts_) {
            std::istringstream words(part->ask("state"));
            for (std::string topic, state, hash; words >> topic >> state >> hash;)
                all[topic] = {state, bytesOf(hash)};
        }
        return all;
    }
    size_t aliveTopics() {
        size_t count = 0;
        for (const auto& [topic, state] : states()) count += state.state == "alive";
        return count;
    }
    void stopWriting() {
        for (const auto& part : parts_) EXPECT_EQ(part->ask("stop"), "stopped");
    }

  private:
    std::vector<std::unique_ptr<ChildProcess>> parts_;
};

constexpr size_t kTopics = 13;  // proto/topics.idl

// Returns how many topics still have what was written.
size_t aliveAfterForgery(TopicSession& session) {
    EXPECT_TRUE(test::waitFor([&] { return session.aliveTopics() == kTopics; }, std::chrono::seconds(30)));
    const auto writers = session.writers();
    EXPECT_EQ(writers.size(), kTopics);
    session.stopWriting();
    const auto before = session.states();
    const Forger forger;
    constexpr uint32_t kSequences = 700;  // more than were written
    for (uint32_t sequence = 1; sequence <= kSequences; ++sequence) {
        for (const auto& [topic, guid] : writers)
            forger.send(disposal(guid, sequence, before.at(topic).key_hash));
        std::this_thread::sleep_for(std::chrono::microseconds(500));
    }
    std::this_thread::sleep_for(std::chrono::milliseconds(200));
    for (const auto& [topic, state] : session.states())
        if (state.state != "alive") std::cout << topic << " is " << state.state << '\n';
    return session.aliveTopics();
}

TEST(ForgedDispose, ErasesEveryTopicOfAnOpenSession) {
    TopicSession open({});
    EXPECT_EQ(aliveAfterForgery(open), 0u) << "else the forgery below proves nothing";
}

TEST(ForgedDispose, ErasesNothingOfAClosedSession) {
    const test::SecuredSession people({"--server", "--person", "Olga:operator", "--person", "Otto:observer"},
                                      testSession());
    TopicSession closed({{"server", people.folderOf("server")},
                         {"device", people.folderOf("device")},
                         {"operator", people.folderOf("Olga")},
                         {"observer", people.folderOf("Otto")}});
    EXPECT_EQ(aliveAfterForgery(closed), kTopics);
}

}  // namespace
}  // namespace bonemill
