// The program's own viewer behind a gateway, without a picture: for tests.
#pragma once

#include <chrono>
#include <map>
#include <memory>
#include <string>
#include <vector>

#include "render_client/link/subscribe/scene_subscriber.h"
#include "render_client/web/connect/gateway_session.h"

namespace bonemill::gateway {

struct RemoteViewer {
    std::shared_ptr<connect::GatewaySession> session;
    SceneSubscriber subscriber;
    std::map<uint32_t, uint32_t> nodes;  // leaves and revisions
    std::vector<CommandOutcome> outcomes;

    RemoteViewer(const WebTarget& target, const std::string& token)
        : session(std::make_shared<connect::GatewaySession>(target, token, std::chrono::seconds(5))),
          subscriber(
              {.name = session->welcome().name(), .role = session->welcome().role(), .remote = session}) {}

    template <class Condition>
    bool pollUntil(Condition&& condition) {
        const auto end = std::chrono::steady_clock::now() + std::chrono::seconds(30);
        while (true) {
            const SceneModel::Changes changes = subscriber.poll();
            if (changes.is_cleared) nodes.clear();
            for (const SceneModel::Change& change : changes.nodes) {
                nodes[change.mesh.leaf] = change.mesh.revision;
                if (change.mesh.isEmpty()) nodes.erase(change.mesh.leaf);
            }
            for (const CommandOutcome& outcome : subscriber.takeOutcomes()) outcomes.push_back(outcome);
            if (condition()) return true;
            if (std::chrono::steady_clock::now() > end) return false;
            subscriber.waitForData(std::chrono::milliseconds(20));
        }
    }
    bool pollUntilComplete(const NodeDigest& digest) {
        return pollUntil([&] { return subscriber.isComplete() && subscriber.digest() == digest; });
    }
};

}  // namespace bonemill::gateway
