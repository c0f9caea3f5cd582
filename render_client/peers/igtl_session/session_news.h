// What happens in a session, in sentences for people. For one thread.
#pragma once

#include <cstdint>
#include <optional>
#include <set>
#include <string>
#include <vector>

#include "render_client/link/subscribe/scene_subscriber.h"

namespace bonemill::igtl {

class SessionNews {
  public:
    // What is new since the call before.
    std::vector<std::string> take(const SceneSubscriber& subscriber);

  private:
    void takeStatus(const topics::Status& status, std::vector<std::string>& news);
    void takeRemarks(const SceneSubscriber& subscriber, std::vector<std::string>& news);
    void takeEffects(const topics::ToolState& state, std::vector<std::string>& news);

    bool has_server_ = false;
    std::optional<std::string> scene_;
    std::optional<bool> is_paused_;
    std::optional<uint32_t> checkpoint_;
    std::string fault_;
    std::set<std::string> warnings_;
    std::set<uint32_t> remarks_;  // their numbers
    uint64_t remark_changes_ = 0;
    uint64_t tick_ = 0;
    uint32_t effects_ = 0;
};

}  // namespace bonemill::igtl
