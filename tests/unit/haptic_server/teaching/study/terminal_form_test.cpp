#include <gtest/gtest.h>

#include <sstream>

#include "haptic_server/teaching/study/ask_form.h"

namespace bonemill::study {
namespace {

Form threeQuestions() {
    return parseForm(R"({"form": "f", "version": 1, "language": "en", "title": "T",
        "scales": {"s": {"options": [{"value": 10, "text": "no"}, {"value": 20, "text": "yes"}]}, "n": {"least": 0, "most": 9},
                   "w": {"most_letters": 20}},
        "blocks": [{"id": "b", "title": "B", "items": [{"id": "a", "text": "Choose", "scale": "s"},
            {"id": "b", "text": "Count", "scale": "n"}, {"id": "c", "text": "Tell", "scale": "w"}]}]})",
                     "f");
}

struct Filling {
    Form form = threeQuestions();
    Answers answers;
    size_t saves = 0;
    std::string shown;

    bool fill(const std::string& lines) {
        std::istringstream in(lines);
        std::ostringstream out;
        const bool is_finished = fillInTerminal(form, answers, in, out, [&](const Answers&) { ++saves; });
        shown = out.str();
        return is_finished;
    }
};

TEST(TerminalForm, TakesAnAnswerPerLineAndSavesEach) {
    Filling filling;
    EXPECT_TRUE(filling.fill("2\n7.5\nI liked it\n"));
    EXPECT_EQ(filling.answers.values, (Values{{"a", 20.0}, {"b", 7.5}, {"c", std::string("I liked it")}}));
    EXPECT_EQ(filling.saves, 3u);
}

TEST(TerminalForm, GoesOnWhereItWasStopped) {
    Filling filling;
    EXPECT_FALSE(filling.fill("2\n.\n"));
    EXPECT_EQ(filling.answers.values.size(), 1u);
    EXPECT_FALSE(filling.fill("3\n")) << "the input ended";
    EXPECT_EQ(filling.shown.find("Choose"), std::string::npos) << "answered before";
    EXPECT_TRUE(filling.fill("fine"));
    EXPECT_EQ(filling.answers.values.size(), 3u);
    EXPECT_TRUE(filling.fill("")) << "nothing is left to ask";
}

TEST(TerminalForm, LeavesOutAndGoesBack) {
    Filling filling;
    EXPECT_TRUE(filling.fill("1\n-\n<\n4\n-\n"));
    EXPECT_EQ(filling.answers.values, (Values{{"a", 10.0}, {"b", 4.0}}));
    EXPECT_EQ(filling.answers.left_out, std::vector<std::string>{"c"});
}

TEST(TerminalForm, AsksAgainWhatItCannotTake) {
    Filling filling;
    EXPECT_TRUE(filling.fill("3\nyes\n\n" + std::string(1 << 20, '1') + "\n<\n1\n10\n\x1b[A\n9\n" +
                             std::string(21, 'x') + "\n\xff\nok\r\n"));
    EXPECT_EQ(filling.answers.values, (Values{{"a", 10.0}, {"b", 9.0}, {"c", std::string("ok")}}));
    EXPECT_EQ(filling.saves, 3u);
    EXPECT_NE(filling.shown.find("type a number from 1 to 2"), std::string::npos);
    EXPECT_NE(filling.shown.find("too long"), std::string::npos);
}

}  // namespace
}  // namespace bonemill::study
