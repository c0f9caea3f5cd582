// All that a study has gathered, read once, and what can be measured in it. Pure after reading; any thread
// may read it.
#pragma once

#include "haptic_server/teaching/study/study_folder.h"
#include "haptic_server/teaching/study_statistics/rank_tests.h"
#include "haptic_server/teaching/study_statistics/samples.h"

namespace bonemill::study {

// One form of one session with at least one answer.
struct FilledForm {
    size_t person = 0;
    Session session;
    const Form* form = nullptr;
    Answers answers;
};

struct StudyData {
    const StudyFolder* folder = nullptr;  // outlives it
    std::vector<Participant> people;
    std::vector<FilledForm> filled;
    std::map<std::string, RunRecord> runs;  // by session

    const Protocol& protocol() const { return folder->protocol(); }
};

StudyData readStudy(const StudyFolder& folder);

// A rating item or a score. Values are of single sessions.
struct Measure {
    struct Value {
        size_t person = 0;
        std::string condition;  // empty for what was asked once per visit
        double value = 0;
    };
    const Form* form = nullptr;
    std::string block, id, title;
    bool is_score = false;
    bool has_share = false;  // a question of few steps that stands by itself
    std::vector<Value> values;

    // Tells whether it was asked in sessions of conditions, and not only once per visit.
    bool hasConditions() const;
    // The mean over a person's sessions, of one condition unless it is empty. What was asked once per visit
    // is no session's where there are conditions: it is a baseline. People without an answer are not there:
    // people are independent of each other, sessions of one person are not.
    std::map<size_t, double> byPerson(const std::string& condition = "") const;
};

// Equal answers give equal means, in whatever order they were added up: else ranks would tell them apart.
double withoutRounding(double value);

// In the order of forms, blocks and items; a form's scores after its items. Those without any answer are left
// out.
std::vector<Measure> measuresOf(const StudyData& data);

// The means of the people of one group.
std::vector<double> ofGroup(const StudyData& data, const Measure& measure, const std::string& group);

struct Alpha {
    const Form* form = nullptr;
    std::string block;
    size_t people = 0, items = 0;
    double alpha = kNotKnown;
};

// Cronbach's alpha of each block of two or more ratings, over the people who answered all of it. The even
// statements of SUS, which are against the system, are turned round.
std::vector<Alpha> alphasOf(const StudyData& data, const std::vector<Measure>& measures);

// Every comparison that a study's protocol leads to has two tests and effect sizes, and P adjusted for their
// number. This is one of two groups of people; each person counts once.
struct GroupComparison {
    const Measure* measure = nullptr;
    std::string first, second;
    Summary of_first, of_second;
    TTest welch;
    RankTest rank;
    double g = kNotKnown, delta = kNotKnown, auc = kNotKnown;
    Interval of_g, of_delta, of_auc;
    double holm_welch = kNotKnown, holm_rank = kNotKnown;
};

// Two conditions, by the people who answered under both.
struct ConditionComparison {
    const Measure* measure = nullptr;
    std::string first, second;
    Summary of_first, of_second;
    TTest paired;
    RankTest pratt;
    double d = kNotKnown;  // mean difference over the differences' standard deviation
    double holm_paired = kNotKnown, holm_pratt = kNotKnown;
};

// A family, in which Holm's adjustment counts, is all items of a form, or all its scores, over all pairs.
std::vector<GroupComparison> compareGroups(const StudyData& data, const std::vector<Measure>& measures);
std::vector<ConditionComparison> compareConditions(const StudyData& data,
                                                   const std::vector<Measure>& measures);

}  // namespace bonemill::study
