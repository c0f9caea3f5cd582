// A session that is reached through a gateway. A thread of its own keeps the connection, and opens it again
// with the ticket of the first Welcome when it is lost, ever more slowly; what the viewer holds already is
// not sent again. What has come is acknowledged when it is taken, so that a viewer that hangs is sent no
// more.
#pragma once

#include <array>
#include <chrono>
#include <condition_variable>
#include <deque>
#include <map>
#include <memory>
#include <mutex>
#include <string>
#include <thread>

#include "common/web_socket/web_socket_client.h"
#include "render_client/link/subscribe/remote_session.h"

namespace bonemill::connect {

class GatewaySession : public RemoteSession {
  public:
    // Waits for the Welcome. Throws UserError: nobody is there, it is somebody else, or this token is
    // refused.
    GatewaySession(WebTarget target, std::string token, std::chrono::milliseconds patience);
    ~GatewaySession() override;

    // As whom the gateway took this viewer first.
    const gateway::Welcome& welcome() const noexcept { return first_welcome_; }

    bool next(gateway::Sample::Topic topic, gateway::Sample& sample) override;
    bool wait(std::chrono::nanoseconds timeout) override;
    bool hasServer() const override;
    bool isCut() const override;
    bool say(const gateway::FromGuest& message) override;
    std::string name() const override;

  private:
    using Clock = std::chrono::steady_clock;
    struct Frame {
        gateway::Samples samples;
        uint64_t connection = 0;
        uint64_t received = 0;  // bytes of the connection with it
    };

    void keepConnected();
    void connectAndServe();
    void serve();
    std::string hello() const;
    void take(const std::string& bytes);
    void refused(const gateway::Refusal& refusal);
    void hold(const gateway::Samples& samples);
    void sendQueued();
    void wake() const;
    void sleepUntilStopOr(Clock::time_point end);
    // Distributes what has come.
    void advance();
    void sort(gateway::Sample& sample);

    const WebTarget target_;
    const std::chrono::milliseconds patience_;
    int wake_file_;

    mutable std::mutex mutex_;
    std::condition_variable changed_;
    // The mutex guards these.
    std::deque<Frame> inbox_;
    std::deque<std::string> outbox_;
    size_t outbox_bytes_ = 0;
    gateway::Welcome welcome_;
    bool is_open_ = false, has_server_ = false, should_stop_ = false;
    uint64_t connection_ = 0;
    uint64_t own_sender_ = 0;  // as the viewer calls itself
    std::string problem_;      // why there is no connection
    bool is_refused_ = false;  // for good

    // Of the thread that keeps the connection.
    std::string token_;
    std::unique_ptr<WebSocketClient> socket_;
    uint64_t received_ = 0;
    uint64_t held_epoch_ = 0;
    std::map<uint32_t, uint32_t> held_;  // leaves and their revisions

    // Of the thread that takes.
    std::array<std::deque<gateway::Sample>, gateway::Sample::Topic_ARRAYSIZE> samples_;
    std::map<uint64_t, gateway::Sample> viewers_;  // said again, as they themselves do in DDS
    Clock::time_point viewers_said_;

    gateway::Welcome first_welcome_;
    std::thread thread_;
};

}  // namespace bonemill::connect
