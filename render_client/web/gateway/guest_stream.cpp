#include "render_client/web/gateway/guest_stream.h"

#include <algorithm>
#include <cmath>
#include <utility>

namespace bonemill::gateway {
namespace {

constexpr double kAhead_s = 0.3;
constexpr double kMaxCredit_s = 0.25;
constexpr double kRateFading = 0.9;  // per measurement
// The way may have become longer; but what waits on it in a queue of our own making must not count much.
constexpr std::chrono::seconds kTripForgotten{10};
constexpr double kTripGrowth = 1.1;
constexpr double kShortestTrip_s = 1e-4;

double secondsOf(std::chrono::steady_clock::duration time) {
    return std::chrono::duration<double>(time).count();
}

constexpr size_t kEnvelope = 24;  // bytes around a payload, at most
constexpr size_t kMaxAnswers = 8;
constexpr std::chrono::seconds kOrderLasts{1};  // then the tool may be elsewhere

// What is small and changes often comes before what is large. What comes later waits for the whole bone at
// first.
constexpr int kFirstLaterRank = 2;

int rankOf(Topic topic) {
    switch (topic) {
        case Sample::SCENE_INFO:
            return 0;
        case Sample::LESSON:
            return kFirstLaterRank;
        case Sample::REMARK:
            return kFirstLaterRank + 1;
        case Sample::STRUCTURE_MESH:
            return kFirstLaterRank + 2;
        case Sample::SCENE_PICTURE:
            return kFirstLaterRank + 3;
        default:
            return 1;
    }
}

size_t add(Samples& samples, Topic topic, uint64_t key, const std::string& payload) {
    Sample& sample = *samples.add_samples();
    sample.set_topic(topic);
    sample.set_key(key);
    sample.set_payload(payload);
    return payload.size() + kEnvelope;
}

}  // namespace

SendWindow::SendWindow(double bytes_per_s, Clock::time_point now)
    : bytes_per_s_(bytes_per_s),
      trip_measured_(now),
      credit_(bytes_per_s * kMaxCredit_s),
      credited_(now),
      progress_(now) {}

bool SendWindow::isOpen(Clock::time_point now) {
    credit_ = std::min(credit_ + bytes_per_s_ * secondsOf(now - credited_), bytes_per_s_ * kMaxCredit_s);
    credited_ = now;
    return credit_ > 0 && bytesUnderWay() < window_;
}

size_t SendWindow::frameBytes() const {
    return std::clamp(window_ / 4, kMinFrame, kMaxFrame);
}

void SendWindow::sent(size_t bytes, bool has_more, Clock::time_point now) {
    if (bytesUnderWay() == 0) progress_ = now;
    sent_ += bytes;
    credit_ -= double(bytes);
    frames_.push_back({sent_, acknowledged_, now, has_more});
}

bool SendWindow::acknowledged(uint64_t total_bytes, Clock::time_point now) {
    if (total_bytes < acknowledged_ || total_bytes > sent_) return false;
    if (total_bytes == acknowledged_) return true;
    acknowledged_ = total_bytes;
    progress_ = now;
    std::optional<Frame> newest;
    while (!frames_.empty() && frames_.front().end <= total_bytes) {
        newest = frames_.front();
        frames_.pop_front();
    }
    if (newest) measure(*newest, now);
    return true;
}

void SendWindow::measure(const Frame& frame, Clock::time_point now) {
    const double trip_s = std::max(secondsOf(now - frame.at), kShortestTrip_s);
    if (now - trip_measured_ > kTripForgotten) {
        shortest_trip_s_ *= kTripGrowth;
        trip_measured_ = now;
    }
    if (shortest_trip_s_ == 0 || trip_s < shortest_trip_s_) {
        shortest_trip_s_ = trip_s;
        trip_measured_ = now;
    }
    const double rate = double(acknowledged_ - frame.acknowledged) / trip_s;
    // A link that had little to carry says only that it carries as much.
    link_bytes_per_s_ = frame.is_link_busy ? std::max(rate, kRateFading * link_bytes_per_s_)
                                           : std::max(rate, link_bytes_per_s_);
    if (!frame.is_link_busy && link_bytes_per_s_ <= rate) return;
    const double span_s = std::min(shortest_trip_s_, 1.0) + kAhead_s;
    const double most = std::max(bytes_per_s_ * span_s, double(kMin));
    window_ = size_t(std::clamp(link_bytes_per_s_ * span_s, double(kMin), most));
}

bool SendWindow::isStalled(Clock::time_point now) const {
    return bytesUnderWay() > 0 && now - progress_ > kLongestSilence;
}

GuestStream::GuestStream(const SessionState& state, const Hello& hello, double bytes_per_s,
                         Clock::time_point now)
    : state_(state), window_(bytes_per_s, now) {
    for (const auto& [key, payload] : state.small) small_.emplace(rankOf(key.topic), key);
    for (const auto& [leaf, node] : state.nodes) nodes_.insert(leaf);
    has_tool_state_ = state.tool_state.has_value();
    if (hello.epoch() != state.epoch) return;
    for (int i = 0; i < std::min(hello.leaves_size(), hello.revisions_size()); ++i) {
        const auto node = state.nodes.find(hello.leaves(i));
        if (node == state.nodes.end())
            nodes_.insert(hello.leaves(i));  // it is gone
        else if (node->second.revision == hello.revisions(i))
            nodes_.erase(hello.leaves(i));
    }
}

void GuestStream::note(const SessionChanges& changes) {
    if (changes.is_cleared) {
        small_.clear();
        nodes_.clear();
        order_.clear();
        bricks_.clear();
        counted_.Clear();
        has_bone_ = false;
    }
    for (const SmallKey& key : changes.small) small_.emplace(rankOf(key.topic), key);
    nodes_.insert(changes.nodes.begin(), changes.nodes.end());
    has_tool_state_ = has_tool_state_ || changes.has_tool_state;
    if (changes.counted) {
        counted_.set_events(counted_.events() | changes.counted->events());
        counted_.set_removed_mm3(counted_.removed_mm3() + changes.counted->removed_mm3());
    }
    for (const SessionChanges::Brick& brick : changes.bricks) {
        if (!wished_.contains(brick.number)) continue;
        if (bricks_.size() >= kMostBricks) bricks_.pop_front();
        bricks_.push_back(brick);
    }
}

void GuestStream::answer(uint64_t sender, uint32_t sequence, Answer answer) {
    if (answers_.size() < kMaxAnswers) answers_.push_back({sender, sequence, std::move(answer)});
}

bool GuestStream::hasNews() const {
    return !small_.empty() || !nodes_.empty() || has_tool_state_ || !bricks_.empty() || !answers_.empty();
}

bool GuestStream::isDue(Clock::time_point now) {
    const bool is_told = has_said_ && said_server_ == state_.has_server && said_ended_ == state_.has_ended;
    return (!is_told || hasNews() || now - said_ >= kHeartbeat) && window_.isOpen(now);
}

std::string GuestStream::next(Clock::time_point now) {
    if (!isDue(now)) return {};
    ToGuest frame;
    Samples& samples = *frame.mutable_samples();
    samples.set_has_server(said_server_ = state_.has_server);
    samples.set_has_ended(said_ended_ = state_.has_ended);
    has_said_ = true;
    said_ = now;
    const size_t most = window_.frameBytes();
    addStatus(samples);
    addToolState(samples);
    size_t size = addSmall(samples, 0, most);
    if (!isNextSmall()) {
        orderNodes(now);
        size = addNodes(samples, size, most);
        has_bone_ = has_bone_ || nodes_.empty();
        size = addSmall(samples, size, most);
        if (small_.empty()) addBricks(samples, size, most);
    }
    std::string bytes = frame.SerializeAsString();
    window_.sent(bytes.size(), hasNews(), now);
    return bytes;
}

// A status of an own answer looks as if the server had said it: that is where guests look for answers.
void GuestStream::addStatus(Samples& samples) {
    if (!state_.status) return answers_.clear();
    for (const OwnAnswer& own : std::exchange(answers_, {})) {
        topics::Status status = *state_.status;
        status.set_last_command_sender(own.sender);
        status.set_last_command_sequence(own.sequence);
        status.set_last_command_result(own.answer.text);
        status.set_last_command_outcome(own.answer.outcome);
        add(samples, Sample::STATUS, 0, status.SerializeAsString());
    }
    const auto key = std::pair(rankOf(Sample::STATUS), SmallKey{Sample::STATUS, 0});
    if (small_.erase(key) > 0 || samples.samples_size() > 0)
        add(samples, Sample::STATUS, 0, *state_.small.at(key.second));
}

void GuestStream::addToolState(Samples& samples) {
    if (!std::exchange(has_tool_state_, false) || !state_.tool_state) return;
    topics::ToolState state = *state_.tool_state;
    if (state.has_effects()) {
        state.mutable_effects()->set_events(counted_.events());
        state.mutable_effects()->set_removed_mm3(counted_.removed_mm3());
    }
    counted_.Clear();
    add(samples, Sample::TOOL_STATE, 0, state.SerializeAsString());
}

bool GuestStream::isNextSmall() const {
    return !small_.empty() && (has_bone_ || small_.begin()->first < kFirstLaterRank);
}

size_t GuestStream::addSmall(Samples& samples, size_t size, size_t most) {
    while (isNextSmall() && size < most) {
        const SmallKey key = small_.begin()->second;
        const auto held = state_.small.find(key);
        const bool is_there = held != state_.small.end();
        if (is_there && size > 0 && size + held->second->size() > most) break;
        small_.erase(small_.begin());
        size += add(samples, key.topic, key.key, is_there ? *held->second : std::string());
    }
    return size;
}

// What is few was changed together and is shown together; what is many comes by and by.
size_t GuestStream::addNodes(Samples& samples, size_t size, size_t most) {
    if (areNodesFew(std::min(kMaxTogether, std::max(most, window_.bytes() / 2)))) {
        for (const uint32_t leaf : std::exchange(nodes_, {})) size += addNode(samples, leaf);
        order_.clear();
    }
    while (!order_.empty() && size < most) {
        const uint32_t leaf = order_.back();
        order_.pop_back();
        if (nodes_.erase(leaf) > 0) size += addNode(samples, leaf);
    }
    return size;
}

bool GuestStream::areNodesFew(size_t most) const {
    size_t size = 0;
    for (const uint32_t leaf : nodes_) {
        const auto node = state_.nodes.find(leaf);
        size += kEnvelope + (node == state_.nodes.end() ? 0 : node->second.payload->size());
        if (size > most) return false;
    }
    return true;
}

void GuestStream::orderNodes(Clock::time_point now) {
    if (!order_.empty() && now - ordered_ < kOrderLasts) return;
    ordered_ = now;
    std::vector<std::pair<float, uint32_t>> by_distance;
    by_distance.reserve(nodes_.size());
    for (const uint32_t leaf : nodes_) {
        const auto node = state_.nodes.find(leaf);
        by_distance.emplace_back(
            node == state_.nodes.end() ? 0.0f : -(node->second.place_V - state_.tool_V).squaredNorm(), leaf);
    }
    std::ranges::sort(by_distance);
    order_.clear();
    for (const auto& [distance, leaf] : by_distance) order_.push_back(leaf);
}

size_t GuestStream::addNode(Samples& samples, uint32_t leaf) const {
    const auto node = state_.nodes.find(leaf);
    if (node == state_.nodes.end()) return add(samples, Sample::NODE_MESH, leaf, "");
    const size_t size = add(samples, Sample::NODE_MESH, leaf, *node->second.payload);
    samples.mutable_samples()->rbegin()->set_revision(node->second.revision);
    return size;
}

void GuestStream::addBricks(Samples& samples, size_t size, size_t most) {
    while (!bricks_.empty() && size < most) {
        size += add(samples, Sample::DENSITY_BRICK, bricks_.front().number, *bricks_.front().payload);
        bricks_.pop_front();
    }
}

}  // namespace bonemill::gateway
