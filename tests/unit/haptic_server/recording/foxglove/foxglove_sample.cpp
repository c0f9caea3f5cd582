// Writes a session for readers that are no part of this program, and what each tick came to as a table:
// foxglove_sample FOLDER makes session.mcap's export.mcap, export.layout.json and export.csv there.
#include <filesystem>

#include "haptic_server/recording/export/export_journal.h"
#include "tests/support/recorded_session.h"

int main(int argc, char** argv) {
    if (argc != 2) return 2;
    const std::filesystem::path folder(argv[1]);
    std::filesystem::remove_all(folder);
    std::filesystem::create_directories(folder);
    const bonemill::test::RecordedSession session = bonemill::test::recordSession(folder);
    bonemill::exportJournal({.journal = session.journal,
                             .h5 = "",
                             .csv = folder / "export.csv",
                             .traj = "",
                             .foxglove = folder / "export.mcap"});
    return 0;
}
