// Says where the sources and the programs of this build lie.
#pragma once

#include <string>

namespace bonemill::test {

// This is the root of the checkout.
std::string sourceDir();
// It has the programs, as haptic_server.
std::string binDir();
// It has small programs that only tests start, as link_relay.
std::string helperDir();

}  // namespace bonemill::test
