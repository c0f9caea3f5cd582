// Mutated files go through every reader of the study tool: each is taken or refused in one plain line,
// nothing crashes (nor makes a sanitizer speak), and what is taken comes back the same.
#include <gtest/gtest.h>

#include "common/base/user_error.h"
#include "haptic_server/teaching/study/shipped_files.h"
#include "haptic_server/teaching/study/study_folder.h"
#include "tests/support/mutated_bytes.h"

namespace bonemill::study {
namespace {

constexpr int kRounds = 3000;

// How many of the mutated texts `read` takes.
template <class Read>
int taken(const std::string& valid, unsigned seed, const Read& read) {
    std::mt19937 random(seed);
    int count = 0;
    for (int round = 0; round < kRounds; ++round) {
        try {
            read(test::mutated(valid, random));
            ++count;
        } catch (const UserError& error) {
            EXPECT_EQ(std::string(error.what()).find_first_of("\n\x1b"), std::string::npos) << error.what();
        }
    }
    EXPECT_LT(count, kRounds) << "some are refused";
    return count;
}

TEST(StudyFuzz, Forms) {
    for (const ShippedFile& file : shippedForms())
        EXPECT_GT(taken(std::string(file.text), 1,
                        [](const std::string& text) {
                            const Form form = parseForm(text, "fuzz");
                            EXPECT_FALSE(form.items().empty());
                        }),
                  0);
}

TEST(StudyFuzz, Protocols) {
    EXPECT_GT(taken(exampleProtocol(), 2,
                    [](const std::string& text) {
                        const Protocol protocol = parseProtocol(text, "fuzz");
                        for (const Group& group : protocol.groups)
                            EXPECT_FALSE(plannedSessions(protocol, group.id, 3).empty());
                    }),
              0);
}

TEST(StudyFuzz, AnswersAndParticipants) {
    const Form form = parseForm(std::string(shippedForms().back().text), "form");
    Answers answers;
    answers.study = "s";
    answers.pseudonym = "P001";
    answers.session = newUuid();
    answers.form = form.id;
    answers.form_digest = form.digest;
    for (const Item* item : form.items()) {
        if (item->takesWords())
            answers.values[item->id] = std::string("väl");
        else if (item->range)
            answers.values[item->id] = item->range->least;
        else
            answers.values[item->id] = item->options.back().value;
    }
    EXPECT_GT(taken(toJson(answers), 3,
                    [&](const std::string& text) {
                        const Answers read = parseAnswers(parseJson(text, "fuzz"), "fuzz", form);
                        const Answers again = parseAnswers(parseJson(toJson(read), "fuzz"), "fuzz", form);
                        EXPECT_EQ(read.values, again.values);
                        EXPECT_EQ(read.left_out, again.left_out);
                    }),
              0);
    Participant person{
        "P001", "g", 0, true, false, "", {{newUuid(), 0, "", "", 0}, {newUuid(), 1, "c", "t", 1}}};
    EXPECT_GT(taken(toJson(person), 4,
                    [](const std::string& text) {
                        const Participant read = parseParticipant(parseJson(text, "fuzz"), "fuzz");
                        EXPECT_EQ(toJson(parseParticipant(parseJson(toJson(read), "fuzz"), "fuzz")),
                                  toJson(read));
                    }),
              0);
}

}  // namespace
}  // namespace bonemill::study
