// A gateway whose service hangs or was killed comes again, and its guests do; one that hangs ends when asked
// to.
#include <gtest/gtest.h>
#include <signal.h>

#include "tests/integration/gateway/gateway_guest.h"
#include "tests/integration/gateway/relayed_gateway.h"

namespace bonemill::gateway {
namespace {

const std::string kTicketToken = "00112233445566778899aabbccddeeff";

class SupervisedGateway : public testing::Test {
  protected:
    SupervisedGateway() { place_.startGateway(), before_ = test::workOf(place_.gatewayProgram()); }
    bool hasNewWork() {
        return test::waitFor([&] {
            const int now = test::workOf(place_.gatewayProgram());
            return now != 0 && now != before_;
        });
    }

    TestServer server_{20};
    RelayedGateway place_{invitationOf("Anna", "VIEWER", kTicketToken)};
    int before_ = 0;
};

TEST_F(SupervisedGateway, ThatHangsOrWasKilledComesAgainAndGuestsComeBackWithTheirTickets) {
    TestGuest first(place_.direct(), kTicketToken, true);
    ASSERT_TRUE(first.isWelcome());
    std::string ticket = first.welcome->ticket();
    for (const int harm : {SIGSTOP, SIGKILL}) {
        ASSERT_GT(before_, 0);
        kill(before_, harm);
        ASSERT_TRUE(hasNewWork()) << "after signal " << harm;
        before_ = test::workOf(place_.gatewayProgram());
        // Its port is there all the time: who comes meanwhile waits.
        TestGuest again(place_.direct(), ticket, true);
        ASSERT_TRUE(again.isWelcome());
        EXPECT_TRUE(again.pollUntil([&] { return again.isComplete() && again.digest().count() == 20; }));
    }
    EXPECT_TRUE(RelayedGateway::hasSaid(place_.gatewayProgram(), "the gateway has not come round for"));
    EXPECT_TRUE(RelayedGateway::hasSaid(place_.gatewayProgram(), "the gateway has ended by signal 9"));
}

TEST_F(SupervisedGateway, ThatHangsEndsWhenAskedTo) {
    kill(before_, SIGSTOP);
    place_.gatewayProgram().signal(SIGTERM);
    place_.gatewayProgram().wait();
    EXPECT_NE(kill(before_, 0), 0) << "nothing is left behind";
    EXPECT_TRUE(RelayedGateway::hasSaid(place_.gatewayProgram(), "does not end when asked to"));
}

}  // namespace
}  // namespace bonemill::gateway
