// This SceneSubscriber of the test's session remembers the model that it was told, as a renderer would.
#pragma once

#include <chrono>
#include <map>
#include <string>

#include "render_client/link/subscribe/scene_subscriber.h"
#include "tests/support/dds_session.h"

namespace bonemill {

struct ClientProbe {
    SceneSubscriber subscriber{{.domain = testDomain(), .session = testSession()}};
    std::map<uint32_t, NodeMesh> nodes;
    uint32_t changes = 0;
    uint32_t clearings = 0;

    void poll(size_t max_nodes = SceneSubscriber::kAllNodes) {
        SceneModel::Changes update = subscriber.poll(max_nodes);
        if (update.is_cleared) {
            nodes.clear();
            ++clearings;
        }
        changes += static_cast<uint32_t>(update.nodes.size());
        for (SceneModel::Change& change : update.nodes) {
            NodeMesh& node = change.mesh;
            if (node.isEmpty()) {
                nodes.erase(node.leaf);
            } else {
                nodes[node.leaf] = std::move(node);
            }
        }
    }

    // Polls until the condition holds; gives up after 30 s.
    template <class Condition>
    bool pollUntil(Condition&& condition) {
        const auto deadline = std::chrono::steady_clock::now() + std::chrono::seconds(30);
        while (!condition()) {
            if (std::chrono::steady_clock::now() > deadline) return false;
            subscriber.waitForData(std::chrono::milliseconds(20));
            poll();
        }
        return true;
    }

    // Orders it, and returns the answer's text; "none" if none comes.
    std::string order(const topics::Command& command) {
        subscriber.sendCommand(command);
        std::string answer = "none";
        pollUntil([&] {
            for (const CommandOutcome& outcome : subscriber.takeOutcomes()) answer = outcome.answer.text;
            return answer != "none";
        });
        return answer;
    }

    std::string digestLine() const {
        return std::to_string(subscriber.digest().count()) + ' ' +
               std::to_string(subscriber.digest().value());
    }
    // It must be complete, and in the state that the server answered with.
    bool pollUntilComplete(const std::string& digest_line) {
        return pollUntil([&] { return subscriber.isComplete() && digestLine() == digest_line; });
    }
};

}  // namespace bonemill
