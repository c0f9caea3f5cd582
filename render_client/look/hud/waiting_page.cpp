#include "render_client/look/hud/waiting_page.h"

namespace bonemill {

HudPage waitingPage(const ServerSought& sought) {
    if (!sought.gateway.empty())
        return {"Waiting for a haptic_server",
                {{"Gateway", sought.gateway}},
                {"The gateway hears no server. Whoever started it knows of which session it is."}};
    HudPage page{
        "Waiting for a haptic_server",
        {{"Session", sought.is_any_session ? "the only one there is" : std::to_string(sought.session)},
         {"Domain", std::to_string(sought.domain)},
         {"Profile", sought.profile}},
        {"Is one running? deploy/bonemill start begins a session.",
         "It must have been started with the same --session, --domain and --profile."}};
    if (!sought.is_on_lan) {
        page.lines.push_back("One on another PC is found with --profile lab or classroom only.");
        return page;
    }
    page.rows.push_back({"Interface", sought.interface.empty() ? "chosen by itself" : sought.interface});
    page.lines.push_back("deploy/check-network says what is wrong between two PCs.");
    return page;
}

}  // namespace bonemill
