// Who may come in: by the file, by the clock, by seats.
#include "render_client/web/gateway/guest_list.h"

#include <gtest/gtest.h>

#include <cmath>

#include "common/base/user_error.h"
#include "common/secrets/secrets.h"
#include "render_client/web/gateway/guest_voice.h"
#include "tests/support/places.h"
#include "tests/support/process.h"

namespace bonemill::gateway {
namespace {

std::string listed(const std::string& name, const std::string& token, int64_t expires_s, int people) {
    return "invitations { name: \"" + name + "\" role: OPERATOR token_sha256: \"" + sha256Hex(token) +
           "\" expires_s: " + std::to_string(expires_s) + " people: " + std::to_string(people) + " }\n";
}

TEST(GuestList, ALinkForSeveralPeopleHasSoManySeats) {
    const test::TemporaryFolder folder;
    test::writeFile(folder / "guests", listed("Class", "secret", 0, 2));
    GuestList list(folder / "guests");
    const Admission first = list.admit("secret", 1), second = list.admit("secret", 1);
    EXPECT_EQ(first.refusal + second.refusal, "");
    EXPECT_EQ(first.name, "Class 1");
    EXPECT_EQ(second.name, "Class 2");
    EXPECT_NE(first.ticket, second.ticket);
    EXPECT_NE(list.admit("secret", 1).refusal, "") << "a third one";
    EXPECT_EQ(list.admit(first.ticket, 1).name, "Class 1") << "comes again";
    GuestList restarted(folder / "guests");
    EXPECT_EQ(restarted.admit(second.ticket, 1).name, "Class 2");
    EXPECT_NE(restarted.admit("secret", 1).refusal, "");
}

TEST(GuestList, ATicketEndsWithItsInvitation) {
    const test::TemporaryFolder folder;
    test::writeFile(folder / "guests", listed("Anna", "secret", 100, 1));
    GuestList list(folder / "guests");
    const Admission anna = list.admit("secret", 99);
    EXPECT_TRUE(list.isInvited(anna.token_sha256, 99));
    EXPECT_FALSE(list.isInvited(anna.token_sha256, 100));
    EXPECT_NE(list.admit(anna.ticket, 100).refusal, "");
    test::writeFile(folder / "guests", "");
    EXPECT_TRUE(list.admit(anna.ticket, 99).is_unknown);
}

// Whoever clicks a link at once must not be told that it is not valid, nor a withdrawn one still be good.
TEST(GuestList, IsThatOfTheMomentWhenSomebodyComes) {
    const test::TemporaryFolder folder;
    GuestList list(folder / "guests");
    test::writeFile(folder / "guests", listed("Anna", "secret", 0, 2));
    EXPECT_EQ(list.admit("secret", 1).name, "Anna 1");
    test::writeFile(folder / "guests", listed("Ottokar", "another", 0, 1));
    EXPECT_TRUE(list.admit("secret", 1).is_unknown);
}

TEST(GuestList, AFileThatMakesNoSenseChangesNothing) {
    const test::TemporaryFolder folder;
    GuestList nobody(folder / "guests");
    EXPECT_EQ(nobody.size(), 0);
    test::writeFile(folder / "guests", listed("Anna", "secret", 0, 1));
    EXPECT_TRUE(nobody.reread());
    EXPECT_FALSE(nobody.reread());
    for (const char* broken : {"nonsense", "invitations { name: \"A\" token_sha256: \"12\" }",
                               "invitations { name: \"A\" role: 77 }"}) {
        test::writeFile(folder / "guests", broken);
        EXPECT_FALSE(nobody.reread()) << broken;
        EXPECT_EQ(nobody.size(), 1);
        EXPECT_THROW(GuestList(folder / "guests"), UserError);
    }
}

TEST(GuestList, TheScriptInvitesAndWithdraws) {
    const test::TemporaryFolder folder;
    const auto invite = [&](std::vector<std::string> arguments) {
        arguments.insert(arguments.begin(),
                         {test::sourceDir() + "/deploy/security/invite", "--guests", folder / "guests"});
        return test::run(arguments);
    };
    const std::string gateway = "https://lab:8443";
    const auto made = invite({"--name", "Anna M\u00fcller", "--role", "examiner", "--gateway", gateway});
    ASSERT_EQ(made.exit_code, 0) << made.err;
    ASSERT_TRUE(made.out.starts_with(gateway + "/#")) << made.out;
    ASSERT_EQ(
        invite({"--name", "Class", "--role", "observer", "--gateway", gateway, "--people", "3"}).exit_code,
        0);
    const std::string token = made.out.substr(gateway.size() + 2, 32);
    EXPECT_EQ(test::readFile(folder / "guests").find(token), std::string::npos);
    GuestList list(folder / "guests");
    EXPECT_EQ(list.size(), 2);
    const Admission anna = list.admit(token, 1);
    EXPECT_EQ(anna.refusal, "");
    EXPECT_EQ(anna.name, "Anna M\u00fcller");
    EXPECT_EQ(anna.role, topics::Viewer::EXAMINER);
    EXPECT_GT(anna.expires_s, 0);
    EXPECT_NE(invite({"--list"}).out.find("Class, observer, 3 at most, until"), std::string::npos);
    EXPECT_NE(invite({"--name", "A\"b", "--role", "observer", "--gateway", gateway}).exit_code, 0);
    EXPECT_NE(invite({"--name", "Class", "--role", "observer", "--gateway", gateway}).exit_code, 0)
        << "is there";
    EXPECT_NE(invite({"--revoke", "Nobody"}).exit_code, 0);
    ASSERT_EQ(invite({"--revoke", "Anna M\u00fcller"}).exit_code, 0);
    EXPECT_TRUE(list.reread());
    EXPECT_FALSE(list.isInvited(anna.token_sha256, 1));
}

TEST(GuestList, WhoIsInvitedAtTheSameTimeAsOthersStays) {
    const test::TemporaryFolder folder;
    const std::string script = "for n in 1 2 3 4 5 6 7 8; do '" + test::sourceDir() +
                               "/deploy/security/invite' --guests '" + (folder / "guests") +
                               "' --name N$n --role observer --gateway https://lab:8443 & done; wait";
    ASSERT_EQ(test::run({"/bin/bash", "-c", script}).exit_code, 0);
    EXPECT_EQ(GuestList(folder / "guests").size(), 8);
}

TEST(GuestFrames, OnlyAHelloMayBeLong) {
    FromGuest hello, wish;
    hello.mutable_hello()->set_token("t");
    for (uint32_t leaf = 0; leaf < 10000; ++leaf) {
        hello.mutable_hello()->add_leaves(leaf);
        hello.mutable_hello()->add_revisions(1);
        wish.mutable_wish()->add_lacking(leaf);
    }
    EXPECT_TRUE(parseFromGuest(hello.SerializeAsString()));
    EXPECT_FALSE(parseFromGuest(wish.SerializeAsString()));
    hello.mutable_hello()->add_leaves(1);
    EXPECT_FALSE(parseFromGuest(hello.SerializeAsString())) << "a leaf without a revision";
    EXPECT_FALSE(parseFromGuest("")) << "says nothing";
}

// Positions that come round again would name the same bricks without end.
TEST(GuestFrames, FewNumbersNameNoMoreBricksThanMany) {
    FromGuest message;
    topics::DensityWish& wish = *message.mutable_wish();
    wish.add_lacking(1);
    for (const uint32_t number : {0u, 16383u}) wish.add_held(number);
    EXPECT_TRUE(parseFromGuest(message.SerializeAsString()));
    for (const uint32_t number : {uint32_t(-16383), 1u}) wish.add_held(number);
    EXPECT_FALSE(parseFromGuest(message.SerializeAsString()));
}

TEST(GuestFrames, ACommandThatTheServerWouldDropIsNone) {
    FromGuest message;
    message.mutable_command()->mutable_add_remark()->set_note(std::string(4000, 'n'));
    EXPECT_TRUE(parseFromGuest(message.SerializeAsString()));
    message.mutable_command()->mutable_add_remark()->set_note(std::string(4100, 'n'));
    EXPECT_FALSE(parseFromGuest(message.SerializeAsString()));
}

TEST(GuestFrames, NumbersAreOnesToComputeWith) {
    FromGuest hand;
    topics::HandPointer& pointer = *hand.mutable_hand();
    pointer.set_is_holding(true);
    for (const double value : {0.1, 0.2, 0.3}) pointer.add_p_wt_m(value);
    for (const double value : {1.0, 0.0, 0.0, 0.0}) pointer.add_q_wt(value);
    EXPECT_TRUE(parseFromGuest(hand.SerializeAsString()));
    pointer.set_q_wt(0, 2);
    EXPECT_FALSE(parseFromGuest(hand.SerializeAsString()));
    pointer.set_q_wt(0, 1);
    pointer.set_p_wt_m(1, std::nan(""));
    EXPECT_FALSE(parseFromGuest(hand.SerializeAsString()));
}

}  // namespace
}  // namespace bonemill::gateway
