#include "render_client/apps/render_client/inviter.h"

#include <exception>

#include "common/base/is_ready.h"
#include "render_client/language/language.h"

namespace bonemill {

void Inviter::invite(const std::string& launcher, uint32_t session, const std::string& name,
                     const std::string& role) {
    if (made_.valid()) return;
    invitation_ = {.name = name, .link = {}, .problem = {}};
    made_ = std::async(std::launch::async, [=] {
        return runCaptured({launcher, "invite", name, "--role", role, "--session", std::to_string(session),
                            "--in-background"});
    });
}

const Invitation& Inviter::invitation() {
    if (isReady(made_)) take();
    return invitation_;
}

void Inviter::take() {
    try {
        const Captured captured = made_.get();
        const size_t link = captured.out.find("https://");
        if (captured.exit_code == 0 && link != std::string::npos)
            invitation_.link = captured.out.substr(link, captured.out.find_first_of(" \n", link) - link);
        else
            invitation_.problem = tr("No link: {1}", {captured.err});
    } catch (const std::exception& error) {
        invitation_.problem = error.what();
    }
}

}  // namespace bonemill
