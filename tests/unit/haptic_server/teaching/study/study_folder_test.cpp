#include "haptic_server/teaching/study/study_folder.h"

#include <gtest/gtest.h>
#include <sys/stat.h>

#include <fstream>

#include "common/base/user_error.h"
#include "tests/support/process.h"
#include "tests/unit/haptic_server/teaching/study/study_rig.h"

namespace bonemill::study {
namespace {

using test::StudyRig;

template <class Action>
std::string refusalOf(const Action& action) {
    try {
        action();
    } catch (const UserError& error) {
        return error.what();
    }
    return "";
}

TEST(StudyFolder, EnrolsWithOrderSessionsAndPseudonyms) {
    const StudyRig rig;
    StudyFolder study(rig.path);
    const Participant first = study.enrol("expert", ""), second = study.enrol("expert", "");
    EXPECT_EQ(first.pseudonym, "P001");
    EXPECT_EQ(second.pseudonym, "P002");
    ASSERT_EQ(first.sessions.size(), 5u);  // the visit, and two conditions with two attempts each
    EXPECT_NE(first.sessions[1].condition, second.sessions[1].condition) << "counterbalanced";
    std::set<std::string> uuids;
    for (const Participant& person : {first, second})
        for (const Session& session : person.sessions) {
            EXPECT_TRUE(isUuid(session.uuid));
            EXPECT_TRUE(uuids.insert(session.uuid).second);
            EXPECT_EQ(study.participantOf(session.uuid).pseudonym, person.pseudonym);
        }
    EXPECT_NE(refusalOf([&] { study.enrol("surgeon", ""); }).find("no group"), std::string::npos);
    EXPECT_NE(refusalOf([&] { study.enrol("expert", "../../etc"); }).find("pseudonym"), std::string::npos);
    EXPECT_NE(refusalOf([&] { study.enrol("expert", "P001"); }).find("already"), std::string::npos);
    EXPECT_EQ(study.pseudonyms().size(), 2u);
}

TEST(StudyFolder, IsReadableForItsUserAlone) {
    const StudyRig rig;
    StudyFolder study(rig.path);
    study.enrol("novice", "");
    for (const auto& entry : std::filesystem::recursive_directory_iterator(rig.path + "/participants"))
        if (entry.is_regular_file()) {
            struct stat status {};
            ASSERT_EQ(stat(entry.path().c_str(), &status), 0);
            EXPECT_EQ(status.st_mode & 0777, 0600u) << entry.path();
        }
}

TEST(StudyFolder, RemovedMeansGoneAndNeitherPlaceNorNameIsGivenAgain) {
    const StudyRig rig;
    StudyFolder study(rig.path);
    const Participant first = study.enrol("expert", ""), second = study.enrol("expert", "");
    study.save(rig.filled(study, second, second.sessions[0], "thesis_5_4", [](auto&) { return 4; }));
    study.remove("P002");
    for (const auto& entry : std::filesystem::recursive_directory_iterator(rig.path)) {
        if (!entry.is_regular_file()) continue;
        const std::string text = test::readFile(entry.path().string());
        EXPECT_EQ(text.find("P002"), std::string::npos) << entry.path();
        EXPECT_EQ(text.find(second.sessions[0].uuid), std::string::npos) << entry.path();
    }
    const Participant third = study.enrol("expert", "");
    EXPECT_EQ(third.pseudonym, "P003");
    EXPECT_EQ(third.place, 2u);
    EXPECT_EQ(study.enrolled().removed, 1u);
    EXPECT_NE(refusalOf([&] { study.remove("P002"); }), "");
    EXPECT_NE(refusalOf([&] { study.remove(".."); }), "");
    EXPECT_NE(refusalOf([&] { study.remove(""); }), "");
    EXPECT_TRUE(std::filesystem::exists(rig.path + "/protocol.json"));
    EXPECT_EQ(study.participant("P001").sessions.size(), first.sessions.size());
}

TEST(StudyFolder, NobodyRemovesThroughALink) {
    const StudyRig rig;
    StudyFolder study(rig.path);
    study.enrol("expert", "");
    std::filesystem::create_directory(rig.folder / "precious");
    test::writeFile(rig.folder / "precious/file", "x");
    std::filesystem::create_symlink(rig.folder / "precious", rig.path + "/participants/P009");
    EXPECT_NE(refusalOf([&] { study.remove("P009"); }), "");
    EXPECT_TRUE(std::filesystem::exists(rig.folder / "precious/file"));
}

TEST(StudyFolder, TakesInWhatAPageSaved) {
    const StudyRig rig;
    StudyFolder study(rig.path);
    const Participant person = study.enrol("expert", ""), other = study.enrol("novice", "");
    Answers answers = rig.filled(study, person, person.sessions[1], "nasa_tlx_raw", [](auto&) { return 45; });
    const std::string file = rig.folder / "answers.json";
    const auto take = [&](const std::string& text, bool replace = false) {
        test::writeFile(file, text);
        return refusalOf([&] { study.take(file, replace); });
    };
    EXPECT_EQ(take(toJson(answers)), "");
    EXPECT_EQ(take(toJson(answers)), "") << "the same again changes nothing";
    EXPECT_EQ(study.answers(person, person.sessions[1].uuid, "nasa_tlx_raw").values, answers.values);
    answers.values["effort"] = 50.0;
    EXPECT_NE(take(toJson(answers)).find("--replace"), std::string::npos);
    EXPECT_EQ(take(toJson(answers), true), "");
    EXPECT_EQ(study.answers(person, person.sessions[1].uuid, "nasa_tlx_raw").values, answers.values);
}

TEST(StudyFolder, RefusesHostileAnswers) {
    const StudyRig rig;
    StudyFolder study(rig.path);
    const Participant person = study.enrol("expert", ""), other = study.enrol("novice", "");
    const Answers good =
        rig.filled(study, person, person.sessions[1], "nasa_tlx_raw", [](auto&) { return 45; });
    const std::string file = rig.folder / "answers.json";
    const auto take = [&](const std::string& text) {
        test::writeFile(file, text);
        return refusalOf([&] { study.take(file, true); });
    };
    using Change = std::function<void(Json&)>;
    const std::pair<Change, std::string> cases[] = {
        {[](Json& json) { json["answers"]["effort"] = 101; }, "must be a number from 0 to 100"},
        {[](Json& json) { json["answers"]["effort"] = 44; }, "steps of 5"},
        {[](Json& json) { json["answers"]["effort"] = "45"; }, "must be a number"},
        {[](Json& json) { json["answers"]["effort"] = nullptr; }, "number or a text"},
        {[](Json& json) { json["answers"]["effort"] = Json::array({45}); }, "number or a text"},
        {[](Json& json) { json["answers"]["charm"] = 45; }, "has not"},
        {[](Json& json) { json["left_out"] = {"effort"}; }, "no unanswered question"},
        {[](Json& json) { json["left_out"] = {"../x"}; }, "no name"},
        {[](Json& json) { json["form"] = "../../etc/passwd"; }, "letters, digits"},
        {[](Json& json) { json["form"] = "sus"; }, "form"},
        {[](Json& json) { json["form"] = "nothing"; }, "no form"},
        {[](Json& json) { json["form_sha256"] = std::string(64, '0'); }, "another text"},
        {[](Json& json) { json["session"] = "../participant"; }, "UUID"},
        {[](Json& json) { json["session"] = "00000000-0000-4000-8000-000000000000"; }, "no session"},
        {[&](Json& json) { json["session"] = other.sessions[1].uuid; }, "another participant"},
        {[&](Json& json) { json["session"] = person.sessions[0].uuid; }, "does not ask"},
        {[](Json& json) { json["pseudonym"] = "P002"; }, "another participant"},
        {[](Json& json) { json["study"] = "other"; }, "not of this one"},
        {[](Json& json) { json["more"] = 1; }, "does not know"},
        {[](Json& json) { json.erase("answers"); }, "is missing"},
    };
    for (const auto& [change, words] : cases) {
        Json json = Json::parse(toJson(good));
        change(json);
        const std::string said = take(json.dump());
        EXPECT_NE(said.find(words), std::string::npos) << words << ": " << said;
        EXPECT_EQ(said.find('\n'), std::string::npos) << "one line";
    }
    EXPECT_NE(take(std::string(2 << 20, 'a')).find("1 MiB"), std::string::npos);
    EXPECT_NE(take(""), "");
    EXPECT_NE(take(std::string(100'000, '[')).find("12 levels"), std::string::npos);
    EXPECT_TRUE(study.answers(person, person.sessions[1].uuid, "nasa_tlx_raw").values.empty())
        << "nothing got in";
    ASSERT_EQ(mkfifo((rig.folder / "pipe").c_str(), 0600), 0);
    EXPECT_NE(refusalOf([&] { study.take(rig.folder / "pipe", false); }).find("named pipe"),
              std::string::npos);
}

TEST(StudyFolder, AFormThatWasChangedIsNotTheOneThatWasAsked) {
    const StudyRig rig;
    StudyFolder study(rig.path);
    const Participant person = study.enrol("expert", "");
    study.save(rig.filled(study, person, person.sessions[0], "sus", [](auto&) { return 4; }));
    std::string text = test::readFile(rig.path + "/forms/sus.json");
    text.replace(text.find("frequently"), 10, "every day.");
    test::writeFile(rig.path + "/forms/sus.json", text);
    const StudyFolder again(rig.path);
    EXPECT_NE(refusalOf([&] { again.answers(person, person.sessions[0].uuid, "sus"); }).find("another text"),
              std::string::npos);
}

TEST(StudyFolder, SaysWhatIsWrongWithAProtocol) {
    const StudyRig rig;
    const auto refusal = [&](const std::string& from, const std::string& to) {
        std::string text = test::kSmallProtocol;
        text.replace(text.find(from), from.size(), to);
        test::writeFile(rig.path + "/protocol.json", text);
        return refusalOf([&] { StudyFolder study(rig.path); });
    };
    EXPECT_NE(refusal("\"seed\": 7", "\"seed\": -1").find("\"seed\" must be a number from 0"),
              std::string::npos);
    EXPECT_NE(refusal("\"seed\"", "\"sead\"").find("does not know a field \"sead\""), std::string::npos);
    EXPECT_NE(refusal("novice", "expert").find("twice"), std::string::npos);
    EXPECT_NE(refusal("\"sus\"]", "\"mine\"]").find("mine.json: cannot be read"), std::string::npos);
    EXPECT_NE(
        refusal("\"forms_after\"", "\"condition_order\": \"any\", \"forms_after\"").find("fixed, balanced"),
        std::string::npos);
    EXPECT_NE(refusalOf([&] { StudyFolder study(rig.folder / "none"); }).find("study init"),
              std::string::npos);
    EXPECT_NE(refusalOf([&] { makeStudy(rig.path); }).find("already"), std::string::npos);
    EXPECT_EQ(refusalOf([&] { parseProtocol(exampleProtocol(), "example"); }), "");
}

}  // namespace
}  // namespace bonemill::study
