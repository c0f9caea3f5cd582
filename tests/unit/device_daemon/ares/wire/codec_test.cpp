#include <gtest/gtest.h>

#include <cmath>
#include <cstring>
#include <limits>

#include "device_daemon/ares/wire/packets.h"
#include "tests/unit/device_daemon/ares/wire/wire_test_tools.h"

namespace bonemill::wire {
namespace {

constexpr float kNan = std::numeric_limits<float>::quiet_NaN();

template <class Packet>
class Codec : public testing::Test {};
using AllPackets =
    testing::Types<JointState, JointCommand, DescribeRequest, Describe, PoseState, PoseCommand>;
TYPED_TEST_SUITE(Codec, AllPackets);

template <class Packet>
test::Bytes sealed(Packet packet) {
    seal(packet, 5, 9);
    return test::copyOf(packet);
}

TYPED_TEST(Codec, OpensWhatItHasSealed) {
    TypeParam packet{};
    packet.header.session = 1;
    const auto opened = open<TypeParam>(sealed(packet));
    ASSERT_TRUE(opened);
    EXPECT_EQ(opened->header.session, 5u);
    EXPECT_EQ(opened->header.sequence, 9u);
    EXPECT_EQ(opened->header.length, sizeof(TypeParam));
}

TYPED_TEST(Codec, RefusesEveryFlippedBitAndEveryOtherLength) {
    const test::Bytes valid = sealed(TypeParam{});
    for (size_t bit = 0; bit < valid.size() * 8; ++bit) {
        test::Bytes bytes = valid;
        bytes[bit / 8] ^= std::byte(1u << bit % 8);
        EXPECT_FALSE(open<TypeParam>(bytes)) << bit;
    }
    for (size_t size = 0; size < kMaxPacket; ++size) {
        test::Bytes bytes = valid;
        bytes.resize(size);
        EXPECT_EQ(open<TypeParam>(bytes).has_value(), size == valid.size()) << size;
    }
}

TYPED_TEST(Codec, RefusesPacketsOfOtherTypes) {
    const test::Bytes other = sealed(JointCommand{}), command = sealed(PoseCommand{});
    EXPECT_EQ(open<TypeParam>(other).has_value(), (std::is_same_v<TypeParam, JointCommand>));
    EXPECT_EQ(open<TypeParam>(command).has_value(), (std::is_same_v<TypeParam, PoseCommand>));
}

TEST(CodecOfNumbers, RefusesWhatIsNotFinite) {
    for (const float bad : {kNan, std::numeric_limits<float>::infinity()}) {
        JointState joints{};
        joints.q[3] = bad;
        EXPECT_FALSE(open<JointState>(sealed(joints)));
        joints.q[3] = 0;
        joints.qd[5] = bad;
        EXPECT_FALSE(open<JointState>(sealed(joints)));
        JointCommand command{};
        command.force[0] = bad;
        EXPECT_FALSE(open<JointCommand>(sealed(command)));
        Describe description{};
        description.stroke = bad;
        EXPECT_FALSE(open<Describe>(sealed(description)));
        PoseCommand wrench{};
        wrench.wrench[5] = bad;
        EXPECT_FALSE(open<PoseCommand>(sealed(wrench)));
    }
}

TEST(CodecOfNumbers, LetsAPoseSayNothingOfMotionOrForce) {
    PoseState pose{};
    pose.v_DT[0] = kNan;
    EXPECT_FALSE(open<PoseState>(sealed(pose))) << "a part of the velocity";
    for (float& v : pose.v_DT) v = kNan;
    EXPECT_FALSE(open<PoseState>(sealed(pose))) << "the linear velocity alone";
    for (float& w : pose.w_DT) w = kNan;
    EXPECT_TRUE(open<PoseState>(sealed(pose)));
    pose.applied[2] = kNan;
    EXPECT_FALSE(open<PoseState>(sealed(pose))) << "a part of the wrench";
    for (float& f : pose.applied) f = kNan;
    EXPECT_TRUE(open<PoseState>(sealed(pose)));
    pose.v_DT[0] = std::numeric_limits<float>::infinity();
    EXPECT_FALSE(open<PoseState>(sealed(pose)));
}

TEST(CodecOfText, RefusesANameWithoutEnd) {
    Describe description{};
    std::memset(description.name, 'x', sizeof(description.name));
    EXPECT_FALSE(open<Describe>(sealed(description)));
    description.name[47] = 0;
    EXPECT_TRUE(open<Describe>(sealed(description)));
}

TEST(SequenceNumbers, AreNewerByLessThanHalfTheirRange) {
    EXPECT_FALSE(isNewer(5, 5));
    EXPECT_TRUE(isNewer(6, 5));
    EXPECT_FALSE(isNewer(5, 6));
    EXPECT_TRUE(isNewer(0, 0xffffffff));
    EXPECT_TRUE(isNewer(0x7fffffff, 0));
    EXPECT_FALSE(isNewer(0x80000000, 0));
}

}  // namespace
}  // namespace bonemill::wire
