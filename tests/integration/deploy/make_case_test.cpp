// deploy/make-case as a teacher calls it: from a DICOM series to a case with pictures.
#include <gtest/gtest.h>
#include <signal.h>

#include <filesystem>
#include <fstream>

#include "common/mcap/mcap_reader.h"
#include "tests/integration/deploy/bonemill_rig.h"
#include "tests/support/planted_patient.h"

namespace bonemill {
namespace {

// What a recording holds, unpacked.
std::string messagesOf(const std::filesystem::path& recording) {
    std::ifstream stream(recording, std::ios::binary);
    std::string all;
    mcap::read(stream, [&](const mcap::Channel& channel, const mcap::Message& message) {
        all += channel.topic + std::string(message.data);
    });
    return all;
}

class MakeCaseScript : public testing::Test {
  protected:
    MakeCaseScript() {
        rig_.useRealPrograms();
        std::filesystem::copy_file(test::sourceDir() + "/deploy/make-case", rig_.programFile("make-case"));
        EXPECT_EQ(test::run({"make_phantom", "block", "--out", rig_.folder() / "block.nrrd", "--size-mm",
                             "12", "12", "8", "--voxel-mm", "0.5"})
                      .exit_code,
                  0);
    }
    test::Finished make(const std::vector<std::string>& more) const {
        std::vector<std::string> words{rig_.programFile("make-case"), rig_.folder() / "block.nrrd", "--out",
                                       rig_.folder() / "case"};
        words.insert(words.end(), more.begin(), more.end());
        return test::run(words);
    }

    // What a session with this scene says and leaves: output, report and recording.
    std::string leftOfSession(const std::string& scene) const {
        const test::TemporaryFolder recordings;
        const std::string report = rig_.folder() / "report.json";
        test::Process server({rig_.programFile("haptic_server"), "--scene", scene, "--session", "4711",
                              "--recording", recordings.path(), "--report", report});
        const auto says = [&] { return server.outSoFar() + server.errSoFar(); };
        EXPECT_TRUE(test::waitFor(
            [&] { return !server.isRunning() || says().find("waits for a device") != std::string::npos; }));
        server.signal(SIGTERM);
        const test::Finished session = server.wait();
        EXPECT_EQ(session.exit_code, 0) << session.err;
        EXPECT_GT(test::readFile(report).size(), 100u);
        std::string left = session.out + session.err + test::readFile(report);
        for (const auto& recording : std::filesystem::directory_iterator(recordings.path()))
            left += recording.path().string() + messagesOf(recording.path());
        return left;
    }

    test::BonemillRig rig_;
};

TEST_F(MakeCaseScript, MakesACaseWithPictures) {
    const test::Finished made = make({"--tools", "dental", "--at", "0", "0", "-2", "--size-mm", "6"});
    ASSERT_EQ(made.exit_code, 0) << made.out << made.err;
    EXPECT_NE(made.out.find("bonemill start"), std::string::npos) << made.out;
    for (const char* const file : {"case.textproto", "scan.nrrd", "provenance.json", "preview.png",
                                   "case.png", "pieces.png", "histogram.png"}) {
        std::error_code error;
        EXPECT_GT(std::filesystem::file_size(rig_.folder() / (std::string("case/") + file), error), 100u)
            << file;
    }
    EXPECT_NE(test::readFile(rig_.folder() / "case/case.textproto").find("round 014"), std::string::npos);
}

// From a series that names the patient everywhere to the case's pictures, and to what a session with it
// leaves: recording, report and the list of scenes that viewers get. Where the case lies is in the recording.
TEST_F(MakeCaseScript, NoFileOfACaseOrItsSessionNamesThePatient) {
    const test::TemporaryFolder source;
    const std::string series = test::writePlantedSeries(source.path(), test::plantedHu);
    const test::Finished made =
        test::run({rig_.programFile("make-case"), series, "--out", rig_.folder() / "case", "--tools",
                   "dental", "--at", "30", "20", "20", "--size-mm", "16", "--voxel-mm", "0.5"});
    ASSERT_EQ(made.exit_code, 0) << made.out << made.err;
    EXPECT_EQ(test::plantedUnder(rig_.folder() / "case"), std::vector<std::string>());
    for (const char* const picture :
         {"case/preview.png", "case/case.png", "case/pieces.png", "case/histogram.png"})
        for (const std::string& chunk : test::pngChunks(test::readFile(rig_.folder() / picture)))
            EXPECT_EQ(std::string("tEXt zTXt iTXt eXIf tIME").find(chunk), std::string::npos) << chunk;

    const std::string left = leftOfSession(rig_.folder() / "case/case.textproto");
    EXPECT_NE(left.find("case.textproto"), std::string::npos) << "its place is said";
    EXPECT_EQ(test::plantedIn(left), std::vector<std::string>());
    test::writeFile(rig_.folder() / "raw.textproto", "volume { path: \"" + series + "\" }");
    EXPECT_FALSE(test::plantedIn(leftOfSession(rig_.folder() / "raw.textproto")).empty())
        << "who mills the scan itself has its path in the recording";
    const test::Finished listed =
        test::run({rig_.programFile("haptic_server"), "--scenes", rig_.folder() / "case", "--list-scenes"});
    EXPECT_EQ(listed.exit_code, 0) << listed.err;
    EXPECT_NE(listed.out.find("case"), std::string::npos) << listed.out;
    EXPECT_EQ(test::plantedIn(listed.out), std::vector<std::string>());
}

TEST_F(MakeCaseScript, SaysWhichToolsThereAre) {
    const test::Finished refused = make({"--tools", "garden"});
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_NE(refused.err.find("dental otologic spine"), std::string::npos) << refused.err;
    EXPECT_FALSE(std::filesystem::exists(rig_.folder() / "case"));
}

TEST_F(MakeCaseScript, LeavesTheProgramsOwnRefusal) {
    const test::Finished refused = make({"--iso", "99999"});
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_NE(refused.err.find("iso-value"), std::string::npos) << refused.err;
    EXPECT_FALSE(std::filesystem::exists(rig_.folder() / "case"));
}

}  // namespace
}  // namespace bonemill
