#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "common/base/user_error.h"
#include "common/process/gnuplot.h"
#include "haptic_server/lab/accuracy_report/report_files.h"
#include "tests/unit/haptic_server/lab/accuracy_report/report_data.h"

namespace bonemill {
namespace {

class Plot : public testing::Test {
  protected:
    Plot() { std::filesystem::create_directories(folder_); }
    ~Plot() override { std::filesystem::remove_all(folder_); }

    std::filesystem::path folder_ =
        testing::TempDir() + "/accuracy_plot \"quoted\" test " + std::to_string(getpid());
};

TEST_F(Plot, ScriptGivesAPng) {
    ReportData data = test::smallReport();
    data.scene = "a \"scene\" with_marks $1";
    data.budget_us = 60;
    writeTextFile(folder_ / "p.gnuplot", paretoScript(data, "p.png"));
    runGnuplot(folder_ / "p.gnuplot");
    std::ifstream png(folder_ / "p.png", std::ios::binary);
    char head[8] = {};
    png.read(head, sizeof head);
    EXPECT_EQ(std::string(head, 8), "\x89PNG\r\n\x1a\n");
}

TEST_F(Plot, ABrokenScriptIsSaid) {
    writeTextFile(folder_ / "p.gnuplot", "plot nonsense of this kind\n");
    EXPECT_THROW(runGnuplot(folder_ / "p.gnuplot"), UserError);
}

TEST_F(Plot, WithoutGnuplotItSaysSo) {
    const char* const path = getenv("PATH");
    const std::string before = path ? path : "";
    setenv("PATH", folder_.c_str(), 1);
    try {
        runGnuplot(folder_ / "p.gnuplot");
        ADD_FAILURE();
    } catch (const UserError& error) {
        EXPECT_NE(std::string(error.what()).find("gnuplot cannot be run"), std::string::npos) << error.what();
    }
    setenv("PATH", before.c_str(), 1);
}

}  // namespace
}  // namespace bonemill
