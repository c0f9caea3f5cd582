#include "render_client/case_window/case_desk/case_desk.h"

#include <gtest/gtest.h>

#include <CLI/CLI.hpp>
#include <fstream>

#include "haptic_server/cases/casework/case_request.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/render_client/case_window/case_desk/desk_scan.h"

namespace bonemill {
namespace {

class Desk : public testing::Test {
  protected:
    Desk() {
        test::writeHead(folder_.path() / "head");
        request_.out = folder_ / "case";
    }
    CaseDesk& open() {
        desk_.emplace(request_, "test", "make-case");
        desk_->open(folder_ / "head");
        test::settle(*desk_);
        return *desk_;
    }
    std::string said() const {
        std::string text;
        for (const DeskLine& line : desk_->lines()) text += line.text + "\n";
        return text;
    }

    test::TemporaryFolder folder_;
    CaseRequest request_;
    std::optional<CaseDesk> desk_;
};

TEST_F(Desk, ChoosesTheSeriesForBoneAndFindsIt) {
    CaseDesk& desk = open();
    ASSERT_EQ(desk.series().size(), 2u) << said();
    ASSERT_TRUE(desk.chosenSeries());
    EXPECT_EQ(desk.series()[*desk.chosenSeries()].uid, test::kBoneSeries);
    EXPECT_EQ(desk.scan()->geometry.dims.z(), 25);
    ASSERT_TRUE(desk.isBoneOfNow()) << said();
    ASSERT_EQ(desk.bone()->pieces.size(), 2u);
    EXPECT_FALSE(desk.surface().empty());
    EXPECT_EQ(desk.whyNotYet(), "");
    desk.chooseSeries(1 - *desk.chosenSeries());
    test::settle(desk);
    EXPECT_EQ(desk.scan()->geometry.dims.z(), 40);
    EXPECT_EQ(desk.request().series, test::kSoftSeries);
}

TEST_F(Desk, BeginsWithWhatTheCommandLineSays) {
    request_.scan = folder_ / "head";
    request_.iso = 500;
    request_.at_mm = {15, 15, 20};
    request_.drop_pieces = {2};
    desk_.emplace(request_, "test", "make-case");
    test::settle(*desk_);
    EXPECT_EQ(desk_->request().series, test::kBoneSeries);
    EXPECT_EQ(desk_->iso(), 500);
    EXPECT_TRUE(desk_->bone()->pieces[1].is_dropped) << said();
    EXPECT_TRUE(desk_->marks().cross_W.isApprox(Eigen::Vector3d(15e-3, 15e-3, 20e-3)));
    EXPECT_EQ(desk_->whyNotYet(), "");
}

TEST_F(Desk, LooksForBoneAnewWhenTheValueMoves) {
    CaseDesk& desk = open();
    const double volume = desk.bone()->pieces[0].volume;
    desk.hold(true);
    desk.setIso(900);
    test::settle(desk);
    EXPECT_FALSE(desk.isBoneOfNow()) << "the slider is still held";
    desk.hold(false);
    test::settle(desk);
    EXPECT_TRUE(desk.isBoneOfNow());
    EXPECT_LT(desk.bone()->pieces[0].volume, volume);
    desk.keepPiece(1, false);
    test::settle(desk);
    EXPECT_TRUE(desk.bone()->pieces[1].is_dropped);
    desk.setIso(5000);
    test::settle(desk);
    EXPECT_TRUE(desk.request().drop_pieces.empty()) << "they are other pieces";
    EXPECT_NE(said().find("iso-value"), std::string::npos) << said();
    EXPECT_NE(desk.whyNotYet(), "");
}

TEST_F(Desk, TheMouseSetsPlaceAndHand) {
    CaseDesk& desk = open();
    desk.moveCross({15e-3, 15e-3, 20e-3});
    desk.millPart(true);
    desk.setSizeMm(8);
    ASSERT_TRUE(desk.plan()) << desk.planProblem();
    EXPECT_GT(desk.plan()->outwards.z(), 0.9);
    const ScanPane axial = paneOver(desk.scanBox(), 2, 200, 200, 1, desk.marks().cross_W);
    const Eigen::Vector2d to = axial.toPixel(Eigen::Vector3d(16e-3, 14e-3, 0));
    desk.drag(Grip::kRegion, axial, to);
    EXPECT_TRUE(desk.marks().region_W->center().isApprox(Eigen::Vector3d(16e-3, 14e-3, 20e-3), 5e-3));
    EXPECT_EQ(desk.request().at_mm[2], 20);
    const ScanPane coronal = paneOver(desk.scanBox(), 1, 200, 200, 1, desk.marks().cross_W);
    const Eigen::Vector3d start = *desk.marks().start_W;
    desk.drag(Grip::kHand, coronal, coronal.toPixel(start + Eigen::Vector3d(20e-3, 0, 2e-3)));
    ASSERT_TRUE(desk.isHandChosen());
    EXPECT_GT(desk.plan()->outwards.x(), 0.9);
    desk.bringHandFromOutside();
    EXPECT_GT(desk.plan()->outwards.z(), 0.9);
    desk.drag(Grip::kRegion, axial, Eigen::Vector2d(2, 2));
    EXPECT_NE(desk.planProblem().find("no bone at"), std::string::npos);
    EXPECT_EQ(desk.whyNotYet(), desk.planProblem());
}

TEST_F(Desk, MakesTheCaseThatItsCommandLineMakes) {
    CaseDesk& desk = open();
    desk.setIso(400);
    desk.moveCross({15e-3, 15e-3, 20e-3});
    desk.millPart(true);
    desk.setSizeMm(8);
    desk.title() = "A ball, from above";
    test::settle(desk);
    const CaseRequest wanted = desk.request();
    const std::string command = desk.commandLine();
    desk.make();
    test::settle(desk);
    ASSERT_FALSE(desk.madeScene().empty()) << said();
    EXPECT_TRUE(std::filesystem::exists(desk.madeScene()));
    EXPECT_NE(said().find("the same by hand: " + command), std::string::npos) << said();
    EXPECT_EQ(desk.out(), folder_ / "case_2") << "the next one";

    CLI::App app;
    CaseRequest read;
    addCaseOptions(app, read);
    std::vector<std::string> words = wordsOf(wanted);
    std::ranges::reverse(words);
    app.parse(words);
    read.out = folder_ / "again/case";
    std::filesystem::create_directory(folder_.path() / "again");
    CaseDesk other(read, "test", "make-case");
    test::settle(other);
    other.make();
    test::settle(other);
    const auto text = [](const std::string& file) {
        std::ifstream in(file);
        return std::string(std::istreambuf_iterator<char>(in), {});
    };
    EXPECT_EQ(text(folder_ / "case/case.textproto"), text(folder_ / "again/case/case.textproto"));
    EXPECT_NE(text(folder_ / "case/case.textproto").find("A ball, from above"), std::string::npos);
}

// Until it works beside the window; what is clicked then waits.
void beginWork(CaseDesk& desk) {
    while (desk.busyWith().empty()) desk.poll();
}

TEST_F(Desk, MakesTheCaseThatWasAskedForWhileItWasBusy) {
    CaseDesk& desk = open();
    desk.setIso(400);
    beginWork(desk);
    ASSERT_TRUE(desk.takesMake()) << desk.whyNotYet();
    desk.make();
    EXPECT_TRUE(desk.waitsToMake());
    test::settle(desk);
    EXPECT_FALSE(desk.madeScene().empty()) << said();
    EXPECT_EQ(desk.bone()->mapping.iso_value, 400);
}

TEST_F(Desk, AsksForNoCaseTwice) {
    CaseDesk& desk = open();
    desk.make();
    beginWork(desk);
    EXPECT_FALSE(desk.takesMake());
    desk.make();
    EXPECT_NE(said().find("being made already"), std::string::npos) << said();
    test::settle(desk);
    EXPECT_FALSE(std::filesystem::exists(folder_ / "case_2"));
}

TEST_F(Desk, SaysWhyACaseThatWasAskedForIsNotMade) {
    CaseDesk& desk = open();
    for (const double too_high : {5000.0, 6000.0}) {
        desk.setIso(too_high);
        beginWork(desk);
        desk.make();
        if (too_high == 6000) desk.open(folder_ / "head");
        test::settle(desk);
        EXPECT_TRUE(desk.madeScene().empty());
        EXPECT_NE(said().find("the case was not made: "), std::string::npos) << said();
    }
    EXPECT_NE(said().find("another scan was opened"), std::string::npos) << said();
}

TEST_F(Desk, KeepsWhatIsTickedWhileItLooksForBone) {
    CaseDesk& desk = open();
    desk.keepPiece(0, false);
    beginWork(desk);
    desk.keepPiece(1, false);
    desk.keepPiece(0, true);
    test::settle(desk);
    EXPECT_FALSE(desk.bone()->pieces[0].is_dropped);
    EXPECT_TRUE(desk.bone()->pieces[1].is_dropped);
    desk.setIso(400);
    beginWork(desk);
    desk.keepPiece(1, false);
    EXPECT_TRUE(desk.request().drop_pieces.empty()) << "they may be other pieces";
    EXPECT_NE(said().find("piece 2 was of another iso-value"), std::string::npos) << said();
}

TEST_F(Desk, SaysWhatIsWrongAndLives) {
    CaseDesk& desk = open();
    desk.open(folder_ / "nowhere");
    test::settle(desk);
    ASSERT_FALSE(desk.lines().empty());
    EXPECT_EQ(desk.lines().back().kind, DeskLine::Kind::kError);
    EXPECT_NE(said().find("no such file"), std::string::npos) << said();
    EXPECT_EQ(desk.whyNotYet(), "open a scan first");
    desk.open(folder_ / "head");
    test::settle(desk);
    EXPECT_EQ(desk.whyNotYet(), "");
    std::filesystem::create_directories(folder_.path() / "case/full");
    desk.make();
    test::settle(desk);
    EXPECT_NE(said().find("is there already"), std::string::npos) << said();
    EXPECT_TRUE(desk.madeScene().empty());
}

TEST(FreeFolder, CountsOn) {
    const test::TemporaryFolder folder;
    EXPECT_EQ(freeFolder(folder.path() / "case"), folder / "case");
    std::filesystem::create_directory(folder.path() / "case");
    std::filesystem::create_directory(folder.path() / "case_2");
    EXPECT_EQ(freeFolder(folder.path() / "case"), folder / "case_3");
}

}  // namespace
}  // namespace bonemill
