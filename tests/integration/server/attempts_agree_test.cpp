// What the window, the class table, the results, the report for people and the recording say of an attempt is
// the same, figure by figure. Server and daemon are processes, the test itself is a viewer.
//
// BONEMILL_ATTEMPTS says how many there are, 3 without.
#include <gtest/gtest.h>
#include <signal.h>

#include <cmath>
#include <cstdlib>
#include <fstream>
#include <map>
#include <nlohmann/json.hpp>
#include <random>
#include <regex>
#include <set>
#include <sstream>

#include "common/attempts_csv/attempts_csv.h"
#include "tests/integration/dds/client_probe.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

using test::Process;
using Figures = std::map<std::string, double>;

// The hand rubs over a slab with its top at z = 2 mm and treads the pedal again and again; a hole is asked
// for.
std::string rubbingScene() {
    std::string text =
        "name: 'slab' title: 'Hole, not deep' volume { path: 'slab.nrrd' window_low: 0 window_high: 65535 "
        "iso_value: 32768 }\ntool { speed_rpm: 20000 }\neffects { energy_removal {} thermal {} }\n"
        "device { p_WD_mm { z: 3 } q_WD { w: 0.70710678 x: 0.70710678 } }\nsimulated_operator {\n"
        "tremor_mm: 0.05 hand_stiffness_n_per_m: 2000\n";
    for (int n = 0; n < 400; ++n)
        text += "waypoint { time_s: " + std::to_string(0.2 * n) +
                " p_WT_mm { x: " + std::to_string(n % 3 - 1) + " z: " + (n == 0 ? "3.4" : "2.2") +
                " } q_WT { w: 0.70710678 x: 0.70710678 } remove: " + (n % 3 == 0 ? "false" : "true") + " }\n";
    return text +
           "}\nassessment {\n"
           "zone { name: 'floor' role: CONTAINER_BOTTOM shape { box { center_mm { z: 0.5 } size_mm { x: 6 y: "
           "6 "
           "z: 1 } } } }\n"
           "zone { name: 'hole' role: TARGET shape { box { center_mm { z: 1.5 } size_mm { x: 3 y: 2 z: 1 } } "
           "} "
           "}\n"
           "gate { figure: 'target.removed' at_least: 6 label: 'The hole is begun' }\n"
           "sub_score { figure: 'target.removed' worst: 0 best: 20 weight: 2 }\n"
           "sub_score { figure: 'force.p95' worst: 6 best: 1 weight: 1 }\n"
           "approach { z: -1 } }\n";
}

std::string textIn(const std::filesystem::path& path) {
    std::ifstream file(path);
    std::stringstream text;
    text << file.rdbuf();
    return text.str();
}

Figures figuresIn(const nlohmann::json& result) {
    Figures figures;
    for (const auto& figure : result.at("figures"))
        if (figure.at("value").is_number())
            figures[figure.at("id").get<std::string>()] = figure.at("value").get<double>();
    return figures;
}

// As people read them, by what stands beside each.
Figures figuresShown(const std::string& html) {
    static const std::regex kRow(
        "<td class='n'>([^< ]*)[^<]*</td>(<td>[^<]*</td>)?<td class='id' title='([^@]+)@");
    Figures figures;
    for (std::sregex_iterator row(html.begin(), html.end(), kRow), end; row != end; ++row) {
        const std::string number = std::regex_replace((*row)[1].str(), std::regex("−"), "-");
        figures[(*row)[3]] = std::strtod(number.c_str(), nullptr);
    }
    return figures;
}

class AttemptsAgree : public testing::Test {
  protected:
    AttemptsAgree() {
        EXPECT_EQ(
            test::run({"make_phantom", "body", "--kind", "slab", "--out", folder_ / "slab.nrrd"}).exit_code,
            0);
        test::writeFile(folder_ / "slab.textproto", rubbingScene());
    }
    std::vector<std::string> server() const {
        return {"haptic_server",
                "--scene",
                folder_ / "slab.textproto",
                "--session",
                std::to_string(testSession()),
                "--domain",
                std::to_string(testDomain()),
                "--class-table",
                folder_ / "class.csv",
                "--recording",
                folder_ / "recordings"};
    }
    std::vector<std::string> daemon() const {
        return {"device_daemon", "--device",
                "simulated",     "--hold",
                "--scene",       folder_ / "slab.textproto",
                "--session",     std::to_string(testSession())};
    }
    void order(const std::function<void(topics::Command&)>& fill) {
        topics::Command command;
        fill(command);
        EXPECT_EQ(probe_.order(command), "done");
    }
    const topics::Lesson& lesson() const { return *probe_.subscriber.lesson(); }
    double sessionS() const {
        return probe_.subscriber.status() ? probe_.subscriber.status()->session_s() : 0;
    }
    void attempt(int number, double seconds) {
        order([&](topics::Command& c) { c.set_start_attempt("trainee " + std::to_string(number)); });
        const double until = sessionS() + seconds;
        EXPECT_TRUE(probe_.pollUntil([&] { return sessionS() > until; }));
        order([](topics::Command& c) { c.set_stop_attempt(true); });
        EXPECT_TRUE(probe_.pollUntil([&] {
            return lesson().attempts_size() == number && lesson().attempts(number - 1).has_verdict();
        }));
    }
    std::string journal() const {
        for (const auto& entry : std::filesystem::directory_iterator(folder_ / "recordings"))
            if (entry.path().extension() == ".mcap") return entry.path();
        return {};
    }

    // The window's own table, line by line, is the server's but for the last column, which only that knows.
    void expectTablesAgree() const {
        std::istringstream table(textIn(folder_ / "class.csv")), window(attemptsCsv(lesson()));
        std::string line, shown;
        for (int n = 0; std::getline(window, shown); ++n) {
            ASSERT_TRUE(std::getline(table, line));
            EXPECT_TRUE(n == 0 ? line == shown : line.starts_with(shown)) << line << "\n" << shown;
        }
        EXPECT_FALSE(std::getline(table, line));
    }
    static void expectAsTold(const topics::Attempt& told, const nlohmann::json& result) {
        EXPECT_EQ(result.at("pseudonym"), told.trainee());
        EXPECT_EQ(result.at("attempt"), told.number());
        EXPECT_EQ(result.at("passed"), told.verdict().passed());
        EXPECT_DOUBLE_EQ(100 * result.at("total").at("score").get<double>(), told.verdict().score_percent());
        EXPECT_DOUBLE_EQ(result.at("duration_s"), told.time_s());
        const Figures figures = figuresIn(result);
        EXPECT_NEAR(figures.at("force.max"), told.max_force_n(), 1e-6);
        EXPECT_NEAR(figures.at("removal.volume"), told.removed_mm3(), 1e-6 + 1e-9 * told.removed_mm3());
    }
    // Three digits and more are shown of each.
    static void expectShown(const Figures& figures, const std::string& html) {
        const Figures shown = figuresShown(html);
        EXPECT_GT(shown.size(), 40u);
        for (const auto& [id, value] : shown) {
            ASSERT_TRUE(figures.contains(id)) << id;
            EXPECT_NEAR(value, figures.at(id), 6e-3 * std::abs(figures.at(id)) + 1e-6) << id;
        }
    }
    static void expectSame(const Figures& live, const Figures& again) {
        EXPECT_EQ(live.size(), again.size());
        for (const auto& [id, value] : live) {
            ASSERT_TRUE(again.contains(id)) << id;
            EXPECT_NEAR(again.at(id), value, 1e-9 * std::abs(value) + 1e-12) << id;
        }
    }

    test::TemporaryFolder folder_;
    ClientProbe probe_;
};

TEST_F(AttemptsAgree, InWindowTableResultsReportAndRecording) {
    const char* const wanted = std::getenv("BONEMILL_ATTEMPTS");
    const int count = wanted ? std::atoi(wanted) : 3;
    std::mt19937 random(5);
    // The server begins one in two seconds.
    std::uniform_real_distribution<double> seconds(2.1, 3.2);
    topics::Lesson told;
    {
        Process live(server()), hand(daemon());
        ASSERT_TRUE(probe_.pollUntil([&] { return sessionS() > 0.2 && probe_.subscriber.lesson(); }))
            << live.errSoFar();
        for (int n = 1; n <= count && !HasFailure(); ++n) attempt(n, seconds(random));
        told = lesson();
        expectTablesAgree();
        live.signal(SIGTERM);
        EXPECT_EQ(live.wait().exit_code, 0);
    }
    ASSERT_EQ(told.attempts_size(), count);
    const test::Finished again =
        test::run({"bonemill_lab", "session", "assess", journal(), "--out", folder_ / "again"});
    ASSERT_EQ(again.exit_code, 0) << again.err;
    std::map<int, nlohmann::json> from_journal;
    for (const auto& entry : std::filesystem::recursive_directory_iterator(folder_ / "again"))
        if (entry.path().extension() == ".json")
            if (const auto json = nlohmann::json::parse(textIn(entry.path()));
                json.contains("bonemill_result"))
                from_journal[json.at("attempt")] = json;
    EXPECT_EQ(from_journal.size(), size_t(count));
    std::set<double> scores;
    for (const topics::Attempt& attempt : told.attempts()) {
        SCOPED_TRACE(attempt.number());
        const std::string files = folder_ / ("results/" + attempt.verdict().results());
        const auto result = nlohmann::json::parse(textIn(files + ".json"));
        expectAsTold(attempt, result);
        expectShown(figuresIn(result), textIn(files + ".html"));
        expectSame(figuresIn(result), figuresIn(from_journal.at(int(attempt.number()))));
        scores.insert(attempt.verdict().score_percent());
    }
    EXPECT_GE(scores.size(), 2u) << "they went differently";
}

}  // namespace
}  // namespace bonemill
