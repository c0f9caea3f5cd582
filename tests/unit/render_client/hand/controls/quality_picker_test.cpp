#include "render_client/hand/controls/quality_picker.h"

#include <gtest/gtest.h>

namespace bonemill {
namespace {

// A PC whose pictures take so long (s), whatever is picked.
struct Speed {
    double quick, full;
};

class Pc {
  public:
    explicit Pc(bool is_software) : picker_(is_software) {}

    // Draws for so long (s), and counts how often the quality changes.
    void draw(double seconds, const Speed& speed, bool moves = true) {
        for (const double end = now_ + seconds; now_ < end;) {
            const Quality before = picker_.quality();
            const double picture = before == Quality::kFull ? speed.full : speed.quick;
            now_ += picture;
            picker_.take(picture, moves, now_);
            changes_ += picker_.quality() != before;
        }
    }
    QualityPicker picker_;
    double now_ = 1000;  // s
    int changes_ = 0;
};

constexpr Speed kFastCard{0.004, 0.016}, kSlowCard{0.016, 0.080}, kSoftware{0.120, 0.900};

TEST(QualityPicker, AGraphicsCardThatIsFastStaysFull) {
    Pc pc(false);
    EXPECT_EQ(pc.picker_.quality(), Quality::kFull);
    pc.draw(300, kFastCard);
    EXPECT_EQ(pc.picker_.quality(), Quality::kFull);
    EXPECT_EQ(pc.changes_, 0);
}

TEST(QualityPicker, SoftwareThatIsSlowStaysQuick) {
    Pc pc(true);
    EXPECT_EQ(pc.picker_.quality(), Quality::kQuick);
    pc.draw(300, kSoftware);
    EXPECT_EQ(pc.changes_, 0);
    pc.draw(300, {0.001, 0.900}, false);
    EXPECT_EQ(pc.changes_, 0) << "a view that rests tells nothing of whole pictures";
}

TEST(QualityPicker, SoftwareOnAFastPcBecomesFull) {
    Pc pc(true);
    pc.draw(QualityPicker::kFirstWait - 1, kFastCard);
    EXPECT_EQ(pc.changes_, 0) << "not at once";
    pc.draw(300, kFastCard);
    EXPECT_EQ(pc.picker_.quality(), Quality::kFull);
    EXPECT_EQ(pc.changes_, 1);
}

TEST(QualityPicker, SlowFullPicturesBecomeQuickWithinAFewPictures) {
    Pc pc(false);
    pc.draw(double(QualityPicker::kPictures) * kSlowCard.full, kSlowCard);
    EXPECT_EQ(pc.picker_.quality(), Quality::kQuick);
}

TEST(QualityPicker, TrialsThatFailBecomeRare) {
    Pc pc(false);
    pc.draw(3600, kSlowCard);
    EXPECT_EQ(pc.picker_.quality(), Quality::kQuick);
    EXPECT_LE(pc.changes_, 13) << "an hour is six trials, each there and back";
    EXPECT_GE(pc.changes_, 5) << "it does try";
}

TEST(QualityPicker, OneHopelessPictureEndsATrial) {
    Pc pc(true);
    const Speed rests_fast{0.010, 0.900};
    pc.draw(QualityPicker::kFirstWait + 0.02, rests_fast);
    EXPECT_EQ(pc.changes_, 1) << "the trial";
    pc.draw(1, rests_fast);
    EXPECT_EQ(pc.changes_, 2) << "two pictures were enough";
}

TEST(QualityPicker, BetweenFastAndSlowNothingChanges) {
    const Speed middling{0.030, 0.045};
    for (const bool is_software : {false, true}) {
        Pc pc(is_software);
        pc.draw(600, middling);
        EXPECT_EQ(pc.changes_, 0) << is_software;
    }
}

TEST(QualityPicker, ASingleSlowPictureChangesNothing) {
    Pc pc(false);
    pc.draw(100, kFastCard);
    pc.draw(2, {2, 2});
    pc.draw(100, kFastCard);
    EXPECT_EQ(pc.changes_, 0);
}

TEST(QualityPicker, AfterALoadThatHasGoneItIsFullAgain) {
    Pc pc(false);
    pc.draw(100, kFastCard);
    pc.draw(20, kSlowCard);
    EXPECT_EQ(pc.picker_.quality(), Quality::kQuick);
    pc.draw(100, kFastCard);
    EXPECT_EQ(pc.picker_.quality(), Quality::kFull);
}

}  // namespace
}  // namespace bonemill
