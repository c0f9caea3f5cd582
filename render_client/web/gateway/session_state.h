// The session as its server wrote it: of every topic the newest payload of every key. Whoever passes it on
// shares the payloads. For one thread.
#pragma once

#include <Eigen/Core>
#include <compare>
#include <cstdint>
#include <map>
#include <memory>
#include <optional>
#include <string>
#include <unordered_map>
#include <vector>

#include "proto/gateway.pb.h"

namespace bonemill::gateway {

using Topic = Sample::Topic;
using Payload = std::shared_ptr<const std::string>;

// It names what is neither a node nor a brick: there are many of those.
struct SmallKey {
    Topic topic;
    uint64_t key = 0;
    auto operator<=>(const SmallKey&) const = default;
};

struct SharedNode {
    Payload payload;
    uint32_t revision = 0;
    Eigen::Vector3f place_V;  // m, a corner of the leaf
};

struct SessionState {
    uint64_t epoch = 0;  // of the server's run; 0: nothing has arrived yet
    std::map<SmallKey, Payload> small;
    std::unordered_map<uint32_t, SharedNode> nodes;
    std::optional<topics::ToolState> tool_state;
    std::optional<topics::Status> status;
    Eigen::Vector3f tool_V = Eigen::Vector3f::Zero();  // m
    bool has_server = false;
    bool has_ended = false;
};

// What is new since the look before.
struct SessionChanges {
    bool is_cleared = false;  // first forget everything: another run of the server began
    std::vector<SmallKey> small;
    std::vector<uint32_t> nodes;
    std::optional<topics::EffectState> counted;  // what happened in all tool states since
    bool has_tool_state = false;
    struct Brick {
        uint32_t number;
        Payload payload;
    };
    std::vector<Brick> bricks;

    bool isEmpty() const {
        return !is_cleared && small.empty() && nodes.empty() && !has_tool_state && bricks.empty();
    }
};

}  // namespace bonemill::gateway
