#include "haptic_server/teaching/study/form.h"

#include <gtest/gtest.h>

#include "common/base/user_error.h"
#include "haptic_server/teaching/study/ask_form.h"
#include "haptic_server/teaching/study/shipped_files.h"

namespace bonemill::study {
namespace {

Form shipped(const std::string& id) {
    for (const ShippedFile& file : shippedForms())
        if (file.name == id + ".json") return parseForm(std::string(file.text), id);
    throw UserError("no form " + id);
}

std::string refusalOfForm(const std::string& text) {
    try {
        parseForm(text, "form.json");
    } catch (const UserError& error) {
        return error.what();
    }
    return "";
}

std::string formWith(const std::string& item, const std::string& more = "") {
    return R"({"form": "f", "version": 1, "language": "en", "title": "T", )" + more +
           R"("scales": {"s": {"rating": true, "options": [{"value": 1, "text": "no"}, {"value": 2, "text": "yes"}]},
              "n": {"least": 0, "most": 10, "step": 0.5}, "w": {"most_letters": 5}},
              "blocks": [{"id": "b", "title": "B", "items": [)" +
           item + "]}]}";
}

TEST(StudyForm, TheThesisQuestionnaireHasItsQuestions) {
    const Form form = shipped("thesis_5_4");
    ASSERT_EQ(form.blocks.size(), 5u);
    const size_t sizes[] = {7, 6, 8, 1, 3};
    for (size_t i = 0; i < 5; ++i) EXPECT_EQ(form.blocks[i].items.size(), sizes[i]) << form.blocks[i].id;
    size_t ratings = 0;
    for (const Item* item : form.items())
        if (item->is_rating) {
            ++ratings;
            ASSERT_EQ(item->options.size(), 5u) << item->id;
            for (size_t i = 0; i < 5; ++i) EXPECT_EQ(item->options[i].value, double(i + 1));
        }
    EXPECT_EQ(ratings, 16u);  // as many tests the thesis could make
    EXPECT_EQ(form.find("2g")->text, "Depth perception");
    EXPECT_EQ(form.find("5")->options.size(), 3u);
    EXPECT_EQ(form.find("nothing"), nullptr);
}

TEST(StudyForm, SusGoesFromZeroToAHundred) {
    const Form form = shipped("sus");
    const auto score = [&](double odd, double even) {
        Values values;
        for (size_t i = 0; i < 10; ++i) values[form.items()[i]->id] = i % 2 ? even : odd;
        return scoresOf(form, values).at(0).value;
    };
    EXPECT_EQ(score(5, 1), 100);
    EXPECT_EQ(score(1, 5), 0);
    EXPECT_EQ(score(3, 3), 50);
    EXPECT_EQ(score(4, 2), 75);
    Values one_missing;
    for (size_t i = 0; i < 9; ++i) one_missing[form.items()[i]->id] = 3.0;
    EXPECT_TRUE(scoresOf(form, one_missing).empty());
}

TEST(StudyForm, NasaTlxWeighsByHowOftenARatingWasChosen) {
    const Form form = shipped("nasa_tlx");
    Values values;
    const std::map<std::string, double> ratings = {{"mental", 80},   {"physical", 20},
                                                   {"temporal", 50}, {"performance", 30},
                                                   {"effort", 60},   {"frustration", 10}};
    for (const auto& [id, rating] : ratings) values[id] = rating;
    EXPECT_DOUBLE_EQ(scoresOf(form, values).at(0).value, 250.0 / 6);
    EXPECT_EQ(scoresOf(form, values).size(), 1u) << "without the pairs there is no weighted score";
    // The higher rating always: weights 5, 4, 3, 2, 1 and 0 in the ratings' order.
    for (const Item& pair : form.blocks[1].items) {
        const Option &first = pair.options[0], &second = pair.options[1];
        values[pair.id] =
            ratings.at(first.counts_for) > ratings.at(second.counts_for) ? first.value : second.value;
    }
    const double weighted = (5 * 80 + 4 * 60 + 3 * 50 + 2 * 30 + 1 * 20 + 0 * 10) / 15.0;
    ASSERT_EQ(scoresOf(form, values).size(), 2u);
    EXPECT_DOUBLE_EQ(scoresOf(form, values)[1].value, weighted);
    EXPECT_EQ(form.blocks[1].items.size(), 15u);
    EXPECT_EQ(shipped("nasa_tlx_raw").items().size(), 6u);
}

TEST(StudyForm, AnAnswerMustBeOneOfTheScale) {
    const Form form =
        parseForm(formWith(R"({"id": "a", "text": "A", "scale": "s"}, {"id": "b", "text": "B", "scale": "n"},
                                            {"id": "c", "text": "C", "scale": "w"})"),
                  "f");
    const Item &choice = *form.find("a"), &number = *form.find("b"), &words = *form.find("c");
    EXPECT_EQ(wrongWith(choice, 2.0), "");
    EXPECT_NE(wrongWith(choice, 3.0), "");
    EXPECT_NE(wrongWith(choice, std::string("yes")), "");
    EXPECT_EQ(wrongWith(number, 9.5), "");
    EXPECT_NE(wrongWith(number, 9.4), "");
    EXPECT_NE(wrongWith(number, 10.5), "");
    EXPECT_NE(wrongWith(number, double(NAN)), "");
    EXPECT_EQ(wrongWith(words, std::string("ÄÖÜäö")), "") << "five letters, ten bytes";
    EXPECT_NE(wrongWith(words, std::string("123456")), "");
    EXPECT_NE(wrongWith(words, std::string("a\x1b[2J")), "") << "no orders to a terminal";
    EXPECT_NE(wrongWith(words, std::string("\xff")), "");
    EXPECT_NE(wrongWith(words, std::string("\xe2\x80\xae")), "") << "no turned writing";
    EXPECT_EQ(std::get<double>(std::get<Answer>(answerOf(choice, "2"))), 2);
    for (const char* line : {"0", "3", "1.5", "x", "1 ", "nan", "inf", "-1", "1e9", ""})
        EXPECT_EQ(answerOf(choice, line).index(), 1u) << line;
}

TEST(StudyForm, RefusesWhatIsNoForm) {
    const char* item = R"({"id": "a", "text": "A", "scale": "s"})";
    EXPECT_EQ(refusalOfForm(formWith(item)), "");
    const std::pair<std::string, std::string> cases[] = {
        {"", "is not valid JSON"},
        {"[]", "is no object"},
        {"{\"form\": \"f\", \"form\": \"g\"}", "\"form\" twice"},
        {std::string(50, '[') + std::string(50, ']'), "12 levels"},
        {std::string(2 << 20, ' '), "1 MiB"},
        {std::string("\xff\xfe{\0", 4), "UTF-16"},
        {formWith(item, R"("colour": 1, )"), "does not know a field \"colour\""},
        {formWith(R"({"id": "a", "text": "A", "scale": "x"})"), "which \"scales\" does not have"},
        {formWith(R"({"id": "../a", "text": "A", "scale": "s"})"), "letters, digits"},
        {formWith(std::string(item) + "," + item), "stands in the form twice"},
        {formWith(R"({"id": "a", "text": "A\u001b", "scale": "s"})"), "control characters"},
        {formWith(
             R"({"id": "a", "text": "A", "options": [{"value": 1, "text": "x"}, {"value": 1, "text": "y"}]})"),
         "twice"},
        {formWith(
             R"({"id": "a", "text": "A", "options": [{"value": 1e999, "text": "x"}, {"value": 1, "text": "y"}]})"),
         "too large"},
        {formWith(item, R"("scoring": "sus", )"), "ten items"},
        {formWith(item, R"("scoring": "nasa_tlx", )"), "two or more ratings"},
        {formWith(item, R"("scoring": "best", )"), "none, nasa_tlx or sus"},
    };
    for (const auto& [text, words] : cases)
        EXPECT_NE(refusalOfForm(text).find(words), std::string::npos) << text.substr(0, 300) << "\n"
                                                                      << refusalOfForm(text);
}

TEST(StudyForm, ThePageHoldsTheFormAndNoTextOfItEndsItsScript) {
    const std::string text =
        formWith(R"({"id": "a", "text": "</script><script>alert(1)</script> & <!--", "scale": "s"})");
    const Form form = parseForm(text, "f");
    Answers answers;
    answers.pseudonym = "P001";
    answers.values["a"] = 2.0;
    const std::string page = formPage(text, answers);
    EXPECT_EQ(page.find("alert(1)</script>"), std::string::npos);
    EXPECT_NE(page.find("\\u003c/script\\u003e"), std::string::npos);
    EXPECT_NE(page.find("default-src 'none'"), std::string::npos);
    EXPECT_EQ(page.find("/*FORM*/"), std::string::npos);
    EXPECT_NE(page.find("\"a\":2.0"), std::string::npos) << "what was answered is filled in";
}

}  // namespace
}  // namespace bonemill::study
