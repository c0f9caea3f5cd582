#include "render_client/look/hud/session_text.h"

#include <algorithm>
#include <cmath>
#include <cstdio>

#include "render_client/look/hud/figure_text.h"

namespace bonemill {

std::string roleName(topics::Viewer::Role role) {
    switch (role) {
        case topics::Viewer::VIEWER:
            return "viewer";
        case topics::Viewer::OPERATOR:
            return "operator";
        case topics::Viewer::INSTRUCTOR:
            return "instructor";
        case topics::Viewer::EXAMINER:
            return "examiner";
        default:
            return "?";
    }
}

std::string watcherName(const std::string& name) {
    return name.empty() ? "(no name)" : name;
}

std::string watcherText(const topics::Viewer& watcher) {
    return roleName(watcher.role()) + (watcher.link().empty() ? "" : " by " + watcher.link()) + ", " +
           figureText(watcher.frame_rate_hz(), 0, " Hz") + (watcher.is_holding() ? ", holds the tool" : "") +
           (watcher.is_complete() ? "" : ", incomplete");
}

std::string clockText(double seconds) {
    if (!(seconds >= 0) || !std::isfinite(seconds)) return kNoNumber;
    const auto whole = static_cast<unsigned long long>(std::min(seconds, 1e9));
    char text[32];
    std::snprintf(text, sizeof text, "%llu:%02llu:%02llu", whole / 3600, whole / 60 % 60, whole % 60);
    return text;
}

}  // namespace bonemill
