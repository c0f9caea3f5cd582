// A gateway with a thread of its own, and a guest that keeps what it was shown: for tests.
#pragma once

#include <gtest/gtest.h>
#include <stdlib.h>

#include <atomic>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <thread>
#include <vector>

#include "common/dds/node_digest.h"
#include "common/mesh_codec/mesh_codec.h"
#include "common/secrets/secrets.h"
#include "common/web_socket/web_socket_client.h"
#include "haptic_server/server/publish/publisher.h"
#include "proto/gateway.pb.h"
#include "render_client/link/subscribe/wire.h"
#include "render_client/web/gateway/gateway.h"
#include "render_client/web/gateway/gateway_server.h"
#include "render_client/web/gateway/guest.h"
#include "tests/support/dds_session.h"
#include "tests/support/process.h"
#include "tests/support/synthetic_nodes.h"
#include "tests/support/temporary_folder.h"

namespace bonemill::gateway {

// One line of the guests' file.
inline std::string invitationOf(const std::string& name, const std::string& role, const std::string& token,
                                int64_t expires_s = 0, uint32_t people = 1) {
    return "invitations { name: \"" + name + "\" role: " + role + " token_sha256: \"" + sha256Hex(token) +
           "\" expires_s: " + std::to_string(expires_s) + " people: " + std::to_string(people) + " }\n";
}

class RunningGateway {
  public:
    // With a certificate of its own making, unless it is given one.
    explicit RunningGateway(const std::string& guests, double mbit_per_s = 1000,
                            const GatewayCertificate& given = {}) {
        setenv("XDG_CONFIG_HOME", (folder_ / "config").c_str(), 1);
        invite(guests);
        std::filesystem::create_directories(folder_ / "page");
        test::writeFile(folder_ / "page/index.html", "<!doctype html><title>page</title>");
        test::writeFile(folder_ / "page/main.js", "let a = 1;");
        test::writeFile(folder_ / "page/main.js.gz", "packed");
        GatewayOptions& options = options_;
        options.domain = testDomain();
        options.session = testSession();
        options.guests = folder_ / "guests";
        options.page = folder_ / "page";
        options.guest_mbit_per_s = mbit_per_s;
        options.certificate = given.certificate;
        options.key = given.key;
        start();
    }
    ~RunningGateway() { stop(); }
    // Goes, and may come again at the same port.
    void stop() {
        if (!server_) return;
        should_stop_ = true;
        thread_.join();
        options_.port = server_->port();
        server_.reset();
    }
    void start() {
        should_stop_ = false;
        server_.emplace(options_);
        thread_ = std::thread([this] { server_->serveUntil([this] { return should_stop_.load(); }); });
    }
    // The file is replaced as a whole, as deploy/security/invite does.
    void invite(const std::string& guests) {
        test::writeFile(folder_ / "guests.new", guests);
        std::filesystem::rename(folder_ / "guests.new", folder_ / "guests");
    }
    WebTarget target() const { return {"127.0.0.1", server_->port(), server_->certificate().fingerprint}; }
    operator WebTarget() const { return target(); }
    uint16_t port() const { return server_->port(); }
    std::string filesContent() const {
        return test::readFile(folder_ / "guests") + test::readFile(folder_ / "guests.seats");
    }

  private:
    test::TemporaryFolder folder_;
    GatewayOptions options_;
    std::optional<GatewayServer> server_;
    std::atomic<bool> should_stop_{false};
    std::thread thread_;
};

struct TestGuest {
    explicit TestGuest(const WebTarget& target, const std::string& origin = {})
        : socket(target, {.path = "/session", .protocol = "bonemill.v1", .origin = origin},
                 std::chrono::seconds(5)) {}
    TestGuest(const WebTarget& target, const std::string& token, bool acknowledges) : TestGuest(target) {
        this->acknowledges = acknowledges;
        hello(token);
    }

    void send(const FromGuest& message) { socket.send(message.SerializeAsString()); }
    void hello(const std::string& token) {
        FromGuest message;
        Hello& hello = *message.mutable_hello();
        hello.set_token(token);
        hello.set_version(gateway::kProtocolVersion);
        hello.set_epoch(epoch);
        for (const auto& [leaf, node] : nodes) {
            hello.add_leaves(leaf);
            hello.add_revisions(node.revision);
        }
        send(message);
    }
    void poll(std::chrono::milliseconds patience = std::chrono::milliseconds(10)) {
        socket.wait(-1, patience);
        socket.move();
        std::string frame;
        while (socket.receive(frame)) take(frame);
        socket.move();
    }
    template <class Condition>
    bool pollUntil(Condition&& condition, std::chrono::seconds limit = std::chrono::seconds(30)) {
        const auto end = std::chrono::steady_clock::now() + limit;
        while (!condition()) {
            if (std::chrono::steady_clock::now() > end) return false;
            poll();
        }
        return true;
    }
    // Sends it again and again, as a lost network asks for, until then.
    template <class Condition>
    bool sendUntil(const FromGuest& message, Condition&& condition) {
        auto due = std::chrono::steady_clock::now();
        return pollUntil([&] {
            if (condition()) return true;
            if (std::chrono::steady_clock::now() < due) return false;
            due += std::chrono::milliseconds(50);
            send(message);
            return false;
        });
    }
    bool isWelcome() {
        return pollUntil([&] { return welcome || refusal || socket.hasEnded(); }) && welcome;
    }
    bool isRefused() {
        return pollUntil([&] { return refusal || socket.hasEnded(); }) && refusal;
    }
    NodeDigest digest() const {
        NodeDigest digest;
        for (const auto& [leaf, node] : nodes) digest.add(leaf, node.content);
        return digest;
    }
    bool isComplete() const {
        return status && digest().count() == status->node_count() &&
               digest().value() == status->node_digest();
    }

    void take(const std::string& bytes) {
        received += bytes.size();
        ++frames;
        largest_frame = std::max(largest_frame, bytes.size());
        if (acknowledges) {
            FromGuest message;
            message.mutable_received()->set_bytes(received);
            send(message);
        }
        ToGuest frame;
        ASSERT_TRUE(frame.ParseFromString(bytes));
        if (frame.has_welcome()) welcome = frame.welcome();
        if (frame.has_refusal()) refusal = frame.refusal();
        if (!frame.has_samples()) return;
        has_server = frame.samples().has_server();
        for (const Sample& sample : frame.samples().samples()) take(sample);
    }
    void take(const Sample& sample) {
        samples[sample.topic()] += 1;
        if (sample.topic() == Sample::STATUS) {
            topics::Status now;
            ASSERT_TRUE(now.ParseFromString(sample.payload()));
            if (now.epoch() != epoch) nodes.clear();
            epoch = now.epoch();
            if (welcome && now.last_command_sender() == welcome->sender()) answer = now.last_command_result();
            status = now;
        }
        if (sample.topic() == Sample::TOOL_STATE) tool.ParseFromString(sample.payload());
        if (sample.topic() == Sample::VIEWER) viewers[sample.key()] = sample.payload();
        if (sample.topic() == Sample::REMARK) {
            remarks[sample.key()] = sample.payload();
            if (sample.payload().empty()) remarks.erase(sample.key());
        }
        if (sample.topic() != Sample::NODE_MESH) return;
        const auto leaf = uint32_t(sample.key());
        if (sample.payload().empty()) {
            nodes.erase(leaf);
            return;
        }
        const auto node = decodeNodeMesh(sample.payload(), leaf);
        ASSERT_TRUE(node);
        a_node = sample.payload();
        nodes[leaf] = {node->content, node->mesh.revision};
    }

    struct Node {
        uint64_t content;
        uint32_t revision;
    };
    WebSocketClient socket;
    bool acknowledges = true;
    uint64_t epoch = 0, received = 0;
    size_t frames = 0, largest_frame = 0;
    std::map<uint32_t, Node> nodes;
    std::string a_node;          // the payload that came last
    std::map<int, int> samples;  // by topic
    std::map<uint64_t, std::string> viewers;
    std::map<uint64_t, std::string> remarks;  // by place
    std::optional<topics::Status> status;
    topics::ToolState tool;
    std::string answer;  // to its last command
    std::optional<Welcome> welcome;
    std::optional<Refusal> refusal;
    bool has_server = false;
};

// A server of the test's session with some nodes, and a status for them.
struct TestServer {
    Publisher publisher{{.domain = testDomain(), .session = testSession()}};
    topics::Status status;

    TestServer(uint32_t count, uint32_t triangles = 20) {
        EXPECT_TRUE(publisher.publishSceneInfo(syntheticSceneInfo()));
        std::vector<NodeMesh> meshes;
        for (uint32_t leaf = 0; leaf < count; ++leaf) meshes.push_back(syntheticNode(leaf, 1, triangles));
        show(meshes);
    }
    void show(const std::vector<NodeMesh>& meshes) {
        publisher.publishNodes(meshes);
        tellStatus();
    }
    void tellStatus() {
        status.set_scene("synthetic");
        publisher.publishStatus(status);
    }
};

}  // namespace bonemill::gateway
