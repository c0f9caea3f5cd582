#include "haptic_server/cases/casework/case_figures.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <cmath>
#include <fstream>

#include "haptic_server/cases/casework/pieces_figure.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/haptic_server/scans/import/grid_scan.h"

namespace bonemill {
namespace {

// Two balls of bone in air, the smaller one in front of the other, below and to the patient's left; and a
// speck.
RawVolume twoBalls() {
    VolumeGeometry grid;
    grid.dims = {60, 80, 50};
    grid.spacing = {1e-3, 1e-3, 1.5e-3};
    return scanOf(grid, [](const Eigen::Vector3d& p) {
        if ((p - Eigen::Vector3d(5, 70, 60) * 1e-3).norm() < 0.5e-3) return 1500.0;
        const double d = std::min((p - Eigen::Vector3d(20, 50, 45) * 1e-3).norm() - 15e-3,
                                  (p - Eigen::Vector3d(40, 15, 20) * 1e-3).norm() - 8e-3);
        return std::round(std::clamp(300 - 600 * d / 1e-3, -1000.0, 1500.0));
    });
}

CasePlan planOf(const RawVolume& scan, std::vector<uint32_t> dropped = {}, double iso = 300) {
    CaseRequest request;
    request.iso = iso;
    request.drop_pieces = std::move(dropped);
    return planCase(scan, request);
}

bool contains(const std::string& text, const std::string& part) {
    return text.find(part) != std::string::npos;
}

const Colour kRed(200, 0, 0), kGreen(0, 200, 0);

TEST(PieceView, ShowsTheNearestPieceWhereItLies) {
    const Eigen::AlignedBox3d box(Eigen::Vector3d::Zero(), Eigen::Vector3d(4, 10, 3));
    PieceView front({0, 2, 1, -1}, box, 1);  // from -y, z up
    const Eigen::Vector3d half = Eigen::Vector3d::Constant(0.5);
    front.add(0, {0.5, 2.5, 2.5}, half);
    front.add(1, {0.5, 7.5, 2.5}, half);  // behind it
    front.add(1, {3.5, 7.5, 0.5}, half);
    EXPECT_EQ(front.width(), 4);
    EXPECT_EQ(front.height(), 3);
    const std::vector<uint8_t> rgb = front.rgb(std::vector<Colour>{kRed, kGreen});
    ASSERT_EQ(rgb.size(), 3u * 4 * 3);
    const auto at = [&](int column, int row, int channel) {
        return int(rgb[size_t(3 * (column + 4 * row) + channel)]);
    };
    EXPECT_GT(at(0, 2, 0), 100);
    EXPECT_EQ(at(0, 2, 1), 0) << "the other one is hidden";
    EXPECT_GT(at(3, 0, 1), 100);
    EXPECT_EQ(at(1, 1, 0), 255) << "white, where nothing is";
    const std::vector<PieceView::Pixel> labels = front.labelsOf(3);
    EXPECT_EQ(labels[1].column, 3);
    EXPECT_EQ(labels[1].row, 0);
    EXPECT_LT(labels[2].column, 0);
}

TEST(PieceView, FillsWhatAVoxelCovers) {
    const Eigen::AlignedBox3d box(Eigen::Vector3d::Zero(), Eigen::Vector3d(4, 4, 6));
    PieceView left({1, 2, 0, 1}, box, 1);
    left.add(0, {2, 2, 3}, {1, 1, 3});
    const std::vector<uint8_t> rgb = left.rgb(std::vector<Colour>{kRed});
    int red = 0;
    for (size_t n = 0; n < rgb.size(); n += 3) red += rgb[n + 1] == 0;
    EXPECT_EQ(red, 2 * 6);
}

// The label stands on the piece, also where the piece is bent round its own middle.
TEST(PieceView, NumbersAPieceOnItself) {
    const Eigen::AlignedBox3d box(Eigen::Vector3d::Zero(), Eigen::Vector3d(9, 9, 1));
    PieceView top({0, 1, 2, 1}, box, 1);
    for (int n = 0; n < 9; ++n) {
        top.add(0, {n + 0.5, 0.5, 0.5}, Eigen::Vector3d::Constant(0.5));
        top.add(0, {0.5, n + 0.5, 0.5}, Eigen::Vector3d::Constant(0.5));
    }
    const PieceView::Pixel label = top.labelsOf(1)[0];
    EXPECT_TRUE(label.column == 0 || label.row == 0) << label.column << ", " << label.row;
}

TEST(CaseFigures, NumberThePiecesAsDropPieceDoes) {
    const RawVolume scan = twoBalls();
    const PiecesFigure figure = piecesFigure(scan, planOf(scan));
    ASSERT_EQ(figure.pictures.size(), 3u);
    EXPECT_TRUE(contains(figure.script, "1:  1")) << figure.script;
    EXPECT_TRUE(contains(figure.script, "2:  2")) << figure.script;
    EXPECT_FALSE(contains(figure.script, "3:  ")) << "noise";
    EXPECT_TRUE(contains(figure.script, "from the left"));
    // From the front the small ball is to the right and below.
    const size_t front = figure.script.find("from the front"), left = figure.script.find("from the left");
    const std::string of_front = figure.script.substr(front, left - front);
    const auto placeOf = [&](const std::string& number) {
        Eigen::Vector2d place(0, 0);
        const size_t at = of_front.find("set label \"" + number + "\" at ");
        EXPECT_NE(at, std::string::npos);
        std::sscanf(of_front.c_str() + at, "set label \"%*d\" at %lf,%lf", &place.x(), &place.y());
        return place;
    };
    EXPECT_LT((placeOf("1") - Eigen::Vector2d(20, 45)).norm(), 2.5);
    EXPECT_LT((placeOf("2") - Eigen::Vector2d(40, 20)).norm(), 2);
    int columns = 0, rows = 0;
    const size_t array = of_front.find("array=(");
    ASSERT_NE(array, std::string::npos);
    std::sscanf(of_front.c_str() + array, "array=(%d,%d)", &columns, &rows);
    EXPECT_EQ(figure.pictures[1].rgb.size(), 3 * size_t(columns) * size_t(rows));
}

TEST(CaseFigures, ShowWhatIsLeftOutPaler) {
    const RawVolume scan = twoBalls();
    const PiecesFigure whole = piecesFigure(scan, planOf(scan)), less = piecesFigure(scan, planOf(scan, {2}));
    EXPECT_TRUE(contains(less.script, "left out"));
    EXPECT_FALSE(contains(whole.script, "left out"));
    const auto mean = [](const std::vector<uint8_t>& rgb) {
        double sum = 0;
        for (const uint8_t channel : rgb) sum += channel;
        return sum / double(rgb.size());
    };
    EXPECT_GT(mean(less.pictures[1].rgb), mean(whole.pictures[1].rgb) + 1);
}

TEST(CaseFigures, NameNoSideThatNobodyKnows) {
    RawVolume scan = twoBalls();
    scan.lacks_patient_axes = true;
    const PiecesFigure figure = piecesFigure(scan, planOf(scan));
    EXPECT_TRUE(contains(figure.script, "seen along y"));
    EXPECT_FALSE(contains(figure.script, "front\"\n"));
    EXPECT_FALSE(contains(figure.script, "to the left"));
}

TEST(CaseFigures, MarkTheIsoValues) {
    const RawVolume scan = twoBalls();
    CaseRequest request;
    const CasePlan proposed = planCase(scan, request);
    const std::string own = histogramScript(scan, proposed);
    EXPECT_TRUE(contains(own, "(proposed, ")) << own;
    EXPECT_FALSE(contains(own, "as asked for"));
    EXPECT_TRUE(contains(own, "window_low -1000"));
    EXPECT_TRUE(contains(own, "window_high 1500"));
    const std::string other = histogramScript(scan, planOf(scan, {}, 444));
    EXPECT_TRUE(contains(other, "iso-value 444 (as asked for)"));
    EXPECT_TRUE(contains(other, "(proposed, "));
}

// One value that is far off would leave all others one bin.
TEST(CaseFigures, CountValuesWhereTheyAre) {
    const RawVolume clean = twoBalls();
    std::vector<float> values;
    for (size_t n = 0; n < clean.values.size(); ++n) values.push_back(clean.values[n]);
    values[7] = 1e6f;
    RawVolume scan;
    scan.geometry = clean.geometry;
    scan.values.append(std::span<const float>(values));
    const std::string script = histogramScript(scan, planOf(scan));
    const size_t begin = script.find('\n'), end = script.find("END_OF_DATA\n", begin);
    EXPECT_GT(std::count(script.begin() + ptrdiff_t(begin), script.begin() + ptrdiff_t(end), '\n'), 50);
}

TEST(CaseFigures, AreFilesForGnuplot) {
    const test::TemporaryFolder folder;
    const RawVolume scan = twoBalls();
    writeFigures(folder / "figures", scan, planOf(scan));
    for (const char* const file : {"histogram.gp", "pieces.gp", "top.rgb", "front.rgb", "left.rgb"})
        EXPECT_TRUE(std::filesystem::exists(folder / (std::string("figures/") + file))) << file;
}

}  // namespace
}  // namespace bonemill
