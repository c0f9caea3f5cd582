#include "haptic_server/teaching/lessons/remark_list.h"

#include <gtest/gtest.h>

#include <limits>

namespace bonemill {
namespace {

// The volume is a cube of 20 mm at x = 100 mm in W.
class RemarkListTest : public testing::Test {
  protected:
    static VolumeGeometry volume() {
        VolumeGeometry geometry;
        geometry.dims = {40, 40, 40};
        geometry.spacing = Eigen::Vector3d::Constant(0.5e-3);
        geometry.X_WV.position = {0.1, 0, 0};
        return geometry;
    }
    static topics::Command noteOf(const std::string& text, const std::vector<float>& points = {}) {
        topics::Command command;
        command.set_name("Anna");
        command.set_role(topics::Viewer::INSTRUCTOR);
        command.mutable_add_remark()->set_note(text);
        command.mutable_add_remark()->mutable_points_m()->Assign(points.begin(), points.end());
        return command;
    }
    static topics::Command strokeOf(int points) {
        topics::Command command = noteOf("");
        for (int n = 0; n < points; ++n)
            for (const double value : {0.1 + 1e-5 * n, 0.01, 0.01})
                command.mutable_add_remark()->add_points_m(float(value));
        return command;
    }
    std::string add(const topics::Command& command) { return book_.add(command, 12.5).text; }

    RemarkList book_{volume()};
};

TEST_F(RemarkListTest, TheServerSaysWhoSaidWhatAndWhen) {
    topics::Command command = noteOf(
        "drill \xc3\xbc"
        "ber here",
        {0.11f, 0.01f, 0.01f});
    command.mutable_add_remark()->set_author("Somebody else");
    command.mutable_add_remark()->set_role(topics::Viewer::EXAMINER);
    command.mutable_add_remark()->set_session_s(99);
    command.mutable_add_remark()->set_number(77);
    command.mutable_add_remark()->set_color(0xff123456);
    ASSERT_EQ(add(command), "done");
    const auto changes = book_.takeChanges();
    ASSERT_EQ(changes.size(), 1u);
    const topics::Remark& remark = changes[0].remark.value();
    EXPECT_EQ(remark.author(), "Anna");
    EXPECT_EQ(remark.role(), topics::Viewer::INSTRUCTOR);
    EXPECT_EQ(remark.session_s(), 12.5);
    EXPECT_EQ(remark.number(), 1u);
    EXPECT_EQ(remark.color(), 0x123456u);
    EXPECT_EQ(remark.note(),
              "drill \xc3\xbc"
              "ber here");
    EXPECT_EQ(remark.points_m_size(), 3);
    EXPECT_TRUE(book_.takeChanges().empty()) << "told once";
    command = strokeOf(2);
    command.set_name(std::string(63, 'x') + "\xc3\xbc");
    ASSERT_EQ(add(command), "done");
    EXPECT_EQ(book_.takeChanges().at(0).remark->author(), std::string(63, 'x')) << "whole letters only";
}

TEST_F(RemarkListTest, WhatIsEmptyTooMuchOrNowhereIsRefusedWithAReason) {
    constexpr float kNan = std::numeric_limits<float>::quiet_NaN();
    std::string umlauts;
    for (size_t n = 0; n < kMaxNoteLetters; ++n) umlauts += "\xc3\xbc";
    const std::pair<topics::Command, std::string> cases[] = {
        {noteOf(""), "refused: there is neither a note nor a stroke of two points"},
        {strokeOf(1), "refused: there is neither a note nor a stroke of two points"},
        {noteOf("  "), "refused: the note is empty"},
        {noteOf(umlauts + "x"), "refused: the note has 301 letters; 300 at most"},
        {noteOf("a\nb"), "refused: the note has characters that cannot be printed"},
        {strokeOf(kMaxRemarkPoints + 1), "refused: the stroke has 301 points; 300 at most"},
        {noteOf("x", {0.1f, 0}), "refused: a point has three coordinates"},
        {noteOf("x", {0.1f, 0, 0, 0.1f, 0, 0}), "refused: a note belongs to one place at most"},
        {noteOf("x", {0.1f, kNan, 0}), "refused: point 1 is not at the bone"},
        {noteOf("x", {0.1f, 0, std::numeric_limits<float>::infinity()}),
         "refused: point 1 is not at the bone"},
        {noteOf("", {0.1f, 0, 0, 0.04f, 0, 0}), "refused: point 2 is not at the bone"},
        {noteOf("", {0.1f, 0, 0, 0.1f, 0.071f, 0}), "refused: point 2 is not at the bone"}};
    for (const auto& [command, answer] : cases) EXPECT_EQ(add(command), answer);
    EXPECT_EQ(book_.count(), 0u);
    EXPECT_TRUE(book_.takeChanges().empty());
    EXPECT_EQ(add(noteOf(umlauts)), "done") << "letters count, not bytes";
    EXPECT_EQ(add(strokeOf(kMaxRemarkPoints)), "done");
    EXPECT_EQ(add(noteOf("x", {0.1f, 0.069f, 0})), "done") << "beside the bone";
    EXPECT_EQ(book_.takeChanges().back().remark->number(), 3u) << "what is refused has no number";
}

TEST_F(RemarkListTest, WhatIsErasedIsGoneAndItsPlaceFree) {
    for (const char* text : {"one", "two", "three"}) ASSERT_EQ(add(noteOf(text)), "done");
    book_.takeChanges();
    EXPECT_EQ(book_.erase(4).text, "refused: there is no note or stroke 4; it may be erased already");
    EXPECT_EQ(book_.erase(2).text, "done");
    auto changes = book_.takeChanges();
    ASSERT_EQ(changes.size(), 1u);
    EXPECT_EQ(changes[0].place, 1u);
    EXPECT_FALSE(changes[0].remark);
    ASSERT_EQ(add(noteOf("four")), "done");
    changes = book_.takeChanges();
    ASSERT_EQ(changes.size(), 1u);
    EXPECT_EQ(changes[0].place, 1u);
    EXPECT_EQ(changes[0].remark->number(), 4u) << "numbers are not given again";
    EXPECT_EQ(book_.erase(0).text, "done");
    EXPECT_EQ(book_.takeChanges().size(), 3u);
    EXPECT_EQ(book_.count(), 0u);
    EXPECT_EQ(book_.erase(0).text, "done");
}

TEST_F(RemarkListTest, TheOldestMakesRoom) {
    for (uint32_t n = 0; n < kMaxRemarks; ++n) ASSERT_EQ(add(noteOf("x")), "done");
    EXPECT_EQ(book_.takeChanges().size(), kMaxRemarks);
    ASSERT_EQ(book_.erase(11).text, "done");
    ASSERT_EQ(add(noteOf("fits")), "done");
    book_.takeChanges();
    for (const uint32_t place : {0u, 1u}) {
        ASSERT_EQ(add(noteOf("newer")), "done");
        const auto changes = book_.takeChanges();
        ASSERT_EQ(changes.size(), 1u);
        EXPECT_EQ(changes[0].place, place);
        EXPECT_EQ(changes[0].remark->note(), "newer");
    }
    EXPECT_EQ(book_.count(), kMaxRemarks);
    EXPECT_EQ(book_.erase(1).text, "refused: there is no note or stroke 1; it may be erased already");
}

}  // namespace
}  // namespace bonemill
