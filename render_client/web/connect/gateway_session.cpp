#include "render_client/web/connect/gateway_session.h"

#include <spdlog/spdlog.h>
#include <sys/eventfd.h>
#include <unistd.h>

#include <algorithm>
#include <utility>

#include "common/base/user_error.h"

namespace bonemill::connect {
namespace {

using namespace std::chrono_literals;

constexpr auto kFirstPause = 500ms, kLongestPause = 15000ms;
constexpr auto kSilence = 12s;  // the gateway says something every few seconds
constexpr auto kLook = 250ms;
constexpr auto kViewersAgain = 1s;
constexpr size_t kMaxQueuedBytes = 1 << 20;
constexpr size_t kMostWaiting = 4096;  // samples of a topic that nobody takes

// The number of the run that a node's mesh is of; 0: it makes no sense.
uint64_t epochOfNode(const std::string& payload) {
    topics::NodeMesh node;
    return node.ParseFromString(payload) ? node.epoch() : 0;
}

}  // namespace

GatewaySession::GatewaySession(WebTarget target, std::string token, std::chrono::milliseconds patience)
    : target_(std::move(target)),
      patience_(patience),
      wake_file_(eventfd(0, EFD_NONBLOCK | EFD_CLOEXEC)),
      token_(std::move(token)) {
    thread_ = std::thread([this] { keepConnected(); });
    std::unique_lock lock(mutex_);
    changed_.wait_for(lock, 2 * patience, [this] { return is_open_ || !problem_.empty(); });
    if (is_open_) {
        first_welcome_ = welcome_;
        return;
    }
    const std::string problem = problem_.empty() ? "the gateway does not answer" : problem_;
    should_stop_ = true;
    lock.unlock();
    changed_.notify_all();
    wake();
    thread_.join();
    close(wake_file_);
    throw UserError(problem);
}

GatewaySession::~GatewaySession() {
    {
        const std::lock_guard lock(mutex_);
        should_stop_ = true;
    }
    changed_.notify_all();
    wake();
    thread_.join();
    close(wake_file_);
}

void GatewaySession::wake() const {
    const uint64_t one = 1;
    if (write(wake_file_, &one, sizeof one) < 0) return;  // it is awake
}

void GatewaySession::keepConnected() {
    auto pause = kFirstPause;
    while (true) {
        {
            const std::lock_guard lock(mutex_);
            if (should_stop_ || is_refused_) return;
        }
        const uint64_t before = connection_;
        try {
            connectAndServe();
        } catch (const UserError& error) {
            const std::lock_guard lock(mutex_);
            problem_ = std::string("--connect ") + error.what();
        }
        socket_.reset();
        if (connection_ != before) pause = kFirstPause;
        sleepUntilStopOr(Clock::now() + pause);
        pause = std::min<std::chrono::milliseconds>(2 * pause, kLongestPause);
    }
}

void GatewaySession::sleepUntilStopOr(Clock::time_point end) {
    std::unique_lock lock(mutex_);
    changed_.notify_all();
    changed_.wait_until(lock, end, [this] { return should_stop_; });
}

void GatewaySession::connectAndServe() {
    const WebSocketRequest request{.path = "/session",
                                   .protocol = "bonemill.v1",
                                   .refusal = "no bonemill gateway is there, or it takes no more guests"};
    socket_ = std::make_unique<WebSocketClient>(target_, request, patience_);
    received_ = 0;
    socket_->send(hello());
    serve();
    const std::lock_guard lock(mutex_);
    if (is_open_ && !should_stop_) spdlog::warn("the gateway is lost; it is looked for again");
    if (problem_.empty()) problem_ = "--connect " + name() + ": the gateway ended the connection";
    is_open_ = has_server_ = false;
    outbox_.clear();
    outbox_bytes_ = 0;
}

void GatewaySession::serve() {
    auto heard = Clock::now();
    while (!socket_->hasEnded() && Clock::now() - heard < kSilence) {
        {
            const std::lock_guard lock(mutex_);
            if (should_stop_) return;
        }
        sendQueued();
        socket_->wait(wake_file_, kLook);
        uint64_t count = 0;
        if (read(wake_file_, &count, sizeof count) > 0) sendQueued();
        socket_->move();
        std::string frame;
        while (socket_->receive(frame)) {
            heard = Clock::now();
            take(frame);
        }
    }
}

std::string GatewaySession::hello() const {
    gateway::FromGuest frame;
    gateway::Hello& hello = *frame.mutable_hello();
    hello.set_token(token_);
    hello.set_link("viewer");
    hello.set_version(gateway::kProtocolVersion);
    hello.set_epoch(held_epoch_);
    for (const auto& [leaf, revision] : held_) {
        hello.add_leaves(leaf);
        hello.add_revisions(revision);
    }
    return frame.SerializeAsString();
}

void GatewaySession::sendQueued() {
    std::deque<std::string> queued;
    {
        const std::lock_guard lock(mutex_);
        queued.swap(outbox_);
        outbox_bytes_ = 0;
    }
    for (const std::string& message : queued) socket_->send(message);
    socket_->move();
}

void GatewaySession::take(const std::string& bytes) {
    received_ += bytes.size();
    gateway::ToGuest frame;
    if (!frame.ParseFromString(bytes)) return;
    if (frame.has_refusal()) refused(frame.refusal());
    if (frame.has_samples()) hold(frame.samples());
    const std::lock_guard lock(mutex_);
    if (frame.has_welcome()) {
        welcome_ = frame.welcome();
        token_ = welcome_.ticket();
        is_open_ = true;
        problem_.clear();
        ++connection_;
    }
    if (frame.has_samples()) has_server_ = frame.samples().has_server();
    // The Welcome itself is acknowledged with the first of what follows it.
    inbox_.push_back({std::move(*frame.mutable_samples()), connection_, received_});
    changed_.notify_all();
}

void GatewaySession::refused(const gateway::Refusal& refusal) {
    const std::lock_guard lock(mutex_);
    problem_ = "--connect " + name() + ": " + refusal.reason();
    is_refused_ = refusal.is_final();
    if (is_open_) spdlog::warn("{}", problem_);
}

void GatewaySession::hold(const gateway::Samples& samples) {
    for (const gateway::Sample& sample : samples.samples()) {
        if (sample.topic() != gateway::Sample::NODE_MESH) continue;
        const auto leaf = uint32_t(sample.key());
        if (sample.payload().empty()) {
            held_.erase(leaf);
            continue;
        }
        const uint64_t epoch = epochOfNode(sample.payload());
        if (epoch != held_epoch_) held_.clear();
        held_epoch_ = epoch;
        held_[leaf] = sample.revision();
    }
}

bool GatewaySession::say(const gateway::FromGuest& message) {
    std::string bytes = message.SerializeAsString();
    {
        const std::lock_guard lock(mutex_);
        if (!is_open_ || outbox_bytes_ + bytes.size() > kMaxQueuedBytes) return false;
        if (message.has_command()) own_sender_ = message.command().sender();
        outbox_bytes_ += bytes.size();
        outbox_.push_back(std::move(bytes));
    }
    wake();
    return true;
}

bool GatewaySession::hasServer() const {
    const std::lock_guard lock(mutex_);
    return is_open_ && has_server_;
}

bool GatewaySession::isCut() const {
    const std::lock_guard lock(mutex_);
    return !is_open_;
}

std::string GatewaySession::name() const {
    return "wss://" + target_.host + ":" + std::to_string(target_.port);
}

bool GatewaySession::wait(std::chrono::nanoseconds timeout) {
    if (std::ranges::any_of(samples_, [](const auto& waiting) { return !waiting.empty(); })) return true;
    std::unique_lock lock(mutex_);
    return changed_.wait_for(lock, timeout, [this] { return !inbox_.empty(); });
}

bool GatewaySession::next(gateway::Sample::Topic topic, gateway::Sample& sample) {
    auto& waiting = samples_[size_t(topic)];
    if (waiting.empty()) advance();
    if (waiting.empty()) return false;
    sample = std::move(waiting.front());
    waiting.pop_front();
    return true;
}

void GatewaySession::advance() {
    std::deque<Frame> frames;
    bool is_current = false;
    {
        const std::lock_guard lock(mutex_);
        frames.swap(inbox_);
        is_current = !frames.empty() && frames.back().connection == connection_;
    }
    for (Frame& frame : frames)
        for (gateway::Sample& sample : *frame.samples.mutable_samples()) sort(sample);
    if (is_current) {
        gateway::FromGuest received;
        received.mutable_received()->set_bytes(frames.back().received);
        say(received);
    }
    if (Clock::now() - viewers_said_ < kViewersAgain) return;
    viewers_said_ = Clock::now();
    for (const auto& [sender, viewer] : viewers_) samples_[gateway::Sample::VIEWER].push_back(viewer);
}

void GatewaySession::sort(gateway::Sample& sample) {
    if (!gateway::Sample::Topic_IsValid(sample.topic())) return;
    uint64_t there = 0, here = 0;
    {
        const std::lock_guard lock(mutex_);
        there = welcome_.sender();
        here = own_sender_;
    }
    if (sample.topic() == gateway::Sample::VIEWER) {
        if (sample.key() == there) return;
        viewers_[sample.key()] = sample;
        if (sample.payload().empty()) viewers_.erase(sample.key());
    }
    if (sample.topic() == gateway::Sample::STATUS) {
        topics::Status status;
        if (status.ParseFromString(sample.payload()) && status.last_command_sender() == there && here != 0) {
            status.set_last_command_sender(here);
            sample.set_payload(status.SerializeAsString());
        }
    }
    auto& waiting = samples_[size_t(sample.topic())];
    if (waiting.size() >= kMostWaiting && sample.topic() != gateway::Sample::NODE_MESH) waiting.pop_front();
    waiting.push_back(std::move(sample));
}

}  // namespace bonemill::connect
