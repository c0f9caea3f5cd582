#include "haptic_server/scene/trajectory/trajectory_reader.h"

#include <gtest/gtest.h>

#include <filesystem>
#include <random>
#include <sstream>

#include "common/base/user_error.h"
#include "tests/unit/haptic_server/recording/statistics/temporary_file.h"

namespace bonemill {
namespace {

const std::string kHeader = "t_s,px_m,py_m,pz_m,qw,qx,qy,qz,buttons\n";

std::vector<TrajectoryRow> read(const std::string& text) {
    std::istringstream input(text);
    return readTrajectory(input, "test.csv");
}

std::string errorOf(const std::string& text) {
    try {
        read(text);
    } catch (const UserError& error) {
        return error.what();
    }
    return "no error";
}

void expectError(const std::string& text, const std::string& where, const std::string& what) {
    const std::string error = errorOf(text);
    EXPECT_NE(error.find("trajectory test.csv:" + where + ": "), std::string::npos) << error;
    EXPECT_NE(error.find(what), std::string::npos) << error;
}

TEST(TrajectoryReader, readsRows) {
    const auto rows = read(kHeader + "0,0.1,-0.2,3e-1,1,0,0,0,0\n0.001,1,2,3,0,0.6,0,0.8,3\n");
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[0].X_WT.position, Eigen::Vector3d(0.1, -0.2, 0.3));
    EXPECT_EQ(rows[0].buttons, 0u);
    EXPECT_EQ(rows[1].t_s, 0.001);
    EXPECT_EQ(rows[1].X_WT.rotation.w(), 0.0);
    EXPECT_NEAR(rows[1].X_WT.rotation.x(), 0.6, 1e-15);
    EXPECT_NEAR(rows[1].X_WT.rotation.z(), 0.8, 1e-15);
    EXPECT_EQ(rows[1].buttons, 3u);
}

TEST(TrajectoryReader, acceptsWhatSpreadsheetsWrite) {
    const auto rows = read(
        "\xef\xbb\xbf"
        "buttons, note, qz,qy,qx,qw, pz_m,py_m,px_m,t_s\r\n\r\n 2 , x , 0,0,0,1, 3, 2, 1, -5 \r\n");
    ASSERT_EQ(rows.size(), 1u);
    EXPECT_EQ(rows[0].t_s, -5.0);
    EXPECT_EQ(rows[0].X_WT.position, Eigen::Vector3d(1, 2, 3));
    EXPECT_EQ(rows[0].X_WT.rotation.w(), 1.0);
    EXPECT_EQ(rows[0].buttons, 2u);
}

// The tick normalises it, and twice would be other bits: a recorded input goes through here unchanged.
TEST(TrajectoryReader, leavesAQuaternionWithinToleranceAsItIs) {
    const auto rows = read(kHeader + "0,0,0,0,1.0009,0,0,0,0\n0.001,0,0,0,0.6,0.77,0.2,0.0843,0\n");
    EXPECT_EQ(rows[0].X_WT.rotation.w(), 1.0009);
    EXPECT_EQ(rows[1].X_WT.rotation.coeffs(), Eigen::Vector4d(0.77, 0.2, 0.0843, 0.6));
}

TEST(TrajectoryReader, namesTheMissingColumn) {
    for (const std::string column : {"t_s", "px_m", "py_m", "pz_m", "qw", "qx", "qy", "qz", "buttons"}) {
        std::string header = kHeader;
        header.replace(header.find(column), column.size(), "other");
        expectError(header + "0,0,0,0,1,0,0,0,0\n", "1", "column '" + column + "' is missing");
    }
    expectError("", "0", "is empty");
    expectError("\n\n", "2", "is empty");
}

TEST(TrajectoryReader, saysWhereANumberIsNone) {
    for (const std::string bad : {"abc", "", "1.5x", "nan", "inf", "1e999", "0x10", "1,5"}) {
        const std::string error = errorOf(kHeader + "0,0,0,0,1,0,0,0,0\n1,0," + bad + ",0,1,0,0,0,0\n");
        EXPECT_NE(error.find("test.csv:3: "), std::string::npos) << error;
    }
    expectError(kHeader + "0,0,zero,0,1,0,0,0,0\n", "2", "py_m is 'zero', not a finite number");
    for (const std::string bad : {"-1", "1.0", "4294967296", "x"}) {
        expectError(kHeader + "0,0,0,0,1,0,0,0," + bad + "\n", "2", "buttons is '" + bad + "'");
    }
}

TEST(TrajectoryReader, refusesWrongCellCount) {
    expectError(kHeader + "0,0,0,0,1,0,0,0\n", "2", "has 8 cells, the header has 9");
    expectError(kHeader + "0,0,0,0,1,0,0,0,0,0\n", "2", "has 10 cells");
}

TEST(TrajectoryReader, refusesWhatIsNoRotation) {
    expectError(kHeader + "0,0,0,0,1.0011,0,0,0,0\n", "2", "quaternion");
    expectError(kHeader + "0,0,0,0,0,0,0,0,0\n", "2", "norm 0.000000");
    expectError(kHeader + "0,0,0,0,1e200,1e200,0,0,0\n", "2", "quaternion");
}

TEST(TrajectoryReader, timeMustIncrease) {
    const std::string row = ",0,0,0,1,0,0,0,0\n";
    expectError(kHeader + "0" + row + "0.001" + row + "0.001" + row, "4", "t_s does not increase");
    expectError(kHeader + "1" + row + "\n0" + row, "4", "t_s does not increase");
}

TEST(TrajectoryReader, needsRows) {
    expectError(kHeader + "\n", "2", "no rows");
}

TEST(TrajectoryReader, filesThatCannotBeReadAreUserErrors) {
    EXPECT_THROW(readTrajectory("/no/such/file.csv"), UserError);
    EXPECT_THROW(readTrajectory(std::filesystem::temp_directory_path().string()), UserError);
}

TEST(TrajectoryReader, readsFiles) {
    const TemporaryFile file("trajectory.csv");
    std::ofstream(file.path()) << kHeader << "0,0,0,0,1,0,0,0,1";  // no line end
    EXPECT_EQ(readTrajectory(file.path()).size(), 1u);
}

TEST(TrajectoryReader, anyBytesGiveRowsOrAUserError) {
    std::mt19937 random(5);
    const char bytes[] = "0123456789.,-e\n\r\t nainfx\0\xff";
    const std::string alphabet(bytes, sizeof(bytes) - 1);
    int refused = 0;
    for (int round = 0; round < 3000; ++round) {
        std::string text = round % 2 ? kHeader : "";
        for (size_t i = random() % 200; i > 0; --i) text += alphabet[random() % alphabet.size()];
        try {
            read(text);
        } catch (const UserError&) {
            ++refused;
        }
    }
    EXPECT_GT(refused, 2000);
}

}  // namespace
}  // namespace bonemill
