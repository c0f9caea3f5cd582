#include "render_client/case_window/case_desk/structure_list.h"

#include <gtest/gtest.h>

#include "tests/unit/haptic_server/scans/import/expect_user_error.h"
#include "tests/unit/haptic_server/scans/import/grid_scan.h"

namespace bonemill {
namespace {

RawVolume mapOf(const std::function<double(const Eigen::Vector3d&)>& value) {
    VolumeGeometry grid;
    grid.dims = {10, 4, 4};
    grid.spacing = Eigen::Vector3d::Ones();
    return scanOf(grid, value);
}

TEST(StructureList, HasARowPerNumber) {
    std::vector<StructureRow> rows = structuresOf(mapOf([](const Eigen::Vector3d& p) {
        return p.x() > 7 ? 12 : p.x() > 5 ? 3 : 0;
    }));
    ASSERT_EQ(rows.size(), 2u);
    EXPECT_EQ(rows[0].number, 3u);
    EXPECT_EQ(rows[1].labels, std::vector<uint32_t>{12});
    EXPECT_TRUE(labelWordsOf(rows).empty()) << "all are ignored at first";
    rows[0].use = StructureUse::kProtected;
    rows[0].name = "facial nerve";
    rows[1].use = StructureUse::kTarget;
    rows[1].name = "";
    EXPECT_EQ(labelWordsOf(rows), std::vector<std::string>{"3=facial nerve:protected"});
    rows[1].name = "caries";
    EXPECT_EQ(labelWordsOf(rows)[1], "12=caries:target");
}

TEST(StructureList, NamesSegmentsAsTheirFileDoes) {
    RawVolume map = mapOf([](const Eigen::Vector3d&) { return 0; });
    map.segments.list = {{"sinus", std::nullopt, {1}}, {"nerve", std::nullopt, {2, 3}}};
    std::vector<StructureRow> rows = structuresOf(map);
    ASSERT_EQ(rows.size(), 2u);
    rows[1].use = StructureUse::kShown;
    EXPECT_EQ(labelWordsOf(rows), std::vector<std::string>{"nerve"});
}

TEST(StructureList, TakesWhatTheCommandLineSays) {
    std::vector<StructureRow> rows = structuresOf(mapOf([](const Eigen::Vector3d& p) {
        return p.x() > 7 ? 12 : p.x() > 5 ? 3 : 0;
    }));
    const std::vector<std::string> words{"12=caries:target"};
    takeWords(words, rows);
    EXPECT_EQ(labelWordsOf(rows), words);
}

TEST(StructureList, RefusesWhatIsNoLabelMap) {
    expectUserError([] { structuresOf(mapOf([](const Eigen::Vector3d& p) { return p.x() + 0.5; })); },
                    {"no label map"});
    expectUserError([] { structuresOf(mapOf([](const Eigen::Vector3d&) { return -3; })); }, {"no label map"});
}

}  // namespace
}  // namespace bonemill
