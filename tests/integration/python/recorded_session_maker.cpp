// Records a session for readers that are no part of this program: recorded_session_maker FOLDER
// [--without-orders]. Prints the state hash of its ticks and bone.
#include <cstdio>

#include "common/text/hex_text.h"
#include "tests/support/recorded_session.h"

int main(int argc, char** argv) {
    if (argc < 2 || argc > 3) return 2;
    bonemill::test::RecordedSessionOptions options;
    options.has_orders = argc == 2;
    const bonemill::test::RecordedSession session = bonemill::test::recordSession(argv[1], options);
    std::printf("%s\n", bonemill::hexText(session.state_hash).c_str());
    return 0;
}
