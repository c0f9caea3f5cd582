// Writes a journal for readers that are no part of this program: journal_sample FILE.
#include <filesystem>

#include "tests/unit/haptic_server/recording/journal/recorded_session.h"

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    bonemill::test::MilledBall ball;
    bonemill::JournalConfig config;
    config.path = argv[1];
    config.manifest.set_rate_hz(config.rate_hz);
    std::filesystem::remove(config.path);
    bonemill::Journal journal(config, {ball.history.scanned(), ball.bone.lattice});
    bonemill::test::recordSession(journal, ball);
    journal.finish();
    return journal.problem().empty() ? 0 : 1;
}
