// What a controller says of itself, or of its handle, that a host does not believe.
#include <gtest/gtest.h>

#include <cmath>

#include "tests/unit/device_daemon/ares/wire/wire_test_tools.h"

namespace bonemill::wire {
namespace {

using test::Bytes;
using test::changed;
using test::Pair;

TEST(Distrust, NumbersThatAreNoneAreCountedApart) {
    Pair pair;
    pair.run(20);
    const Pair::Wire straight = pair.on_state;
    pair.on_state = [](const Bytes& bytes) {
        return std::vector<Bytes>{changed<JointState>(bytes, [](auto& s) { s.q[2] = std::nan(""); })};
    };
    pair.period();
    EXPECT_EQ(pair.host.nonsenseCount(), 1u);
    EXPECT_TRUE(std::isfinite(pair.host.state().q[2]));
    pair.on_state = straight;
    pair.run(5);
    EXPECT_EQ(pair.host.nonsenseCount(), 1u);
    EXPECT_FALSE(pair.host.isLost(pair.now_ns));
}

// A bridge that was started anew, or has changed its arm, in the middle of a session.
TEST(Distrust, AreOverWhenTheControllerDescribesItselfAsAnother) {
    Pair pair;
    pair.run(20);
    const uint32_t session = pair.host.state().header.session;
    const auto describe = [&](double max_force) {
        Describe d = pair.host.description();
        d.max_force = max_force;
        seal(d, session, pair.host.state().header.sequence + 1000);
        pair.host.take(test::copyOf(d), test::kControllerPlace, pair.now_ns);
    };
    const double before = pair.host.description().max_force;
    describe(before);
    EXPECT_TRUE(pair.host.isTrusted()) << "the same again changes nothing";
    pair.run(1);
    Describe other = pair.host.description();
    other.max_force = before / 2;
    seal(other, session, pair.host.state().header.sequence + 2000);
    pair.host.take(test::copyOf(other), {kLoopback, 5555}, pair.now_ns);
    EXPECT_TRUE(pair.host.isTrusted()) << "a stranger";
    seal(other, session + 1, pair.host.state().header.sequence + 2000);
    pair.host.take(test::copyOf(other), test::kControllerPlace, pair.now_ns);
    EXPECT_TRUE(pair.host.isTrusted()) << "another session's";
    seal(other, session, pair.host.state().header.sequence + 2000);
    pair.host.take(test::copyOf(other), test::kControllerPlace, pair.now_ns);
    EXPECT_FALSE(pair.host.isTrusted());
    EXPECT_TRUE(pair.host.isLost(pair.now_ns));
    EXPECT_FALSE(pair.host.hasState());
}

}  // namespace
}  // namespace bonemill::wire
