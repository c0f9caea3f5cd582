// Peers of bonemill_igtl see tool, bone and scan where the scan's own file has them, and order only what they
// may.
#include <gtest/gtest.h>
#include <igtlNDArrayMessage.h>
#include <signal.h>

#include <atomic>
#include <cmath>
#include <sstream>
#include <thread>

#include "tests/integration/igtl/igtl_rig.h"
#include "tests/support/places.h"

namespace bonemill::test {
namespace {

// Index to RAS, as 3D Slicer computes it: the message's place is the middle of the image.
Eigen::Affine3d rasOfIndex(::igtl::ImageMessage& image) {
    ::igtl::Matrix4x4 matrix;
    image.GetMatrix(matrix);
    float spacing[3];
    int size[3];
    image.GetSpacing(spacing);
    image.GetDimensions(size);
    Eigen::Affine3d ras = Eigen::Affine3d::Identity();
    for (int row = 0; row < 3; ++row)
        for (int column = 0; column < 3; ++column)
            ras.linear()(row, column) = double(matrix[row][column]) * double(spacing[column]);
    const Eigen::Vector3d middle(matrix[0][3], matrix[1][3], matrix[2][3]);
    ras.translation() = middle - ras.linear() * Eigen::Vector3d(size[0] - 1, size[1] - 1, size[2] - 1) / 2;
    return ras;
}

class IgtlSession : public IgtlRig {
  protected:
    // Every voxel of the image lies where the file has the value that it has.
    void expectCoincides(::igtl::ImageMessage& image, const std::vector<Eigen::Vector3d>& but_near) {
        const Eigen::Affine3d ras = rasOfIndex(image);
        int size[3];
        image.GetDimensions(size);
        ASSERT_EQ(Eigen::Vector3i(size), Eigen::Vector3i::Constant(ObliqueBall::kEdge));
        const auto* value = static_cast<const int16_t*>(image.GetScalarPointer());
        int worst = 0;
        for (int k = 0; k < size[2]; ++k)
            for (int j = 0; j < size[1]; ++j)
                for (int i = 0; i < size[0]; ++i, ++value) {
                    const Eigen::Vector3d p_RAS = ras * Eigen::Vector3d(i, j, k);
                    const Eigen::Vector3d p_LPS = rasOfLps(p_RAS);
                    if (std::ranges::any_of(but_near, [&](const auto& p) { return (p - p_LPS).norm() < 3; }))
                        continue;
                    worst = std::max(worst, std::abs(*value - ball_.valueAt(p_LPS)));
                }
        EXPECT_LE(worst, 1) << "HU";
    }
    // All of the surface is at the ball's radius.
    void expectBall(IgtlPeer& peer) {
        const std::vector<Eigen::Vector3d> points = pointsOf(peer);
        ASSERT_GT(points.size(), 1000u);
        const Eigen::Vector3d middle = rasOfLps(ball_.middle());
        double worst = 0;
        Eigen::Vector3d low = points[0], high = points[0];
        for (const Eigen::Vector3d& p : points) {
            worst = std::max(worst, std::abs((p - middle).norm() - ObliqueBall::kRadius_mm));
            low = low.cwiseMin(p), high = high.cwiseMax(p);
        }
        EXPECT_LT(worst, 0.05) << "mm";
        EXPECT_LT((low - middle + Eigen::Vector3d::Constant(8)).cwiseAbs().maxCoeff(), 0.15)
            << "the whole ball";
        EXPECT_LT((high - middle - Eigen::Vector3d::Constant(8)).cwiseAbs().maxCoeff(), 0.15);
    }
    void expectScanAndBoneCoincide() {
        begin();
        IgtlPeer peer(port_);
        ASSERT_TRUE(peer.readUntil([&] { return pointsOf(peer).size() > 1000 && peer.texts.size() > 0; }));
        peer.send(igtl::frameOf("GET_IMAGE", "", 0, ""));
        ASSERT_TRUE(peer.readUntil([&] { return peer.counts["bonemill_volume"] > 0; }));
        expectBall(peer);
        ASSERT_EQ(peer.frames["bonemill_volume"].type, "IMAGE");
        expectCoincides(*peer.byLibrary<::igtl::ImageMessage>("bonemill_volume"), {});
    }
};

TEST_F(IgtlSession, ScanAndBoneLieWhereTheFileHasThem) {
    expectScanAndBoneCoincide();
}

TEST_F(IgtlSession, SoDoThoseOfALeftHandedScan) {
    ball_.mirror();
    expectScanAndBoneCoincide();
}

TEST_F(IgtlSession, AHandMillsAndTheBoneToolAndScanShowIt) {
    begin();
    IgtlPeer peer(port_);
    ASSERT_TRUE(peer.readUntil([&] { return pointsOf(peer).size() > 1000; }));
    const std::vector<Eigen::Vector3d> scanned = pointsOf(peer);
    beginDevice();
    // It begins 4 mm above the ball, mills, and comes back.
    const Eigen::Vector3d rest = rasOfLps(top(4)), burr = rasOfLps(top(-0.5));
    bool was_there = false, was_down = false;
    ASSERT_TRUE(peer.readUntil([&] {
        const auto hand = peer.frames.find("bonemill_hand");
        if (hand == peer.frames.end()) return false;
        const Eigen::Vector3d p = igtl::transformOf(hand->second.body)->translation();
        was_there |= (p - rest).norm() < 0.02;
        was_down |= p.z() < top(0).z();
        return was_there && was_down && p.z() > top(3).z();
    }));
    // T's axes in RAS: q_WT turns y into W's z, and z into −y, which RAS calls +y.
    const Eigen::Matrix3d turn = igtl::transformOf(peer.frames["bonemill_hand"].body)->linear();
    EXPECT_TRUE(turn.col(1).isApprox(Eigen::Vector3d::UnitZ(), 1e-3)) << turn;
    EXPECT_TRUE(turn.col(2).isApprox(Eigen::Vector3d::UnitY(), 1e-3)) << turn;
    EXPECT_TRUE(turn.col(0).isApprox(-Eigen::Vector3d::UnitX(), 1e-3)) << turn;
    EXPECT_GT(peer.counts["bonemill_tool"], 60);
    EXPECT_GT(peer.counts["bonemill_wrench"], 60);
    const auto deepest = [](const std::vector<Eigen::Vector3d>& points, const Eigen::Vector3d& at) {
        double z = 1e9;  // of the surface below the burr's axis
        for (const auto& p : points)
            if ((p - at).head<2>().norm() < 0.3 && p.z() > at.z() - 4) z = std::min(z, p.z());
        return z;
    };
    const double before = deepest(scanned, burr);
    ASSERT_TRUE(peer.readUntil([&] { return deepest(pointsOf(peer), burr) < before - 1; }));
    peer.send(igtl::frameOf("GET_IMAGE", "", 0, ""));
    ASSERT_TRUE(peer.readUntil([&] { return peer.counts["bonemill_volume"] > 0; }));
    const auto image = peer.byLibrary<::igtl::ImageMessage>("bonemill_volume");
    expectCoincides(*image, {top(1.5), top(0), top(-1)});
    const Eigen::Vector3d index = rasOfIndex(*image).inverse() * burr;
    const Eigen::Vector3i v = index.array().round().cast<int>();
    const auto* values = static_cast<const int16_t*>(image->GetScalarPointer());
    EXPECT_LT(values[(v.z() * ObliqueBall::kEdge + v.y()) * ObliqueBall::kEdge + v.x()], ObliqueBall::kIso)
        << "where the burr was there is no bone";
}

// Says without a pause where its hand is, above D's origin.
class ToldHand {
  public:
    explicit ToldHand(uint16_t port) : peer_(port), thread_([this] { run(); }) {}
    ~ToldHand() {
        shall_end_ = true;
        thread_.join();
    }
    // It goes there at 3 mm/s.
    void goDownTo(double above_mm) { goal_mm_ = above_mm; }
    void remove() { shall_remove_ = true; }
    double feltUp() const { return felt_n_; }  // the most, N

  private:
    void run() {
        double above_mm = goal_mm_;
        Eigen::Isometry3d place = Eigen::Isometry3d::Identity();
        while (!shall_end_) {
            if (shall_remove_.exchange(false)) peer_.send(igtl::stringFrame("bonemill_buttons", 0, "remove"));
            above_mm = std::max(above_mm - 0.015, goal_mm_.load());
            place.translation() = Eigen::Vector3d(0, above_mm, 0);
            peer_.send(igtl::transformFrame("Robot", 0, place));
            peer_.readUntil([] { return false; }, std::chrono::milliseconds(5));
            if (peer_.counts["bonemill_wrench"] == 0) continue;
            const auto wrench = peer_.byLibrary<::igtl::NDArrayMessage>("bonemill_wrench");
            felt_n_ = std::max(felt_n_.load(), static_cast<double*>(wrench->GetArray()->GetRawArray())[1]);
        }
    }

    IgtlPeer peer_;
    std::atomic<double> goal_mm_{4}, felt_n_{0};
    std::atomic<bool> shall_remove_{false}, shall_end_{false};
    std::thread thread_;
};

// A robot holds the drill: its poses go in by the bridge, the bone comes out here. D lies at the ball's top,
// its y is W's z.
TEST_F(IgtlSession, AToldHandMills) {
    begin();
    IgtlPeer peer(port_);
    ASSERT_TRUE(peer.readUntil([&] { return pointsOf(peer).size() > 1000; }));
    Process bridge({"bonemill_bridge_igtl", "--igtl-port", "0"});
    const uint16_t udp = portBehind(bridge, "listening on 127.0.0.1:");
    ToldHand robot(portBehind(bridge, "OpenIGTLink to 127.0.0.1:"));
    const Process daemon({"device_daemon", "--device", "bridge:127.0.0.1:" + std::to_string(udp),
                          "--no-enabling-switch", "--scene", folder_ / "s.textproto", "--session",
                          std::to_string(testSession())});
    ASSERT_TRUE(peer.readUntil([&] {
        const auto hand = peer.frames.find("bonemill_hand");
        return hand != peer.frames.end() &&
               (igtl::transformOf(hand->second.body)->translation() - rasOfLps(top(4))).norm() < 0.01;
    }));
    robot.goDownTo(0.8);
    EXPECT_TRUE(waitFor([&] { return robot.feltUp() > 0.1; }, std::chrono::seconds(20)))
        << "the bone pushes it, in its own axes: " << robot.feltUp() << " N";
    robot.remove();
    robot.goDownTo(-0.5);
    const auto lowest = [&] {
        double least = 1e9;
        for (const auto& p : pointsOf(peer)) least = std::min(least, (p - rasOfLps(ball_.middle())).norm());
        return least;
    };
    EXPECT_TRUE(peer.readUntil([&] { return lowest() < ObliqueBall::kRadius_mm - 1; })) << lowest();
}

// Debian's own example program prints what it is sent.
TEST_F(IgtlSession, TheExamplePeerPrintsOurTransforms) {
    begin();
    beginDevice();
    Process peer({helperDir() + "/igtl_receive_client", "127.0.0.1", std::to_string(port_)});
    const Eigen::Vector3d rest = rasOfLps(top(4));
    std::string said;
    EXPECT_TRUE(waitFor(
        [&] {
            std::istringstream lines(said = peer.errSoFar() + peer.outSoFar());
            std::array<double, 12> m{};
            size_t n = 0;
            for (std::string line; std::getline(lines, line);) {
                std::ranges::replace(line, ',', ' ');
                double a, b, c, d;
                std::istringstream row(line);
                if (!(row >> a >> b >> c >> d)) continue;
                if (n % 16 < 12) m[n % 16] = a, m[n % 16 + 1] = b, m[n % 16 + 2] = c, m[n % 16 + 3] = d;
                n += 4;
                if (n % 16 == 0 && (Eigen::Vector3d(m[3], m[7], m[11]) - rest).norm() < 0.02 &&
                    std::abs(m[9] - 1) < 1e-4)
                    return true;
            }
            return false;
        },
        std::chrono::seconds(60)))
        << said.substr(0, 2000);
    EXPECT_NE(said.find("Receiving TRANSFORM"), std::string::npos);
    EXPECT_NE(said.find("Receiving STATUS"), std::string::npos);
    EXPECT_NE(said.find("session: ball"), std::string::npos);
}

TEST_F(IgtlSession, OrdersNeedTheSecretAndTheRole) {
    const std::string secret = "0123456789abcdef0123456789abcdef", file = folder_ / "secret";
    writeFile(file, secret);
    ASSERT_EQ(run({"bonemill_igtl", "--role", "operator"}).exit_code, 2)
        << "nobody must order without a secret";
    ASSERT_EQ(run({"bonemill_igtl", "--role", "operator", "--secret-file", file}).exit_code, 2)
        << "others may read it";
    ASSERT_EQ(chmod(file.c_str(), 0600), 0);
    begin({"--role", "operator", "--secret-file", file});
    IgtlPeer peer(port_), guesser(port_);
    ASSERT_TRUE(peer.readUntil([&] { return peer.hasText("session: ball"); }));
    peer.send(igtl::stringFrame("order", 0, "pause"));
    ASSERT_TRUE(peer.readUntil([&] { return peer.hasText("pause: refused: say the secret first"); }));
    guesser.send(igtl::stringFrame("bonemill_secret", 0, "0123456789abcdef0123456789abcdeX"));
    EXPECT_FALSE(guesser.readUntil([] { return false; })) << "it is sent away";
    peer.send(igtl::stringFrame("bonemill_secret", 0, secret));
    peer.send(igtl::stringFrame("order", 0, "pause"));
    ASSERT_TRUE(peer.readUntil([&] { return peer.hasText("milling pauses"); }));
    ASSERT_TRUE(peer.readUntil([&] { return peer.hasText("pause milling: done"); }));
    peer.send(igtl::stringFrame("order", 0, "shutdown"));
    ASSERT_TRUE(peer.readUntil([&] { return peer.hasText("shutdown: refused"); }));
    peer.send(igtl::stringFrame("order", 0, "make coffee"));
    ASSERT_TRUE(
        peer.readUntil([&] { return peer.hasText("make coffee: refused: 'make coffee' is no command"); }));
    EXPECT_TRUE(server_->isRunning());
}

// A peer that asks for the scan behind more than the kernel holds for it, and reads nothing.
Descriptor deafAsker(uint16_t port) {
    Dialled dialled = dial("127.0.0.1", port, std::chrono::seconds(5));
    std::string bytes;
    for (int n = 0; n < 8000; ++n) bytes += igtl::frameOf("GET_STATUS", "", 0, "");
    bytes += igtl::frameOf("GET_IMAGE", "", 0, "");
    for (size_t sent = 0; sent < bytes.size();) {
        const ssize_t count =
            send(dialled.socket.get(), bytes.data() + sent, bytes.size() - sent, MSG_NOSIGNAL);
        if (count > 0) sent += size_t(count);
    }
    return std::move(dialled.socket);
}

TEST_F(IgtlSession, ScansThatNobodyReadsAreFew) {
    begin();
    IgtlPeer good(port_);
    const auto ask = [&] {
        const int before = good.counts["bonemill_volume"];
        good.send(igtl::frameOf("GET_IMAGE", "", 0, ""));
        EXPECT_TRUE(good.readUntil([&] { return good.counts["bonemill_volume"] > before; }));
        return good.frames["bonemill_volume"].type;
    };
    ASSERT_TRUE(good.readUntil([&] { return pointsOf(good).size() > 1000; }));
    EXPECT_EQ(ask(), "IMAGE");
    std::vector<Descriptor> deaf;
    bool is_refused = false;
    while (deaf.size() < 10 && !is_refused) {
        deaf.push_back(deafAsker(port_));
        for (int n = 0; n < 2; ++n) is_refused |= ask() == "STATUS";
    }
    EXPECT_TRUE(is_refused);
    EXPECT_GE(deaf.size(), 3u);
    deaf.clear();
    EXPECT_TRUE(waitFor([&] { return ask() == "IMAGE"; })) << "once they are gone";
}

TEST_F(IgtlSession, HostilePeersCostABoundAndNobodyElseWaits) {
    begin();
    IgtlPeer good(port_);
    ASSERT_TRUE(good.readUntil([&] { return pointsOf(good).size() > 1000; }));
    const auto memory_kib = [&] {
        const std::string status = readFile("/proc/" + std::to_string(igtl_->pid()) + "/status");
        return std::stol(status.substr(status.find("VmRSS:") + 6));
    };
    const long before_kib = memory_kib();
    std::string huge = igtl::frameOf("STRING", "", 0, "");
    huge[44] = 1;  // of the size of its body: 2^40 bytes
    Process example({helperDir() + "/igtl_string_client", "127.0.0.1", std::to_string(port_), "50"});
    std::vector<Descriptor> crowd;
    for (int n = 0; n < 100; ++n) {
        Dialled one = dial("127.0.0.1", port_, std::chrono::seconds(5));
        const std::string bytes = n % 4 == 0 ? huge
                                  : n % 4 == 1
                                      ? "GET / HTTP/1.1\r\nHost: a\r\nAccept: everything there is, please\r\n"
                                  : n % 4 == 2 ? huge.substr(0, 30)
                                               : igtl::frameOf("GET_IMAGE", "", 0, "");  // and does not read
        send(one.socket.get(), bytes.data(), bytes.size(), MSG_NOSIGNAL);
        crowd.push_back(std::move(one.socket));
    }
    const int before = good.counts["bonemill"];
    EXPECT_TRUE(good.readUntil([&] { return good.counts["bonemill"] > before + 2; }))
        << "it is served meanwhile";
    EXPECT_LT(memory_kib() - before_kib, 64 << 10);
    EXPECT_TRUE(waitFor([&] { return igtl_->errSoFar().find("is turned away") != std::string::npos; }))
        << igtl_->errSoFar();
    EXPECT_TRUE(waitFor(
        [&] { return igtl_->errSoFar().find("a body of 1099511627776 bytes") != std::string::npos; }));
    crowd.clear();
    IgtlPeer late(port_);
    EXPECT_TRUE(late.readUntil([&] { return pointsOf(late).size() > 1000; }));
    igtl_->signal(SIGTERM);
    EXPECT_EQ(igtl_->wait(std::chrono::seconds(10)).exit_code, 0);
}

}  // namespace
}  // namespace bonemill::test
