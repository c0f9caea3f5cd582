#include "render_client/viewer_options/network_place.h"

#include <charconv>

#include "common/base/user_error.h"

namespace bonemill {

NetworkPlace placeOf(const std::string& option, const std::string& text, const std::string& assumed_host) {
    const size_t colon = text.rfind(':');
    const std::string port = colon == std::string::npos ? text : text.substr(colon + 1);
    NetworkPlace place{colon == std::string::npos ? assumed_host : text.substr(0, colon)};
    const char* const end = port.data() + port.size();
    const auto [rest, error] = std::from_chars(port.data(), end, place.port);
    if (place.host.starts_with('[') && place.host.ends_with(']'))
        place.host = place.host.substr(1, place.host.size() - 2);
    if (error == std::errc() && rest == end && !place.host.empty()) return place;
    throw UserError(option + " " + text + ": expected " +
                    (assumed_host.empty() ? "HOST:PORT, such as relay.example.org:8443"
                                          : "PORT or ADDRESS:PORT, such as 8443 or 0.0.0.0:8443"));
}

std::string textOf(const NetworkPlace& place) {
    const bool is_v6 = place.host.find(':') != std::string::npos;
    return (is_v6 ? "[" + place.host + "]" : place.host) + ":" + std::to_string(place.port);
}

}  // namespace bonemill
