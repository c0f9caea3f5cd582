// The triangles alone tell where the parts of the head-up display stand.
#include "render_client/look/hud/hud_layout.h"

#include <gtest/gtest.h>

#include <algorithm>

#include "render_client/look/hud/hud_signs.h"

namespace bonemill {
namespace {

constexpr float kEm = 15;

class HudLayout : public testing::Test {
  protected:
    struct Extent {
        float left, right;
    };
    Extent extentSince(size_t first) const {
        const auto is_left = [](const auto& a, const auto& b) { return a.x < b.x; };
        const auto [low, high] = std::minmax_element(canvas_.vertices().begin() + std::ptrdiff_t(first),
                                                     canvas_.vertices().end(), is_left);
        return {low->x, high->x};
    }

    FontAtlas font_{kEm};
    HudCanvas canvas_{font_};
    const std::vector<HudRow> watchers_{{"Anna", "operator, 60 Hz"}};
};

TEST_F(HudLayout, AnotherLineMakesTheFiguresTaller) {
    Hud hud;
    hud.title = "skull";
    hud.rows = {{"Force", "5.00 N"}};
    const HudBox one = layOutFigures(canvas_, hud);
    hud.rows.push_back({"Torque", "12.0 N\u00b7mm"});
    const HudBox two = layOutFigures(canvas_, hud);
    EXPECT_NEAR(two.bottom - one.bottom, 1.5f * kEm, 1e-3f);
}

TEST_F(HudLayout, NoTextMakesTheFiguresWider) {
    Hud hud;
    hud.rows = {{"Force", "5.00 N"}};
    const HudBox small = layOutFigures(canvas_, hud);
    hud.state = hud.rows[0].value = std::string(300, 'w');
    const size_t first = canvas_.vertices().size();
    const HudBox large = layOutFigures(canvas_, hud);
    EXPECT_EQ(large.right, small.right);
    EXPECT_EQ(large.bottom, small.bottom);
    EXPECT_LE(extentSince(first).right, small.right + 1);
    const HudBox with_details = layOutDetails(canvas_, {{"Loop", std::string(300, 'w')}}, small);
    EXPECT_EQ(with_details.right, small.right);
    EXPECT_GT(with_details.bottom, small.bottom);
    EXPECT_LE(extentSince(first).right, small.right + 1);
}

TEST_F(HudLayout, ATitleIsReadWholeWithinBounds) {
    Hud hud;
    hud.rows = {{"Force", "5.00 N"}};
    hud.title = "Tooth";
    const HudBox usual = layOutFigures(canvas_, hud);
    hud.title = "Temporal bone, left (phantom)";
    const HudBox wider = layOutFigures(canvas_, hud);
    EXPECT_GE(wider.right - wider.left, canvas_.width(hud.title, FontStyle::kBold));
    EXPECT_GT(wider.right, usual.right);
    hud.title = std::string(300, 'w');
    const size_t first = canvas_.vertices().size();
    const HudBox widest = layOutFigures(canvas_, hud);
    EXPECT_LE(widest.right, 2 * usual.right);
    EXPECT_LE(extentSince(first).right, widest.right + 1);
}

TEST_F(HudLayout, ALongNameOfAWatcherIsCutShort) {
    const HudBox figures{16, 16, 220, 300};
    layOutWatchers(canvas_, watchers_, figures, {800, 600});
    const float left = extentSince(0).left;
    const size_t first = canvas_.vertices().size();
    layOutWatchers(canvas_, {{std::string(99, 'w'), std::string(99, 'w')}}, figures, {800, 600});
    EXPECT_EQ(extentSince(first).left, left);
    EXPECT_LT(extentSince(first).right, 800);
}

TEST_F(HudLayout, WatchersStandBesideTheFiguresOrBelowThem) {
    const HudBox figures{16, 16, 220, 300};
    layOutWatchers(canvas_, watchers_, figures, {800, 600});
    EXPECT_GT(extentSince(0).left, figures.right);
    EXPECT_LT(extentSince(0).right, 800);
    const size_t first = canvas_.vertices().size();
    layOutWatchers(canvas_, watchers_, figures, {300, 600});
    EXPECT_LT(extentSince(first).left, figures.right);
    EXPECT_GT(canvas_.vertices()[first].y, figures.bottom - 1);
}

TEST_F(HudLayout, AHintStandsBelowTheFiguresOrBesideThem) {
    const HudBox figures{16, 16, 220, 300};
    const HudHint hint{{{"Wheel", "deeper"}, {"G", "let go"}}, 0.25f};
    layOutHint(canvas_, hint, figures, {800, 600});
    EXPECT_LT(extentSince(0).left, figures.right);
    EXPECT_GT(canvas_.vertices().front().y, figures.bottom);
    EXPECT_LT(canvas_.vertices().front().a, 0.25f) << "it fades";
    const size_t first = canvas_.vertices().size();
    layOutHint(canvas_, hint, figures, {800, 320});
    EXPECT_GT(extentSince(first).left, figures.right);
}

TEST_F(HudLayout, TheHelpPageGetsSmallerTextWhereItWouldNotFit) {
    const std::vector<HudRow> rows(8, HudRow{"Shift+X", "cut away the other side"});
    const std::vector<HelpGroup> groups(5, HelpGroup{"Cut-planes", rows});
    EXPECT_EQ(helpTextHeight(font_, groups, {1600, 1200}), kEm);
    EXPECT_LT(helpTextHeight(font_, groups, {480, 360}), kEm);
    layOutHelp(canvas_, groups, {1600, 1200});
    EXPECT_GT(extentSince(0).left, 0);
    EXPECT_LT(extentSince(0).right, 1600);
}

TEST_F(HudLayout, AHelpPageThatFitsInNoTextLeavesItsLastGroupsOut) {
    const std::vector<HudRow> rows(8, HudRow{"Shift+X", "cut away the other side"});
    const std::vector<HelpGroup> groups(40, HelpGroup{"Cut-planes", rows});
    const PictureSize small{480, 300};
    const auto fitting = helpThatFits(font_, groups, small);
    EXPECT_GT(fitting.size(), 1u);
    EXPECT_LT(fitting.size(), groups.size());
    EXPECT_EQ(helpThatFits(font_, {groups[0]}, small).size(), 1u);
    EXPECT_EQ(helpThatFits(font_, groups, {16000, 1200}).size(), groups.size());
}

TEST(FontAtlas, AnUnknownSignIsAQuestionMark) {
    const FontAtlas font(kEm);
    EXPECT_EQ(font.glyph(0x1f600, FontStyle::kPlain).u0, font.glyph('?', FontStyle::kPlain).u0);
    EXPECT_GT(font.width("Ww", FontStyle::kBold), font.width("il", FontStyle::kBold));
}

}  // namespace
}  // namespace bonemill
