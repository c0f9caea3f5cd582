// Tells device_daemon where this viewer's mouse wants the tool (topic HandPointer).
//
// A thread of its own, which begins with the first wish, writes each wish at once and repeats it while
// pictures are slow, so that only a viewer that hangs or is gone falls silent. The functions are for one
// thread; none waits for DDS.
#pragma once

#include <chrono>
#include <condition_variable>
#include <mutex>
#include <thread>

#include "common/geometry/pose.h"
#include "proto/topics.pb.h"
#include "render_client/link/subscribe/wire.h"

namespace bonemill {

class HandSpeaker {
  public:
    static constexpr std::chrono::milliseconds kRepeat{50};
    static constexpr std::chrono::milliseconds kLongestPicture{1000};  // who has no newer wish hangs
    static constexpr std::chrono::milliseconds kFarewell{
        500};  // letting go is repeated: a message may be lost

    // Says so as this sender and role, in messages that are counted from `first_wish`. What the wire names
    // must outlive the object.
    HandSpeaker(const Wire& wire, uint32_t session, uint64_t sender, topics::Viewer::Role role,
                uint32_t first_wish = 1);
    // Lets go.
    ~HandSpeaker();

    // The tool point is wanted there, with these Button bits, by a viewer that shows this run of the server.
    // A new number of placements asks for it there without a way there.
    void want(const Pose& X_WT, uint32_t buttons, uint32_t placements, uint64_t epoch);
    // The tool is held no more.
    void letGo(uint64_t epoch);
    // Returns a number that no message of this object has reached yet, nor will with its last words.
    uint32_t nextWish();

  private:
    using Clock = std::chrono::steady_clock;
    void say(topics::HandPointer message, uint64_t epoch);
    void speak();
    void write(std::unique_lock<std::mutex>& lock);

    const uint32_t session_;
    const uint64_t sender_;
    const topics::Viewer::Role role_;
    Outlet<dds::HandPointerSample> writer_;
    std::mutex mutex_;
    std::condition_variable changed_;
    // The mutex guards these.
    topics::HandPointer message_;
    Clock::time_point said_;
    uint32_t sequence_;
    bool has_news_ = false;
    bool should_stop_ = false;

    std::thread thread_;
};

}  // namespace bonemill
