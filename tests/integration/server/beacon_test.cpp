// The session's clock, told to another program and used: the reader is the page's own, as its readers copy
// it, and what it writes brings its table onto the clock of the recording.
#include <arpa/inet.h>
#include <gtest/gtest.h>
#include <netinet/in.h>
#include <signal.h>
#include <sys/socket.h>
#include <unistd.h>

#include <cmath>
#include <cstdio>
#include <filesystem>
#include <sstream>

#include "haptic_server/recording/journal/journal_reader.h"
#include "tests/integration/server/block_hand.h"
#include "tests/support/dds_session.h"
#include "tests/support/places.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

using test::Finished;
using test::Process;
using test::run;

// The page's example, as it stands there.
std::string readerOfThePage() {
    const std::string page = test::readFile(test::sourceDir() + "/docs/reference/beacon.md");
    const std::string begin = "```python\n";
    const size_t from = page.find(begin) + begin.size();
    return page.substr(from, page.find("```\n", from) - from);
}

// Nobody else's a moment ago.
std::string freePort() {
    const int probe = socket(AF_INET, SOCK_DGRAM | SOCK_CLOEXEC, 0);
    sockaddr_in address{};
    address.sin_family = AF_INET;
    EXPECT_EQ(bind(probe, reinterpret_cast<sockaddr*>(&address), sizeof address), 0);
    socklen_t size = sizeof address;
    getsockname(probe, reinterpret_cast<sockaddr*>(&address), &size);
    close(probe);
    return std::to_string(ntohs(address.sin_port));
}

std::vector<std::string> linesOf(const std::string& text) {
    std::vector<std::string> lines;
    std::istringstream stream(text);
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

class BeaconSession : public testing::Test {
  protected:
    BeaconSession() {
        const test::EveryEffectBlock block;
        test::writeBlock(folder_.path().string(), block);
        scene::Scene scene =
            test::withoutEffect(test::everyEffectScene(block, test::kByEnergy), "virtual_fixture");
        test::addHand(scene, block);
        test::writeScene(folder_ / "scene.textproto", scene);
        test::writeFile(folder_ / "reader.py", readerOfThePage());
    }
    std::string journal() const {
        for (const auto& entry : std::filesystem::directory_iterator(folder_ / "recordings"))
            return entry.path().string();
        return "";
    }
    const std::string session_ = std::to_string(testSession()), domain_ = std::to_string(testDomain());
    test::TemporaryFolder folder_;
};

TEST_F(BeaconSession, ThePagesReaderBringsItsTableOntoTheRecordingsClock) {
    const std::string port = freePort();
    Process reader({"/usr/bin/python3", folder_ / "reader.py", port});
    ASSERT_TRUE(test::waitFor([&] { return !reader.outSoFar().empty(); })) << reader.errSoFar();
    Process server({"haptic_server", "--scene", folder_ / "scene.textproto", "--session", session_,
                    "--domain", domain_, "--recording", folder_ / "recordings", "--beacon",
                    "127.0.0.1:" + port});
    Process hand({"device_daemon", "--device", "simulated", "--scene", folder_ / "scene.textproto",
                  "--session", session_});
    EXPECT_TRUE(test::waitFor([&] { return linesOf(reader.outSoFar()).size() > 8; })) << server.errSoFar();
    server.signal(SIGTERM);
    EXPECT_EQ(server.wait().exit_code, 0);
    reader.signal(SIGTERM);
    reader.wait();
    const std::vector<std::string> lines = linesOf(reader.outSoFar());
    const JournalContent content = readJournalContent(journal(), KeepInputs::kNo);
    for (size_t n = 1; n < lines.size(); ++n)
        EXPECT_TRUE(lines[n].ends_with("," + content.manifest.journal_id())) << lines[n];

    test::writeFile(folder_ / "eeg.csv", reader.outSoFar());
    const Finished aligned =
        run({"bonemill_lab", "session", "export", journal(), "--align", folder_ / "eeg.csv"});
    ASSERT_EQ(aligned.exit_code, 0) << aligned.err;
    EXPECT_NE((aligned.out + aligned.err).find("beacons lie"), std::string::npos)
        << aligned.out << aligned.err;
    // Both programs have CLOCK_MONOTONIC here: what lies between is the way, not the clocks.
    for (const std::string& row : linesOf(test::readFile(folder_ / "eeg_aligned.csv"))) {
        double session_s = 0, own_s = 0, beacon_ns = 0;
        if (std::sscanf(row.c_str(), "%lf,%lf,%lf", &session_s, &own_s, &beacon_ns) != 3) continue;
        EXPECT_LT(std::abs(session_s - beacon_ns * 1e-9), 1) << row;
        EXPECT_LT(session_s, double(content.ticks) / content.manifest.rate_hz() + 1)
            << "within the recording";
    }
}

TEST_F(BeaconSession, AnAddressThatIsNoneIsRefusedAtTheStart) {
    const Finished refused =
        run({"haptic_server", "--scene", folder_ / "scene.textproto", "--session", session_, "--domain",
             domain_, "--no-recording", "--beacon", "localhost:7501"});
    EXPECT_EQ(refused.exit_code, 2) << refused.err;
    EXPECT_NE(refused.err.find("ADDRESS:PORT"), std::string::npos) << refused.err;
}

}  // namespace
}  // namespace bonemill
