// A viewer's wishes reach the device while pictures are slow, and end when it hangs, lets go or is gone.
#include <gtest/gtest.h>

#include <memory>
#include <vector>

#include "common/device_messages/device_messages.h"
#include "device_daemon/hands/pointer/hand_wish.h"
#include "render_client/link/subscribe/viewer_voice.h"
#include "tests/support/dds_session.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

using test::waitFor;

class Speaker : public testing::Test {
  protected:
    Speaker()
        : participant_(testDomain()),
          reader_(participant_),
          speaker_(std::make_unique<HandSpeaker>(participant_, testSession(), 7, topics::Viewer::OPERATOR)) {}

    void hear() {
        reader_.take(256, [this](const dds::HandPointerSample& sample, const dds::SampleInfo& info) {
            if (!info.has_data || sample.session != testSession()) return;
            const auto wish = parseHandWish(dds::payloadOf(sample), sample.sender);
            ASSERT_TRUE(wish);
            EXPECT_TRUE(heard_.empty() || wish->sequence > heard_.back().sequence);
            heard_.push_back(*wish);
        });
    }
    bool isHeard(size_t count) {
        return waitFor([&] {
            hear();
            return heard_.size() >= count;
        });
    }

    dds::Participant participant_;
    dds::Reader<dds::HandPointerSample> reader_;
    std::vector<HandWish> heard_;
    std::unique_ptr<HandSpeaker> speaker_;
};

TEST_F(Speaker, RepeatsAWishWhilePicturesAreSlowAndFallsSilentWhenTheyStop) {
    speaker_->want({{0.1, 0.2, 0.3}, expRotation({0.1, 0, 0})}, kButtonRemove, 3, 42);
    ASSERT_TRUE(isHeard(5));
    for (const HandWish& wish : heard_) {
        EXPECT_TRUE(wish.is_holding && wish.may_hold);
        EXPECT_EQ(wish.buttons, uint32_t{kButtonRemove});
        EXPECT_EQ(wish.placements, 3u);
        EXPECT_EQ(wish.X_WT.position.y(), 0.2);
    }
    size_t before = 0;
    EXPECT_TRUE(waitFor([&] {
        before = heard_.size();
        std::this_thread::sleep_for(4 * HandSpeaker::kRepeat);
        hear();
        return heard_.size() == before;
    })) << "no picture has come for long";
    speaker_->want({}, 0, 0, 42);
    EXPECT_TRUE(isHeard(before + 2));
}

TEST_F(Speaker, LettingGoIsRepeatedForAWhile) {
    speaker_->want({}, 0, 0, 42);
    ASSERT_TRUE(isHeard(1));
    speaker_->letGo(42);
    EXPECT_TRUE(waitFor([&] {
        hear();
        return heard_.size() > 1 && !heard_.back().is_holding && !heard_[heard_.size() - 2].is_holding;
    }));
}

TEST_F(Speaker, TheEndOfTheViewerLetsGo) {
    speaker_->want({}, kButtonAdd, 0, 42);
    ASSERT_TRUE(isHeard(1));
    speaker_.reset();
    EXPECT_TRUE(waitFor([&] {
        hear();
        return !heard_.back().is_holding;
    }));
}

TEST_F(Speaker, WhoNeverHoldsSaysNothing) {
    speaker_->letGo(42);
    speaker_.reset();
    hear();
    EXPECT_TRUE(heard_.empty());
}

}  // namespace
}  // namespace bonemill
