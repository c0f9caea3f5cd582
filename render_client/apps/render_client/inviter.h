// Has bonemill make invitations. It belongs to the render thread, which it does not keep waiting.
#pragma once

#include <future>
#include <string>

#include "common/process/run_captured.h"
#include "render_client/hand/controls/session_view.h"

namespace bonemill {

class Inviter {
  public:
    // One at a time: while one is made another is not begun.
    void invite(const std::string& launcher, uint32_t session, const std::string& name,
                const std::string& role);
    // The last one that was asked for, with its link as soon as that is there.
    const Invitation& invitation();

  private:
    void take();

    std::future<Captured> made_;
    Invitation invitation_;
};

}  // namespace bonemill
