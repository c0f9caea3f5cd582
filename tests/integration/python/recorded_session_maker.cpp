// Records a session for readers that are no part of this program: recorded_session_maker FOLDER
// [--without-orders | --with-attempts]. Prints the state hash of its ticks and bone.
#include <cstdio>
#include <string_view>

#include "common/text/hex_text.h"
#include "tests/support/recorded_session.h"

int main(int argc, char** argv) {
    if (argc < 2 || argc > 3) return 2;
    bonemill::test::RecordedSessionOptions options;
    const std::string_view word = argc == 3 ? argv[2] : "";
    options.has_orders = word.empty();
    if (word == "--with-attempts") {
        options.attempts = {500, 1500, 2500};
        options.scene_text =
            "assessment { zone { name: \"groove\" role: TARGET shape { cylinder { from_mm { x: 8 y: 8 z: 9 } "
            "to_mm { x: 8 y: 8 z: 12 } radius_mm: 4 } } } }";
    }
    const bonemill::test::RecordedSession session = bonemill::test::recordSession(argv[1], options);
    std::printf("%s\n", bonemill::hexText(session.state_hash).c_str());
    return 0;
}
