// This is a viewer without a picture behind a gateway (arguments: host, port, fingerprint, token). Until
// SIGTERM it prints four times a second, as a line of JSON, what it has and how long cuts took to come since
// its model was whole first.
#include <csignal>
#include <iostream>
#include <nlohmann/json.hpp>

#include "common/base/user_error.h"
#include "common/rt/clock.h"
#include "render_client/link/subscribe/cut_to_screen.h"
#include "render_client/link/subscribe/scene_subscriber.h"
#include "render_client/web/connect/gateway_session.h"

namespace {

using namespace bonemill;

constexpr std::chrono::milliseconds kFrame{16};
constexpr int64_t kSayPeriodNs = kNsPerSecond / 4;

volatile std::sig_atomic_t should_stop = 0;

nlohmann::json ms(const LatencyHistogram& times) {
    const auto at = [&](double percent) { return millisecondsOfNs(double(times.percentileNs(percent))); };
    return {{"count", times.count()},
            {"p50", at(50)},
            {"p99", at(99)},
            {"max", millisecondsOfNs(double(times.maxNs()))}};
}

class Reader {
  public:
    explicit Reader(const WebTarget& target, const std::string& token)
        : start_ns_(monotonicNowNs()),
          session_(std::make_shared<connect::GatewaySession>(target, token, std::chrono::seconds(30))),
          subscriber_(
              {.name = session_->welcome().name(), .role = session_->welcome().role(), .remote = session_}) {
        said_["connected_s"] = passed();
    }
    void step() {
        subscriber_.waitForData(kFrame);
        const SceneModel::Changes changes = subscriber_.poll();
        for (const SceneModel::Change& change : changes.nodes)
            if (is_whole_) cuts_.willShow(change.cut_stamp_ns, CutToScreen::nowNs());
        cuts_.hasShown(CutToScreen::nowNs());
        if (!said_.contains("first_s") && !changes.nodes.empty() && subscriber_.sceneInfo())
            said_["first_s"] = passed();
        if (!is_whole_ && subscriber_.isComplete()) said_["whole_s"] = passed();
        is_whole_ = is_whole_ || subscriber_.isComplete();
    }
    void say() {
        if (monotonicNowNs() < due_ns_) return;
        due_ns_ = monotonicNowNs() + kSayPeriodNs;
        said_["now_s"] = passed();
        said_["is_cut"] = session_->isCut();
        said_["is_complete"] = subscriber_.isComplete();
        said_["nodes"] = subscriber_.digest().count();
        said_["digest"] = subscriber_.digest().value();
        said_["cut_to_viewer_ms"] = ms(cuts_.arrivals());
        std::cout << said_ << std::endl;
    }

  private:
    double passed() const { return secondsOfNs(monotonicNowNs() - start_ns_); }

    int64_t start_ns_, due_ns_ = 0;
    std::shared_ptr<connect::GatewaySession> session_;
    SceneSubscriber subscriber_;
    CutToScreen cuts_;
    bool is_whole_ = false;
    nlohmann::json said_;
};

}  // namespace

int main(int argc, char** argv) {
    if (argc != 5) return 2;
    std::signal(SIGTERM, [](int) { should_stop = 1; });
    try {
        Reader reader({argv[1], uint16_t(std::stoi(argv[2])), argv[3]}, argv[4]);
        while (!should_stop) {
            reader.step();
            reader.say();
        }
    } catch (const UserError& error) {
        std::cerr << error.what() << '\n';
        return 1;
    }
    return 0;
}
