// Host and port on a command line.
#pragma once

#include <cstdint>
#include <string>

namespace bonemill {

struct NetworkPlace {
    std::string host;
    uint16_t port = 0;
};

// Reads "0.0.0.0:8443" and "[::1]:8443", and "8443" alone where there is a host to assume. `option` has the
// text and is named in the message. Throws UserError.
NetworkPlace placeOf(const std::string& option, const std::string& text,
                     const std::string& assumed_host = {});
// Returns it as placeOf() reads it.
std::string textOf(const NetworkPlace& place);

}  // namespace bonemill
