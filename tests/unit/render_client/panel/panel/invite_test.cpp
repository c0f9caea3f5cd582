// Invites a colleague in the control panel with a simulated mouse and keyboard, without OpenGL.
#include <gtest/gtest.h>

#include "render_client/panel/panel/qr_code.h"
#include "tests/support/controlled_panel.h"

namespace bonemill {
namespace {

class PanelInvite : public testing::Test, protected test::ControlledPanel {
  protected:
    PanelInvite() {
        switchPanel();
        show();
    }
    void show() {
        for (int n = 0; n < 3; ++n) layOut(900, 2400);
    }
    void click(const std::string& label) {
        show();
        clickAt(label);
        show();
    }
};

TEST_F(PanelInvite, IsThereWhereTheLauncherIs) {
    EXPECT_FALSE(panel_.find("Invite"));
    session_.has_launcher = true;
    show();
    EXPECT_TRUE(panel_.find("Invite"));
}

TEST_F(PanelInvite, ANameAndAClickAreAWish) {
    session_.has_launcher = true;
    click("Invite");
    EXPECT_EQ(wishes_.invite, "") << "nobody";
    click("##guest");
    for (const char sign : std::string("Anna")) EXPECT_TRUE(send(TextEvent{char32_t(sign)}));
    show();
    click("Invite");
    EXPECT_EQ(wishes_.invite, "Anna");
    EXPECT_EQ(wishes_.invite_as, "observer");
}

TEST_F(PanelInvite, TheLinkCanBeCopiedAndTheProblemIsSaid) {
    session_.has_launcher = true;
    session_.invitation = {.name = "Anna", .link = {}, .problem = {}};
    show();
    EXPECT_FALSE(panel_.find("Copy the link"));
    session_.invitation.link = "https://lab-pc:8443/#0123456789abcdef0123456789abcdef";
    show();
    EXPECT_TRUE(panel_.find("Copy the link"));
    session_.invitation.problem = "No link: is invited already";
    show();
    EXPECT_FALSE(panel_.find("Copy the link"));
}

// The three corners that a camera looks for are rings of seven squares around a dark middle.
TEST(QrCode, HasTheCornersOfACode) {
    const QrCode code = qrCodeOf("https://lab-pc:8443/#0123456789abcdef0123456789abcdef");
    ASSERT_GE(code.width, 21);
    EXPECT_EQ((code.width - 17) % 4, 0);
    ASSERT_EQ(code.is_dark.size(), size_t(code.width) * size_t(code.width));
    const auto isDark = [&](int x, int y) { return bool(code.is_dark[size_t(y * code.width + x)]); };
    for (const auto& [left, top] : {std::pair{0, 0}, {code.width - 7, 0}, {0, code.width - 7}})
        for (int x = 0; x < 7; ++x)
            for (int y = 0; y < 7; ++y) {
                const int ring = std::max(std::abs(x - 3), std::abs(y - 3));
                EXPECT_EQ(isDark(left + x, top + y), ring != 2) << x << ' ' << y;
            }
    EXPECT_EQ(qrCodeOf(std::string(5000, 'x')).width, 0) << "too long";
}

}  // namespace
}  // namespace bonemill
