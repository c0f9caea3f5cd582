// Says which server a viewer waits for, and what to try. The function is pure; any thread may call it.
#pragma once

#include <cstdint>
#include <string>

#include "render_client/look/hud/hud.h"

namespace bonemill {

struct ServerSought {
    uint32_t session = 1;
    uint32_t domain = 0;
    std::string profile;          // as the user knows it: one-pc, lab, ...
    std::string interface;        // empty: none was chosen
    bool is_on_lan = false;       // the server may run on another PC
    bool is_any_session = false;  // the number does not count
    std::string gateway = {};     // not empty: it is the gateway that looks for the server
    HudLock lock = HudLock::kNone;
};

HudPage waitingPage(const ServerSought& sought);

}  // namespace bonemill
