// A session of a ball of bone, bonemill_igtl beside it, and peers of its port: whole processes, as a user has
// them.
#pragma once

#include <igtlImageMessage.h>
#include <igtlPolyDataMessage.h>
#include <poll.h>

#include <map>

#include "common/igtl_wire/igtl_messages.h"
#include "common/tcp/dial.h"
#include "tests/integration/igtl/oblique_ball.h"
#include "tests/support/dds_session.h"
#include "tests/support/openigtlink_reader.h"
#include "tests/support/process.h"

namespace bonemill::test {

// The port that a program prints behind the first of these words; 0: it ended before.
inline uint16_t portBehind(Process& program, const std::string& words) {
    std::string out;
    waitFor([&] {
        out = program.outSoFar() + program.errSoFar();
        const size_t at = out.find(words);
        return (at != std::string::npos && out.find('\n', at) != std::string::npos) || !program.isRunning();
    });
    const size_t at = out.find(words);
    return at == std::string::npos ? 0 : uint16_t(std::stoi(out.substr(at + words.size())));
}

// A peer that keeps what it was sent: of each device the newest frame.
class IgtlPeer {
  public:
    explicit IgtlPeer(uint16_t port) {
        Dialled dialled = dial("127.0.0.1", port, std::chrono::seconds(10));
        EXPECT_EQ(dialled.problem, "");
        socket_ = std::move(dialled.socket);
    }
    void send(const std::string& frame) {
        EXPECT_EQ(::send(socket_.get(), frame.data(), frame.size(), MSG_NOSIGNAL), ssize_t(frame.size()));
    }
    // Reads until the condition holds; false when the line ended, or it never did.
    template <class Condition>
    bool readUntil(const Condition& condition, std::chrono::milliseconds limit = std::chrono::seconds(60)) {
        const auto end = std::chrono::steady_clock::now() + limit;
        std::vector<char> piece(1 << 20);
        while (!condition()) {
            if (std::chrono::steady_clock::now() > end) return false;
            pollfd file{socket_.get(), POLLIN, 0};
            if (poll(&file, 1, 2) <= 0) continue;
            const ssize_t count = recv(socket_.get(), piece.data(), piece.size(), MSG_DONTWAIT);
            if (count == 0) return condition();
            if (count < 0) continue;
            const std::string complaint =
                reader_.take({piece.data(), size_t(count)}, [this](const igtl::Frame& f) {
                    frames[f.device] = f;
                    ++counts[f.device];
                    bytes += f.body.size() + igtl::kHeaderBytes;
                    if (f.type == "STRING") texts.push_back(igtl::stringOf(f.body).value_or("?"));
                });
            EXPECT_EQ(complaint, "");
        }
        return true;
    }
    template <class Message>
    typename Message::Pointer byLibrary(const std::string& device) {
        const igtl::Frame& frame = frames[device];
        return readByLibrary<Message>(igtl::frameOf(frame.type, frame.device, 0, frame.body));
    }
    bool hasText(const std::string& part) const {
        return std::ranges::any_of(texts,
                                   [&](const auto& text) { return text.find(part) != std::string::npos; });
    }
    std::map<std::string, igtl::Frame> frames;
    std::map<std::string, int> counts;
    std::vector<std::string> texts;
    uint64_t bytes = 0;

  private:
    Descriptor socket_;
    igtl::FrameReader reader_{{{"TRANSFORM", 48, 48},
                               {"NDARRAY", 4, 4096},
                               {"STRING", 4, 4 + igtl::kLongestString},
                               {"STATUS", 30, 4096},
                               {"POLYDATA", 40, 64 << 20},
                               {"IMAGE", 72, 256 << 20}}};
};

class IgtlRig : public testing::Test {
  protected:
    void begin(const std::vector<std::string>& more = {}) {
        ball_.write(folder_ / "ball.nrrd");
        writeFile(folder_ / "s.textproto", scene());
        const std::string session = std::to_string(testSession()), domain = std::to_string(testDomain());
        server_.emplace(std::vector<std::string>{"haptic_server", "--scene", folder_ / "s.textproto",
                                                 "--session", session, "--domain", domain});
        std::vector<std::string> words{"bonemill_igtl", "--session", session, "--domain",
                                       domain,          "--port",    "0"};
        words.insert(words.end(), more.begin(), more.end());
        igtl_.emplace(words);
        port_ = portBehind(*igtl_, "listening on 127.0.0.1:");
        ASSERT_NE(port_, 0);
    }
    void beginDevice() {
        device_.emplace(std::vector<std::string>{"device_daemon", "--device", "simulated", "--scene",
                                                 folder_ / "s.textproto", "--session",
                                                 std::to_string(testSession())});
    }
    // The hand goes straight down onto the ball, mills, and rests above it.
    Eigen::Vector3d top(double above_mm) const {
        return ball_.middle() + Eigen::Vector3d(0, 0, 8 + above_mm);
    }
    std::string scene() const {
        const auto place = [](const Eigen::Vector3d& p) {
            return "{ x: " + std::to_string(p.x()) + " y: " + std::to_string(p.y()) +
                   " z: " + std::to_string(p.z()) + " } ";
        };
        const std::string turn = "q_WT { w: 0.70710678 x: 0.70710678 } ";
        const auto waypoint = [&](double time_s, double above_mm, const std::string& more) {
            return "  waypoint { time_s: " + std::to_string(time_s) + " p_WT_mm " + place(top(above_mm)) +
                   turn + more + " }\n";
        };
        return "name: \"ball\" effects { time_removal {} }\n"
               "volume { path: \"ball.nrrd\" window_low: -1000 window_high: 2000 iso_value: 300 }\n"
               "device { p_WD_mm " +
               place(top(0)) +
               "q_WD { w: 0.70710678 x: 0.70710678 } }\n"
               "simulated_operator {\n" +
               waypoint(0, 4, "phase: \"approach\"") + waypoint(0.7, 1.2, "remove: true phase: \"mill\"") +
               waypoint(2, -1, "phase: \"withdraw\"") + waypoint(2.7, 4, "phase: \"rest\"") +
               waypoint(6, 4, "") + "}\n";
    }
    // Of all pieces that have come, in mm.
    static std::vector<Eigen::Vector3d> pointsOf(IgtlPeer& peer) {
        std::vector<Eigen::Vector3d> points;
        for (const auto& [device, frame] : peer.frames) {
            if (frame.type != "POLYDATA") continue;
            const auto surface = peer.byLibrary<::igtl::PolyDataMessage>(device);
            EXPECT_TRUE(surface.IsNotNull()) << device;
            if (surface.IsNull()) continue;
            for (int n = 0; n < surface->GetPoints()->GetNumberOfPoints(); ++n) {
                float point[3];
                surface->GetPoints()->GetPoint(unsigned(n), point);
                points.push_back(Eigen::Vector3f(point).cast<double>());
            }
        }
        return points;
    }

    TemporaryFolder folder_;
    ObliqueBall ball_;
    std::optional<Process> server_, igtl_, device_;
    uint16_t port_ = 0;
};

}  // namespace bonemill::test
