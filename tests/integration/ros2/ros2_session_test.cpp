// A session, read by two nodes of ROS 2: one of Cyclone DDS with the types of proto/ros2.idl, and one of Fast
// DDS that knows only the names and takes the bytes apart by the published definitions.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <cmath>
#include <map>
#include <optional>
#include <set>

#include "common/ares_kinematics/ares_kinematics.h"
#include "common/ros/ros_endpoint.h"
#include "tests/integration/ros2/fast_peer.h"
#include "tests/integration/ros2/ros_session.h"

namespace bonemill {
namespace {

using test::CdrBytes;
using Bytes = std::vector<uint8_t>;
using Numbers = std::vector<double>;

struct Stamped {
    std::string frame;
    Numbers numbers;
    bool operator==(const Stamped&) const = default;
};
using ByStamp = std::map<int64_t, Stamped>;

struct Header {
    int64_t stamp_ns;
    std::string frame;
};

Header headerOf(CdrBytes& cdr) {
    const int64_t seconds = cdr.i32();
    const int64_t stamp_ns = seconds * 1'000'000'000 + cdr.u32();
    return {stamp_ns, cdr.text()};
}

// PoseStamped has seven numbers behind its header, TwistStamped and WrenchStamped six.
void takeStamped(const Bytes& bytes, size_t numbers, ByStamp& out) {
    CdrBytes cdr(bytes);
    const Header header = headerOf(cdr);
    Stamped stamped{header.frame, {}};
    for (size_t i = 0; i < numbers; ++i) stamped.numbers.push_back(cdr.f64());
    ASSERT_TRUE(cdr.isWhole());
    EXPECT_TRUE(out.emplace(header.stamp_ns, stamped).second) << "twice";
}

int64_t stampOf(const ros2::Header& header) {
    return int64_t(header.stamp.sec) * 1'000'000'000 + header.stamp.nanosec;
}

Numbers numbersOf(const ros2::PoseStamped& m) {
    const auto& [p, q] = m.pose;
    return {p.x, p.y, p.z, q.x, q.y, q.z, q.w};
}
Numbers numbersOf(const ros2::TwistStamped& m) {
    const auto& [v, w] = m.twist;
    return {v.x, v.y, v.z, w.x, w.y, w.z};
}
Numbers numbersOf(const ros2::WrenchStamped& m) {
    const auto& [f, t] = m.wrench;
    return {f.x, f.y, f.z, t.x, t.y, t.z};
}

// One topic, read by both.
template <class Message>
class ReadTwice {
  public:
    ReadTwice(const dds::Participant& cyclone, test::FastNode& fast, const std::string& name,
              const std::string& type)
        : cyclone_(cyclone, "bonemill/" + name),
          fast_(fast.read("rt/bonemill/" + name, type, {.depth = 1000})) {}

    void take() {
        cyclone_.take([this](const Message& message, const dds::SampleInfo&) {
            by_cyclone[stampOf(message.header)] = {message.header.frame_id, numbersOf(message)};
        });
        for (const Bytes& bytes : fast_.take()) takeStamped(bytes, numbersOf(Message{}).size(), by_fast);
    }
    // How many both have, with the same in them.
    size_t expectSame() const {
        size_t same = 0;
        for (const auto& [stamp, stamped] : by_fast)
            if (const auto found = by_cyclone.find(stamp); found != by_cyclone.end()) {
                EXPECT_EQ(stamped, found->second);
                EXPECT_EQ(stamped.frame, "bonemill_world");
                ++same;
            }
        return same;
    }

    // Of what Cyclone's reader has between the first and the last of the other's, the share that the other
    // lacks.
    double shareMissed() const {
        size_t had = 0, missed = 0;
        for (const auto& [stamp, stamped] : by_cyclone) {
            if (stamp < by_fast.begin()->first || stamp > by_fast.rbegin()->first) continue;
            ++had;
            missed += !by_fast.contains(stamp);
        }
        return double(missed) / double(had);
    }

    ByStamp by_cyclone, by_fast;

  private:
    ros2::Reader<Message> cyclone_;
    test::FastNode::Reader fast_;
};

class Ros2Session : public testing::Test {
  protected:
    Ros2Session()
        : server_(session_.startServer()),
          daemon_(session_.startDaemon("simulated")),
          ros_(session_.startRos()),
          cyclone_(session_.joinAsNode()),
          fast_(test::rosTestDomain()) {}

    test::RosSession session_;
    std::unique_ptr<test::Process> server_, daemon_, ros_;
    dds::Participant cyclone_;
    test::FastNode fast_;
};

TEST_F(Ros2Session, SaysEveryTickToBothKindsOfNodesWithTheSameBytes) {
    const std::string geometry = "geometry_msgs::msg::dds_::";
    ReadTwice<ros2::PoseStamped> hand(cyclone_, fast_, "measured_cp", geometry + "PoseStamped_");
    ReadTwice<ros2::PoseStamped> tool(cyclone_, fast_, "setpoint_cp", geometry + "PoseStamped_");
    ReadTwice<ros2::TwistStamped> velocity(cyclone_, fast_, "measured_cv", geometry + "TwistStamped_");
    ReadTwice<ros2::WrenchStamped> wrench(cyclone_, fast_, "measured_cf", geometry + "WrenchStamped_");
    const auto has_felt = [&] {
        return !wrench.by_fast.empty() && std::abs(wrench.by_fast.rbegin()->second.numbers[2]) > 0.05;
    };
    ASSERT_TRUE(test::waitFor([&] {
        usleep(2000);
        hand.take(), tool.take(), velocity.take(), wrench.take();
        return hand.by_fast.size() > 3000 && has_felt();
    })) << ros_->errSoFar();
    EXPECT_GT(hand.expectSame(), 1000u);
    EXPECT_GT(tool.expectSame(), 1000u);
    EXPECT_GT(velocity.expectSame(), 1000u);
    EXPECT_GT(wrench.expectSame(), 1000u);
    // The scripted hand presses from above: the bone pushes up, and holds the simulated tool back.
    EXPECT_GT(wrench.by_fast.rbegin()->second.numbers[2], 0.05);
    EXPECT_LT(hand.by_fast.rbegin()->second.numbers[2], tool.by_fast.rbegin()->second.numbers[2]);
    EXPECT_LE(hand.shareMissed(), 0.01);
    EXPECT_LE(wrench.shareMissed(), 0.01);
    ros_->signal(SIGTERM);
    const test::Finished finished = ros_->wait();
    EXPECT_EQ(finished.exit_code, 0);
    EXPECT_NE(finished.err.find(" ticks were said, "), std::string::npos) << finished.err;
}

// The simulated hand holds a simulated ARES, whose base is where the scene says.
TEST_F(Ros2Session, SaysTheSlidersThatLeadToTheHandsPose) {
    const std::string type = "sensor_msgs::msg::dds_::JointState_";
    auto joints = fast_.read("rt/bonemill/measured_js", type, {.depth = 1000});
    auto hands =
        fast_.read("rt/bonemill/measured_cp", "geometry_msgs::msg::dds_::PoseStamped_", {.depth = 1000});
    const Pose X_WD{{0, 1e-4, 2e-3}, Eigen::Quaterniond(1, 1, 0, 0).normalized()};
    ByStamp poses;
    std::map<int64_t, Vector6d> sliders;
    ASSERT_TRUE(test::waitFor([&] {
        usleep(5000);
        for (const Bytes& bytes : hands.take()) takeStamped(bytes, 7, poses);
        for (const Bytes& bytes : joints.take()) {
            CdrBytes cdr(bytes);
            const Header header = headerOf(cdr);
            EXPECT_EQ(header.frame, "bonemill_device");
            EXPECT_EQ(cdr.u32(), 6u);
            for (int n = 1; n <= 6; ++n) EXPECT_EQ(cdr.text(), "slider_" + std::to_string(n));
            EXPECT_EQ(cdr.u32(), 6u);
            Vector6d& positions = sliders[header.stamp_ns];
            for (double& position : positions) position = cdr.f64();
            const uint32_t velocities = cdr.u32();
            EXPECT_TRUE(velocities == 0 || velocities == 6);
            for (uint32_t n = 0; n < velocities; ++n) EXPECT_LT(std::abs(cdr.f64()), 1);
            EXPECT_EQ(cdr.u32(), 0u);  // no effort
            EXPECT_TRUE(cdr.isWhole());
        }
        return sliders.size() > 500 && poses.size() > 500;
    })) << sliders.size()
        << ros_->errSoFar();
    size_t compared = 0;
    for (const auto& [stamp, positions] : sliders) {
        const auto found = poses.find(stamp);
        if (found == poses.end()) continue;
        const Numbers& p = found->second.numbers;
        const Pose X_WT{{p[0], p[1], p[2]}, {p[6], p[3], p[4], p[5]}};
        Vector6d q;
        ASSERT_TRUE(AresKinematics().inverse(X_WD.inverse() * X_WT, q));
        EXPECT_LT((q - positions).cwiseAbs().maxCoeff(), 1e-9);
        ++compared;
    }
    EXPECT_GT(compared, 300u);
}

TEST_F(Ros2Session, SaysFramesStateAndStatus) {
    auto frames = fast_.read("rt/tf", "tf2_msgs::msg::dds_::TFMessage_");
    auto states = fast_.read("rt/bonemill/operating_state", "crtk_msgs::msg::dds_::OperatingState_");
    auto status = fast_.read("rt/bonemill/status", "std_msgs::msg::dds_::String_");
    auto events =
        fast_.read("rt/bonemill/events", "std_msgs::msg::dds_::String_", {.is_transient_local = true});
    std::set<std::string> children, words;
    std::string text, said;
    bool is_homed = false;
    ASSERT_TRUE(test::waitFor([&] {
        usleep(5000);
        for (const Bytes& bytes : frames.take()) {
            CdrBytes cdr(bytes);
            const uint32_t count = cdr.u32();
            for (uint32_t i = 0; i < count && i < 10; ++i) {
                EXPECT_EQ(headerOf(cdr).frame, "bonemill_world");
                children.insert(cdr.text());
                Numbers numbers;
                for (int n = 0; n < 7; ++n) numbers.push_back(cdr.f64());
                EXPECT_NEAR(
                    std::hypot(std::hypot(numbers[3], numbers[4]), std::hypot(numbers[5], numbers[6])), 1,
                    1e-9);
            }
            EXPECT_TRUE(cdr.isWhole());
        }
        for (const Bytes& bytes : states.take()) {
            CdrBytes cdr(bytes);
            headerOf(cdr);
            words.insert(cdr.text());
            is_homed = cdr.flag();
            cdr.flag();
            EXPECT_TRUE(cdr.isWhole());
        }
        for (const Bytes& bytes : status.take()) {
            CdrBytes cdr(bytes);
            text = cdr.text();
            EXPECT_TRUE(cdr.isWhole());
        }
        for (const Bytes& bytes : events.take()) said += CdrBytes(bytes).text() + "\n";
        return children.size() == 4 && words.contains("ENABLED") &&
               text.find("\"scene\":\"ros\"") != std::string::npos &&
               said.find("device engaged") != std::string::npos;
    })) << children.size()
        << ' ' << text << said << ros_->errSoFar();
    EXPECT_TRUE(is_homed);
    EXPECT_EQ(children, (std::set<std::string>{"bonemill_device", "bonemill_hand", "bonemill_tool",
                                               "bonemill_volume"}));
}

struct Markers {
    std::map<int32_t, uint32_t> points;  // by id
    double lowest = INFINITY, highest = -INFINITY;

    void take(const Bytes& bytes) {
        CdrBytes cdr(bytes);
        const uint32_t count = cdr.u32();
        for (uint32_t i = 0; i < count; ++i) takeMarker(cdr);
        EXPECT_TRUE(cdr.isWhole());
    }
    // visualization_msgs/Marker, field by field.
    void takeMarker(CdrBytes& cdr) {
        EXPECT_EQ(headerOf(cdr).frame, "bonemill_volume");
        EXPECT_EQ(cdr.text(), "bone");
        const int32_t id = cdr.i32();
        EXPECT_EQ(cdr.i32(), 11);  // TRIANGLE_LIST
        const int32_t action = cdr.i32();
        for (const double expected : {0., 0., 0., 0., 0., 0., 1.}) EXPECT_EQ(cdr.f64(), expected);  // pose
        for (int n = 0; n < 3; ++n) EXPECT_EQ(cdr.f64(), 1);                                        // scale
        for (int n = 0; n < 4; ++n) EXPECT_GT(cdr.f32(), 0);                                        // colour
        EXPECT_EQ(int64_t(cdr.i32()) + cdr.u32(), 0);  // lifetime
        EXPECT_FALSE(cdr.flag());                      // frame_locked
        const uint32_t size = cdr.u32();
        for (uint32_t n = 0; n < size && cdr.bytes().size() > size; ++n) {
            cdr.f64(), cdr.f64();
            const double z = cdr.f64();
            lowest = std::min(lowest, z), highest = std::max(highest, z);
        }
        EXPECT_EQ(cdr.u32(), 0u);   // colors
        EXPECT_EQ(cdr.text(), "");  // texture_resource
        EXPECT_EQ(headerOf(cdr).frame, "");
        EXPECT_EQ(cdr.text(), "");                       // texture.format
        EXPECT_EQ(uint64_t(cdr.u32()) + cdr.u32(), 0u);  // texture.data, uv_coordinates
        EXPECT_EQ(cdr.text(), "");                       // text
        EXPECT_EQ(cdr.text() + cdr.text(), "");          // mesh_resource, mesh_file.filename
        EXPECT_EQ(cdr.u32(), 0u);                        // mesh_file.data
        EXPECT_FALSE(cdr.flag());                        // mesh_use_embedded_materials
        if (action == 3) points.clear();
        if (action == 2) points.erase(id);
        if (action != 0) return;
        EXPECT_EQ(size % 3, 0u);
        EXPECT_GT(size, 0u);
        points[id] = size;
    }
};

// A node that keeps ten messages and asks for nothing that was before, as rviz2 does, and one that asks for
// what is kept.
TEST_F(Ros2Session, GivesTheWholeBoneToWhoComesLate) {
    auto status = fast_.read("rt/bonemill/status", "std_msgs::msg::dds_::String_");
    std::string text;
    const auto nodesNow = [&] {
        for (const Bytes& bytes : status.take()) text = CdrBytes(bytes).text();
        const size_t at = text.find("\"nodeCount\":");
        return at == std::string::npos ? 0 : std::stoul(text.substr(at + 12));
    };
    // All of it was said before anybody listened.
    ASSERT_TRUE(test::waitFor([&] {
        return nodesNow() > 20 && text.find("isModelPartial") == std::string::npos;
    })) << text;
    for (const bool is_transient_local : {false, true}) {
        auto bone = fast_.read("rt/bonemill/bone", "visualization_msgs::msg::dds_::MarkerArray_",
                               {.is_transient_local = is_transient_local});
        Markers markers;
        EXPECT_TRUE(test::waitFor([&] {
            usleep(5000);
            for (const Bytes& bytes : bone.take()) markers.take(bytes);
            return !HasFailure() && markers.points.size() == nodesNow() && !markers.points.empty();
        })) << markers.points.size()
            << " of " << nodesNow();
        EXPECT_GT(markers.highest - markers.lowest, 1e-3) << "m";
    }
}

}  // namespace
}  // namespace bonemill
