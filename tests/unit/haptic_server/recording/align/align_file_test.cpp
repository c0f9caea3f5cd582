#include "haptic_server/recording/align/align_file.h"

#include <gtest/gtest.h>

#include <fstream>
#include <sstream>

#include "common/base/user_error.h"
#include "tests/support/temporary_folder.h"

namespace bonemill {
namespace {

constexpr const char* kRecording = "000102030405060708090a0b0c0d0e0f";

class AlignFile : public testing::Test {
  protected:
    Alignment align(const std::string& table, const std::string& clock = "") {
        std::ofstream(folder_ / "eeg.csv", std::ios::binary) << table;
        return alignFile(folder_ / "eeg.csv", folder_ / "out.csv", clock, kRecording);
    }
    std::string written() const {
        std::ifstream file(folder_ / "out.csv", std::ios::binary);
        std::ostringstream all;
        all << file.rdbuf();
        return all.str();
    }
    test::TemporaryFolder folder_;
};

TEST_F(AlignFile, EveryRowGetsTheSessionsTimeAndStaysAsItWas) {
    const Alignment done = align(
        "time,uv,beacon_session_ns\n"
        "100,1.5,\n"
        "101,2.5,1000000000\n"
        "102,\"a, b\",\n"
        "105,,5000000000\n");
    EXPECT_EQ(done.rows, 4u);
    EXPECT_EQ(done.fit.pairs, 2u);
    EXPECT_EQ(written(),
              "session_s,time,uv,beacon_session_ns\n"
              "0.000000000,100,1.5,\n"
              "1.000000000,101,2.5,1000000000\n"
              "2.000000000,102,\"a, b\",\n"
              "5.000000000,105,,5000000000\n");
    EXPECT_NE(done.text().find("4 rows by 2 beacons"), std::string::npos) << done.text();
    EXPECT_NE(done.text().find("0.000 ms"), std::string::npos) << done.text();
}

TEST_F(AlignFile, TheClockMayBeAnyColumnAndLinesMayEndAsOnWindows) {
    align("\xef\xbb\xbfvalue,\"ms\",beacon_session_ns\r\n1,1000,0\r\n2,3000,2000000000\r\n3,4000,\r\n", "ms");
    EXPECT_NE(written().find("3.000000000,3,4000,\n"), std::string::npos) << written();
}

TEST_F(AlignFile, BeaconsOfAnotherRecordingDoNotCount) {
    const std::string head = "t,beacon_session_ns,beacon_recording\n";
    const Alignment done = align(head + "1,9000000000,ffffffffffffffffffffffffffffffff\n2,1000000000," +
                                 kRecording + "\n4,3000000000,\n");
    EXPECT_EQ(done.other_beacons, 1u);
    EXPECT_EQ(done.fit.pairs, 2u);
    EXPECT_NE(done.text().find("passed over"), std::string::npos);
    EXPECT_NE(written().find("0.000000000,1,"), std::string::npos) << written();
    EXPECT_THROW(align(head + "1,9000000000,ffffffffffffffffffffffffffffffff\n"), UserError);
}

TEST_F(AlignFile, RefusesWhatItCannotAlign) {
    std::ofstream(folder_ / "out.csv") << "of before";
    for (const char* const table : {"", "t,uv\n1,2\n", "t,beacon_session_ns\n",
                                    "t,beacon_session_ns\n1,\n2,\n", "t,beacon_session_ns\n1,0\nnoon,\n",
                                    "t,beacon_session_ns\n1,0\nnan,\n", "t,beacon_session_ns\n1,0\n,5\n"})
        EXPECT_THROW(align(table), UserError) << table;
    EXPECT_THROW(align("t,beacon_session_ns\n1,0\n", "no such"), UserError);
    EXPECT_EQ(written(), "of before");
    EXPECT_THROW(alignFile(folder_ / "none.csv", folder_ / "out.csv", "", kRecording), UserError);
}

TEST_F(AlignFile, TheNameBesideIt) {
    EXPECT_EQ(alignedPathOf("a/eeg.csv"), "a/eeg_aligned.csv");
    EXPECT_EQ(alignedPathOf(""), "");
}

}  // namespace
}  // namespace bonemill
