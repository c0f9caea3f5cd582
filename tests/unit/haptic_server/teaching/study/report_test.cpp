#include "haptic_server/teaching/study_report/report.h"

#include <gtest/gtest.h>

#include "common/base/user_error.h"
#include "haptic_server/teaching/study_report/agreement.h"
#include "haptic_server/teaching/study_report/plan_text.h"
#include "haptic_server/teaching/study_report/study_data.h"
#include "haptic_server/teaching/study_report/study_report_text.h"
#include "haptic_server/teaching/study_report/study_tables.h"
#include "tests/unit/haptic_server/teaching/study/study_rig.h"

namespace bonemill::study {
namespace {

// Four experts and four novices; the workload is 20 higher without, experts like depth perception better.
struct FilledRig : test::StudyRig {
    StudyFolder study{path};
    FilledRig() {
        for (size_t i = 0; i < 8; ++i) {
            const bool is_expert = i < 4;
            const Participant person = study.enrol(is_expert ? "expert" : "novice", "");
            study.save(filled(study, person, person.sessions[0], "thesis_5_4", [&](const std::string& id) {
                return id == "2g" ? (is_expert ? 5 : 2) : 1 + (i + id[0] + id.back()) % 5;
            }));
            study.save(filled(study, person, person.sessions[0], "sus", [](auto&) { return 4; }));
            for (const Session& session : person.sessions)
                if (session.period > 0)
                    study.save(filled(study, person, session, "nasa_tlx_raw", [&](const std::string& id) {
                        return 5 * (i + session.attempt) + (session.condition == "without" ? 20 : 0) +
                               (id == "effort" && i % 2 ? 5 : 0);
                    }));
        }
    }
};

TEST(StudyReport, APersonCountsOnceHoweverManySessions) {
    const FilledRig rig;
    const StudyData data = readStudy(rig.study);
    EXPECT_EQ(data.filled.size(), 8u * (2 + 4));
    const std::vector<Measure> measures = measuresOf(data);
    for (const Measure& measure : measures)
        if (measure.id == "mental") {
            EXPECT_EQ(measure.values.size(), 32u);
            ASSERT_EQ(ofGroup(data, measure, "novice").size(), 4u);
            // Person 4: attempts 1 and 2, each with and without: 25, 30, 45, 50.
            EXPECT_DOUBLE_EQ(ofGroup(data, measure, "novice")[0], 37.5);
            EXPECT_DOUBLE_EQ(measure.byPerson("without").at(4), 47.5);
        }
}

TEST(StudyReport, ComparesWithAFamilyPerFormAndSusByItsScoreOnly) {
    const FilledRig rig;
    const StudyData data = readStudy(rig.study);
    const std::vector<Measure> measures = measuresOf(data);
    const std::vector<GroupComparison> groups = compareGroups(data, measures);
    size_t of_thesis = 0, of_sus = 0;
    for (const GroupComparison& one : groups) {
        of_thesis += one.measure->form->id == "thesis_5_4";
        of_sus += one.measure->form->id == "sus";
        if (one.measure->id != "2g") continue;
        EXPECT_DOUBLE_EQ(one.auc, 1);
        EXPECT_DOUBLE_EQ(one.delta, 1);
        EXPECT_NEAR(one.rank.p, 2.0 / 70, 1e-12);  // wholly apart: 2 of the 70 ways to deal eight people out
        EXPECT_NEAR(one.holm_rank, 16 * 2.0 / 70, 1e-12) << "the smallest of sixteen";
    }
    EXPECT_EQ(of_thesis, 16u);
    EXPECT_EQ(of_sus, 1u);
    for (const ConditionComparison& one : compareConditions(data, measures)) {
        EXPECT_EQ(one.measure->form->id, "nasa_tlx_raw");
        EXPECT_EQ(one.of_first.n, 8u);
        EXPECT_DOUBLE_EQ(one.of_second.mean - one.of_first.mean, 20);
        EXPECT_NEAR(one.pratt.p, 2.0 / 256, 1e-12);  // all eight in one direction
    }
}

// The same form before all and after each: what is asked before is no session's, and has no condition.
struct BaselineRig : test::StudyRig {
    BaselineRig() {
        std::string protocol = test::kSmallProtocol;
        protocol.replace(protocol.find("\"forms_after\""), 0, "\"forms_before\": [\"nasa_tlx_raw\"], ");
        test::writeFile(path + "/protocol.json", protocol);
        StudyFolder study(path);
        for (size_t i = 0; i < 8; ++i) {
            const Participant person = study.enrol(i < 4 ? "expert" : "novice", "");
            for (const Session& session : person.sessions)
                study.save(filled(study, person, session, "nasa_tlx_raw", [&](const std::string&) {
                    return session.condition.empty() ? 100 : 5 * (i + (session.condition == "without"));
                }));
        }
    }
};

TEST(StudyReport, ABaselineIsOfNoConditionAndInNoComparison) {
    const BaselineRig rig;
    const StudyFolder study(rig.path);
    const StudyData data = readStudy(study);
    const std::vector<Measure> measures = measuresOf(data);
    const auto conditions = compareConditions(data, measures);
    ASSERT_FALSE(conditions.empty());
    EXPECT_EQ(conditions[0].of_first.n, 8u);
    EXPECT_DOUBLE_EQ(conditions[0].of_second.mean - conditions[0].of_first.mean, 5);
    const auto groups = compareGroups(data, measures);
    ASSERT_FALSE(groups.empty());
    EXPECT_DOUBLE_EQ(groups[0].of_first.mean, 5 * 1.5 + 2.5);
}

TEST(StudyReport, AlphaOfSusTurnsStatementsByTheirPlaceInTheForm) {
    const test::StudyRig rig;
    StudyFolder study(rig.path);
    for (size_t i = 0; i < 4; ++i) {
        const Participant person = study.enrol("expert", "");
        const std::vector<const Item*> items = study.form("sus").items();
        Answers answers = study.answers(person, person.sessions[0].uuid, "sus");
        for (size_t n = 0; n < items.size(); ++n)
            if (n == 2)
                answers.left_out.push_back(items[n]->id);  // by everyone
            else
                answers.values[items[n]->id] = double(n % 2 ? 5 - i : 1 + i);
        study.save(answers);
    }
    const StudyData data = readStudy(study);
    const std::vector<Alpha> alphas = alphasOf(data, measuresOf(data));
    ASSERT_EQ(alphas.size(), 1u);
    EXPECT_EQ(alphas[0].items, 9u);
    EXPECT_NEAR(alphas[0].alpha, 1, 1e-12) << "all of one mind";
}

TEST(StudyReport, SaysWhatItCanAndCannotBear) {
    const FilledRig rig;
    const StudyData data = readStudy(rig.study);
    const std::vector<Measure> measures = measuresOf(data);
    const std::string text =
        reportText(data, measures, compareGroups(data, measures), compareConditions(data, measures));
    for (const char* words :
         {"# A \\| small study",
          "16 tests at .050: if nothing differs at all, the chance of at least one false alarm is 56 %",
          "the smallest P counts only below .0031", "that stand after Holm's adjustment (Mann-Whitney): none",
          "not after it: 2g (expert, novice)", "| expert | – | 4 | 4 | 0 | 4 |", "Between conditions"})
        EXPECT_NE(text.find(words), std::string::npos) << words;
    EXPECT_EQ(text.find("nan"), std::string::npos);
}

TEST(StudyReport, TheChecklistHasWhatIsKnownAndNamesWhatIsNot) {
    const FilledRig rig;
    Participant person = rig.study.participant("P001");
    StudyFolder study(rig.path);
    RunRecord run{person.sessions[1].uuid, "tooth.textproto",         std::string(64, 'a'),
                  "bonemill 9.9 (abc)",    {{"mean_rate_hz", 998.5}}, "session.mcap"};
    study.save("P001", run);
    study.withdraw("P002", "tired");
    const StudyData data = readStudy(study);
    const std::string text = checklistText(data, "bonemill 9.9 (abc)");
    for (const char* words :
         {"tooth.textproto (SHA-256 aaaaaaaaaaaaaaaa", "998.5 to 998.5 Hz over 1 runs", "bonemill 9.9 (abc)",
          "fill in \"blinding\" of protocol.json", "seed 7", "mill: 2", "consent noted for 8 of 8"})
        EXPECT_NE(text.find(words), std::string::npos) << words;
    EXPECT_NE(flowTable(data).find("| expert | – | 4 | 4 | 1 | 4 |"), std::string::npos) << flowTable(data);
}

TEST(StudyReport, WritesWholeTablesKeyedBySessionAndPseudonym) {
    const FilledRig rig;
    const std::string out = rig.folder / "report";
    writeReport(rig.study, out, "bonemill");
    const std::string answers = test::readFile(out + "/answers.csv");
    EXPECT_EQ(std::count(answers.begin(), answers.end(), '\n'), 1 + 8 * (25 + 10 + 4 * 6));
    const Participant person = rig.study.participant("P001");
    EXPECT_NE(answers.find('"' + person.sessions[1].uuid + "\",\"P001\",\"expert\",1,"), std::string::npos);
    for (const char* name :
         {"scores.csv", "sessions.csv", "items.csv", "group_comparisons.csv", "condition_comparisons.csv",
          "alpha.csv", "report.md", "checklist.md", "analysis.R"}) {
        const std::string text = test::readFile(out + "/" + name);
        EXPECT_FALSE(text.empty()) << name;
        if (!std::string(name).ends_with(".csv")) continue;
        const auto columns = [&](size_t at) {  // no text in these tables has a comma
            return std::count(text.begin() + long(at), text.begin() + long(text.find('\n', at)), ',');
        };
        for (size_t at = 0; at < text.size(); at = text.find('\n', at) + 1)
            EXPECT_EQ(columns(at), columns(0)) << name;
    }
}

TEST(StudyReport, AnEmptyStudyHasAReport) {
    const test::StudyRig rig;
    writeReport(StudyFolder(rig.path), rig.folder / "report", "bonemill");
    EXPECT_NE(test::readFile(rig.folder / "report/report.md").find("no ratings yet"), std::string::npos);
}

TEST(StudyPlan, SaysTheThesisFigures) {
    const std::string text = planText({13, 8, 16, 0.05, 0.8, 0.04});
    for (const char* words :
         {"differences of 1.33 standard deviations or more", "false alarm is 56 %", "below .0031",
          "a difference of 0.99 standard deviations", "from 0.04 to 1.91", ".040 times 16 is .640"})
        EXPECT_NE(text.find(words), std::string::npos) << text;
    EXPECT_NE(planText({1, 1, 1, 0.05, 0.8, {}}).find("no difference at all"), std::string::npos);
}

TEST(StudyAgreement, ReadsATableOfRatersAndRefusesOthers) {
    const test::TemporaryFolder folder;
    const std::string file = folder / "ratings.csv";
    test::writeFile(file, "ann,ben\n1,1\n2,2\n3,3\n2,2\n");
    EXPECT_NE(agreementText(file).find("absolute agreement: 1.000 (4 things, 2 raters)"), std::string::npos);
    EXPECT_NE(agreementText(file).find("kappa of ann and ben: 1.000"), std::string::npos);
    for (const char* text : {"", "ann,ben\n", "ann\n1\n2\n", "ann,ben\n1,2\n1\n", "ann,ben\n1,x\n2,3\n",
                             "ann,ben\n1,nan\n2,3\n", "ann,b\x1b\n1,2\n2,3\n"}) {
        test::writeFile(file, text);
        EXPECT_THROW(agreementText(file), UserError) << text;
    }
}

}  // namespace
}  // namespace bonemill::study
