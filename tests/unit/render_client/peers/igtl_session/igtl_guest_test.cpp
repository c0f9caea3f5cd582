// The bone comes to a peer piece by piece, within a budget, and what changes at 2 Hz at most.
#include "render_client/peers/igtl_session/igtl_guest.h"

#include <gtest/gtest.h>

#include <set>

#include "common/tcp/dial.h"
#include "render_client/peers/igtl_session/patient_axes.h"
#include "tests/support/synthetic_nodes.h"

namespace bonemill::igtl {
namespace {

using namespace std::chrono_literals;

class Nobody : public LineSink {
    void came(Line&) override {}
    void heard(Line&, const Frame&) override {}
    void gone(const Line&) override {}
};

class IgtlGuestTest : public testing::Test {
  protected:
    IgtlGuestTest() : port_("127.0.0.1", 0, {}, {}, nobody_), peer_(dial("127.0.0.1", port_.number(), 5s)) {
        while (port_.lines().empty()) port_.step(5ms);
        bone_.place(syntheticSceneInfo());
    }
    // What has come to the peer meanwhile is thrown away.
    void read() {
        port_.step(0ms);
        char piece[1 << 16];
        while (recv(peer_.socket.get(), piece, sizeof piece, MSG_DONTWAIT) > 0) continue;
    }
    void change(uint32_t first, uint32_t last, uint32_t revision) {
        SceneModel::Changes changes;
        for (uint32_t leaf = first; leaf <= last; ++leaf)
            changes.nodes.push_back({syntheticNode(leaf, revision, 200)});
        bone_.apply(std::move(changes));
    }

    Nobody nobody_;
    Port port_;
    Dialled peer_;
    BonePieces bone_;
    Line::Clock::time_point now_ = Line::Clock::now();
};

// syntheticNode() lays leaf N at x = N mm; the bone's box is 20 mm wide.
TEST_F(IgtlGuestTest, TheWholeBoneComesWithinTheBudget) {
    change(0, 19, 1);
    std::set<int> pieces;
    size_t bytes = 0;
    for (int n = 0; n < BonePieces::kCount; ++n)
        if (bone_.revision(n) > 0) pieces.insert(n), bytes += bone_.frame(n, 0)->size();
    ASSERT_EQ(pieces.size(), size_t(BonePieces::kPerAxis)) << "along x";
    constexpr double kRate = 20'000;
    IgtlGuest guest(*port_.lines()[0], kRate, now_);
    int shown = 0;
    double last_s = 0;
    for (int ms = 1; ms < 20'000; ++ms) {
        read();
        if (!guest.showPiece(bone_, 0, now_ + std::chrono::milliseconds(ms))) continue;
        ++shown;
        last_s = ms * 1e-3;
    }
    EXPECT_EQ(shown, int(pieces.size())) << "each once";
    // The last piece begins when those before are paid.
    EXPECT_GT(last_s, 0.6 * double(bytes) / kRate);
    EXPECT_LT(last_s, 1.0 * double(bytes) / kRate);
}

TEST_F(IgtlGuestTest, WhatChangesWithoutAPauseComesTwicePerSecond) {
    IgtlGuest guest(*port_.lines()[0], 1e9, now_);
    int shown = 0;
    for (int ms = 1; ms <= 5000; ++ms) {
        change(3, 3, uint32_t(ms));
        read();
        shown += guest.showPiece(bone_, 0, now_ + std::chrono::milliseconds(ms));
    }
    EXPECT_EQ(shown, 10);
}

TEST_F(IgtlGuestTest, OneWhoDoesNotReadHasLittleWaiting) {
    IgtlGuest guest(*port_.lines()[0], 1e9, now_);
    size_t most = 0, largest = 0;
    for (int n = 1; n < 4000; ++n) {
        change(0, 19, uint32_t(n));
        largest = std::max(largest, bone_.frame(0, 0)->size());
        guest.showPiece(bone_, 0, now_ + n * 600ms);
        port_.step(0ms);
        if (port_.lines().empty()) break;
        most = std::max(most, guest.line().waitingBytes());
    }
    EXPECT_GT(most, IgtlGuest::kMostBeforePiece) << "the line is full";
    EXPECT_LE(most, IgtlGuest::kMostBeforePiece + 2 * largest);
}

TEST(PatientAxes, TurnsLpsIntoRas) {
    const Eigen::Isometry3d place = rasOf(Pose{{0.001, 0.002, 0.003}, Eigen::Quaterniond::Identity()});
    EXPECT_TRUE((place * Eigen::Vector3d(10, 20, 30)).isApprox(Eigen::Vector3d(-11, -22, 33)));
    EXPECT_NEAR(place.linear().determinant(), 1, 1e-12);
}

TEST(BonePieces, ANodeThatGoesEmptiesItsPieceAndAnotherRunAllOfThem) {
    BonePieces bone;
    bone.place(syntheticSceneInfo());
    SceneModel::Changes changes;
    changes.nodes.push_back({syntheticNode(3, 1)});
    bone.apply(std::move(changes));
    const uint32_t before = bone.revision(0);
    const size_t full = bone.frame(0, 0)->size();
    changes = {};
    changes.nodes.push_back({emptyNode(3, 2)});
    bone.apply(std::move(changes));
    EXPECT_GT(bone.revision(0), before);
    EXPECT_LT(bone.frame(0, 0)->size(), full);
    changes = {};
    changes.nodes.push_back({syntheticNode(3, 3)});
    bone.apply(std::move(changes));
    EXPECT_EQ(bone.frame(0, 0)->size(), full);
    changes = {};
    changes.is_cleared = true;
    const uint32_t whole = bone.revision(0);
    bone.apply(std::move(changes));
    EXPECT_GT(bone.revision(0), whole);
    EXPECT_LT(bone.frame(0, 0)->size(), full);
}

}  // namespace
}  // namespace bonemill::igtl
