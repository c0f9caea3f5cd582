#include "haptic_server/recording/export/export_journal.h"

#include <gtest/gtest.h>

#include <fstream>
#include <nlohmann/json.hpp>

#include "common/base/user_error.h"
#include "common/text/hex_text.h"
#include "haptic_server/lab/simulate/simulate.h"
#include "tests/support/recorded_session.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/haptic_server/recording/export/h5_reader.h"

namespace bonemill {
namespace {

class ExportTest : public testing::Test {
  protected:
    std::vector<std::string> linesOf(const std::string& path) const {
        std::vector<std::string> lines;
        std::ifstream file(path);
        for (std::string line; std::getline(file, line);) lines.push_back(line);
        return lines;
    }
    test::TemporaryFolder folder_;
};

TEST_F(ExportTest, Hdf5HasEveryTickWithUnits) {
    const test::RecordedSession session = test::recordSession(folder_.path());
    exportJournal({.journal = session.journal, .h5 = folder_ / "s.h5", .csv = folder_ / "s.csv", .traj = ""});
    const test::H5Reader file(folder_ / "s.h5");
    const auto position = file.reals("/tick/tool_p_m");
    ASSERT_EQ(position.shape, (std::vector<size_t>{3000, 3}));
    for (size_t tick = 0; tick < 3000; ++tick)
        ASSERT_EQ(position.values[3 * tick], session.x_m[tick]) << tick;
    EXPECT_EQ(file.reals("/tick/force_n").shape, (std::vector<size_t>{3000, 3}));
    EXPECT_EQ(file.text("/tick/force_n", "unit"), "N");
    EXPECT_NE(file.text("/tick/force_n", "description").find("W"), std::string::npos);
    EXPECT_EQ(file.text("/", "tools"), "ball\nsmall");
    EXPECT_FALSE(file.has("/tick/temperature_c")) << "the scene has no heat";
    const auto tools = file.reals("/tick/tool_index").values;
    EXPECT_EQ(tools[test::kTickOfOtherTool - 1], 0);
    EXPECT_EQ(tools[test::kTickOfOtherTool], 1);
    const auto texts = file.texts("/events/text");
    const auto times = file.reals("/events/t_s").values;
    ASSERT_EQ(texts.size(), times.size());
    EXPECT_TRUE(std::ranges::is_sorted(times));
    EXPECT_NE(std::ranges::find_if(
                  texts, [](const auto& t) { return t.find("select_tool 1") != std::string::npos; }),
              texts.end());
    const std::vector<std::string> lines = linesOf(folder_ / "s.csv");
    ASSERT_EQ(lines.size(), 3001u);
    EXPECT_EQ(lines[0].substr(0, 15), "t_s,spo_px_m,sp");
    const std::string row = lines[1501];
    EXPECT_EQ(std::stod(row.substr(row.find(',') + 1)), session.x_m[1500]);
}

TEST_F(ExportTest, TheTrajectoryComesToTheSameBitsInSimulate) {
    const test::RecordedSession session =
        test::recordSession(folder_.path(), {.ticks = test::kTickOfReset, .has_orders = true});
    exportJournal({.journal = session.journal, .h5 = "", .csv = "", .traj = folder_ / "t.csv"});
    const SimulateResult result = simulate(
        {.scene = session.scene, .trajectory = folder_ / "t.csv", .tool = "", .trace = "", .save = {}});
    EXPECT_EQ(nlohmann::json::parse(result.json)["state_hash"], hexText(session.state_hash));
}

TEST_F(ExportTest, TheTrajectoryEndsWhereTheBoneIsPutBack) {
    const test::RecordedSession session = test::recordSession(folder_.path());
    exportJournal({.journal = session.journal, .h5 = "", .csv = "", .traj = folder_ / "t.csv"});
    EXPECT_EQ(linesOf(folder_ / "t.csv").size(), 1 + test::kTickOfReset);
}

TEST_F(ExportTest, RefusesWhatCannotBe) {
    const test::RecordedSession session = test::recordSession(folder_.path(), {.ticks = 300});
    EXPECT_THROW(exportJournal({.journal = session.journal, .h5 = "", .csv = "", .traj = ""}), UserError);
    EXPECT_THROW(exportJournal({.journal = session.journal, .h5 = session.journal, .csv = "", .traj = ""}),
                 UserError);
    EXPECT_THROW(
        exportJournal({.journal = folder_ / "no.mcap", .h5 = folder_ / "a.h5", .csv = "", .traj = ""}),
        UserError);
    EXPECT_THROW(
        exportJournal({.journal = session.journal, .h5 = folder_ / "no/a.h5", .csv = "", .traj = ""}),
        UserError);
    std::ofstream(folder_ / "slab.nrrd") << "gone";
    EXPECT_THROW(exportJournal({.journal = session.journal, .h5 = folder_ / "a.h5", .csv = "", .traj = ""}),
                 UserError);
}

}  // namespace
}  // namespace bonemill
