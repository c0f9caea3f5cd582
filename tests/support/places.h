// Where the sources and the programs of this build lie.
#pragma once

#include <string>

namespace bonemill::test {

// The root of the checkout.
std::string sourceDir();
// The programs, as haptic_server.
std::string binDir();
// Small programs that only tests start, as link_relay.
std::string helperDir();

}  // namespace bonemill::test
