// A whole study as its users play it through: the program in a shell, with answers by pipe, in a terminal and
// from a page in a browser.
#include <gtest/gtest.h>
#include <pty.h>
#include <signal.h>
#include <sys/wait.h>
#include <unistd.h>

#include <algorithm>
#include <sstream>

#include "tests/support/places.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

constexpr char kProtocol[] = R"({"study": "whole", "title": "A whole study", "seed": 1,
  "groups": [{"id": "expert"}, {"id": "novice"}], "conditions": [{"id": "with"}, {"id": "without"}],
  "tasks": [{"id": "mill", "scene": "SCENE"}], "forms_after_each": ["nasa_tlx_raw"], "forms_after": ["thesis_5_4", "sus"]})";

class WholeStudy : public testing::Test {
  protected:
    WholeStudy() {
        EXPECT_EQ(study("init").exit_code, 0);
        std::string protocol = kProtocol;
        protocol.replace(protocol.find("SCENE"), 5, test::sourceDir() + "/deploy/scenes/minimal.textproto");
        test::writeFile(path + "/protocol.json", protocol);
    }

    test::Finished study(const std::string& word, const std::vector<std::string>& more = {}) {
        std::vector<std::string> arguments = {"study", word, path};
        arguments.insert(arguments.end(), more.begin(), more.end());
        return test::run(arguments);
    }

    std::string enrol(const std::string& group) {
        const test::Finished finished = study("enrol", {"--group", group, "--consent"});
        EXPECT_EQ(finished.exit_code, 0) << finished.err;
        return finished.out.substr(0, finished.out.find('\n'));
    }

    // Their UUIDs, the visit first.
    std::vector<std::string> sessionsOf(const std::string& pseudonym) {
        std::vector<std::string> sessions;
        std::istringstream lines(study("next", {pseudonym}).out);
        for (std::string line; std::getline(lines, line);)
            if (line.size() > 37 && line[8] == '-' && line[13] == '-') sessions.push_back(line.substr(0, 36));
        return sessions;
    }

    test::Finished fill(const std::string& session, const std::string& form, const std::string& lines) {
        test::writeFile(folder / "lines", lines);
        return test::run({"/bin/bash", "-c",
                          "\"" + test::binDir() + "/study\" fill '" + path + "' " + session + " " + form +
                              " <'" + (folder / "lines") + "'"});
    }

    test::TemporaryFolder folder;
    const std::string path = folder / "study";
};

std::string repeated(const std::string& line, size_t times) {
    std::string text;
    for (size_t i = 0; i < times; ++i) text += line + "\n";
    return text;
}

TEST_F(WholeStudy, ThreePeopleByPipe) {
    const std::string people[] = {enrol("expert"), enrol("expert"), enrol("novice")};
    for (size_t i = 0; i < 3; ++i) {
        const std::vector<std::string> sessions = sessionsOf(people[i]);
        ASSERT_EQ(sessions.size(), 3u);
        for (size_t k = 1; k < 3; ++k) {
            EXPECT_EQ(
                fill(sessions[k], "nasa_tlx_raw", repeated(std::to_string(20 + 5 * i + 5 * k), 6)).exit_code,
                0);
            EXPECT_EQ(study("attach", {sessions[k]}).exit_code, 0);
        }
        const std::string rating = std::to_string(3 + i % 2);
        const std::string answers = "1970\n1\n10\n500\n-\n-\n2\n" + repeated(rating, 16) + "1\n2\n";
        // Stopped in the middle, and gone on with.
        EXPECT_EQ(fill(sessions[0], "thesis_5_4", answers.substr(0, 20)).exit_code, 1);
        EXPECT_EQ(fill(sessions[0], "thesis_5_4", answers.substr(20)).exit_code, 0);
        EXPECT_EQ(fill(sessions[0], "sus", repeated("4", 10)).exit_code, 0);
    }
    const test::Finished refused = fill(sessionsOf(people[0])[0], "nasa_tlx_raw", "");
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_NE(refused.err.find("does not ask for"), std::string::npos) << refused.err;
    const std::string out = folder / "report";
    EXPECT_EQ(study("report", {"--out", out}).exit_code, 0);
    const std::string report = test::readFile(out + "/report.md"),
                      answers = test::readFile(out + "/answers.csv");
    EXPECT_NE(report.find("| expert | – | 2 | 2 | 0 | 2 |"), std::string::npos) << report.substr(0, 600);
    EXPECT_NE(report.find("16 tests at .050"), std::string::npos);
    EXPECT_EQ(std::count(answers.begin(), answers.end(), '\n'), 1 + 3 * (25 + 10 + 2 * 6));
    EXPECT_NE(test::readFile(out + "/checklist.md").find("minimal.textproto (SHA-256 "), std::string::npos);

    EXPECT_EQ(study("remove", {people[2]}).exit_code, 0);
    EXPECT_EQ(study("report", {"--out", out}).exit_code, 0);
    EXPECT_EQ(test::readFile(out + "/answers.csv").find(people[2]), std::string::npos);
    EXPECT_EQ(study("next", {people[2]}).exit_code, 2);
    EXPECT_EQ(test::run({"study", "enrol", path, "--group", "expert"}).exit_code, 2) << "without consent";
}

// Answers a form in a terminal of its own, which is closed when `lines` are typed: the program gets SIGHUP.
void typeInTerminal(const std::vector<std::string>& arguments, const std::string& lines,
                    const std::string& until) {
    int terminal = -1;
    const pid_t child = forkpty(&terminal, nullptr, nullptr, nullptr);
    ASSERT_GE(child, 0);
    if (child == 0) {
        const std::string program = test::binDir() + "/study";
        std::vector<char*> words = {const_cast<char*>(program.c_str())};
        for (const std::string& argument : arguments) words.push_back(const_cast<char*>(argument.c_str()));
        words.push_back(nullptr);
        execv(program.c_str(), words.data());
        _exit(127);
    }
    EXPECT_EQ(write(terminal, lines.data(), lines.size()), ssize_t(lines.size()));
    std::string shown;
    char part[512];
    for (ssize_t count = 1; count > 0 && shown.find(until) == std::string::npos;) {
        count = read(terminal, part, sizeof part);
        if (count > 0) shown.append(part, size_t(count));
    }
    close(terminal);
    int status = 0;
    EXPECT_EQ(waitpid(child, &status, 0), child);
    EXPECT_NE(shown.find(until), std::string::npos) << shown;
}

TEST_F(WholeStudy, ATerminalThatClosesLosesNoAnswer) {
    const std::string visit = sessionsOf(enrol("expert")).at(0);
    typeInTerminal({"fill", path, visit, "sus"}, "5\n1\n4\n", "[4 of 10]");
    const test::Finished rest = fill(visit, "sus", repeated("3", 7));
    EXPECT_EQ(rest.exit_code, 0) << rest.out;
    EXPECT_EQ(rest.out.find("[3 of 10]"), std::string::npos) << "answered before";
    const test::Finished next = study("next", {"P001"});
    EXPECT_NE(next.out.find("sus (after all): 10 of 10"), std::string::npos) << next.out;
}

// The saved file, as the page makes it when somebody answers everything with the second choice and presses
// Save.
constexpr char kPlayer[] = R"(<script>
let saved;
const Real = Blob;
window.Blob = function(parts, options) { saved = parts.join(""); return new Real(parts, options); };
for (const item of items) {
  const input = item.box.querySelectorAll("input")[item.hasOptions ? 1 : 0];
  if (item.hasOptions) input.click(); else if (item.isNumber) input.value = input.min;
}
root.requestSubmit(); root.requestSubmit();
document.body.innerHTML = "<pre>BEGIN" + encodeURIComponent(saved) + "END</pre>";
</script></body>)";

std::string decoded(const std::string& text) {
    std::string bytes;
    for (size_t i = 0; i < text.size(); ++i) {
        if (text[i] == '%') {
            bytes += char(std::stoi(text.substr(i + 1, 2), nullptr, 16));
            i += 2;
        } else {
            bytes += text[i];
        }
    }
    return bytes;
}

TEST_F(WholeStudy, AnswersOfAPageInABrowserAreTakenIn) {
    if (test::run({"/bin/bash", "-c", "type -P chromium"}).exit_code != 0)
        GTEST_SKIP() << "chromium is not installed";
    const std::string visit = sessionsOf(enrol("novice")).at(0), page = folder / "page.html";
    ASSERT_EQ(study("page", {visit, "thesis_5_4", "--out", page}).exit_code, 0);
    std::string html = test::readFile(page);
    html.replace(html.rfind("</body>"), 7, kPlayer);
    test::writeFile(page, html);
    const test::Finished shown =
        test::run({"/bin/bash", "-c",
                   "chromium --headless --no-sandbox --disable-gpu --user-data-dir='" + (folder / "browser") +
                       "' --virtual-time-budget=5000 --dump-dom 'file://" + page + "'"});
    const size_t begin = shown.out.find("<pre>BEGIN"), end = shown.out.find("END</pre>");
    ASSERT_NE(begin, std::string::npos) << shown.out.substr(0, 2000) << shown.err;
    test::writeFile(folder / "saved.json", decoded(shown.out.substr(begin + 10, end - begin - 10)));
    const test::Finished imported = study("import", {folder / "saved.json"});
    EXPECT_EQ(imported.exit_code, 0) << imported.err;
    EXPECT_NE(imported.out.find("P001, thesis_5_4, 24 answers"), std::string::npos)
        << imported.out;  // all but the one in words
    EXPECT_NE(study("next", {"P001"}).out.find("thesis_5_4 (after all): 25 of 25"), std::string::npos);
}

TEST(StudyFigures, DrawsATraceAndRefusesOtherFiles) {
    const test::TemporaryFolder folder;
    std::string trace = "t_s,spo_qw,spo_qx,spo_qy,spo_qz,fx_n,fy_n,fz_n,tx_nm,ty_nm,tz_nm,contacts,tick_us\n";
    for (int tick = 0; tick < 3000; ++tick)
        trace +=
            std::to_string(tick * 1e-3) + ",1,0,0,0," + std::to_string(tick % 7) + ",0,1,0,0,0.001,3,20\n";
    test::writeFile(folder / "trace.csv", trace);
    const std::string program = test::sourceDir() + "/deploy/study";
    const test::Finished drawn = test::run(
        {program, "figures", folder / "trace.csv", "--out", folder / "out", "--seconds", "2", "--svg"});
    EXPECT_EQ(drawn.exit_code, 0) << drawn.err;
    EXPECT_NE(test::readFile(folder / "out/traces.svg").find("2 s from 0 s"), std::string::npos);
    EXPECT_NE(test::readFile(folder / "out/axis.svg").find("</svg>"), std::string::npos);
    test::writeFile(folder / "other.csv", "a,b\n1,2\n3,4\n");
    const test::Finished refused =
        test::run({program, "figures", folder / "other.csv", "--out", folder / "out"});
    EXPECT_EQ(refused.exit_code, 2);
    EXPECT_NE(refused.err.find("is no trace"), std::string::npos) << refused.err;
}

}  // namespace
}  // namespace bonemill
