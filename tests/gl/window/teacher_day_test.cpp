// A teacher's day by the window alone, from an empty home folder: five trainees one after the other, their
// reports, the class' page, a guest, and the replay of the worst moment, with counted clicks.
#include <gtest/gtest.h>
#include <signal.h>
#include <unistd.h>

#include <chrono>
#include <cmath>
#include <filesystem>
#include <nlohmann/json.hpp>
#include <regex>
#include <thread>

#include "render_client/panel/panel/qr_code.h"
#include "tests/gl/golden.h"
#include "tests/gl/window/lesson_twin.h"
#include "tests/gl/window/virtual_display.h"
#include "tests/gl/window/windowed_viewer.h"
#include "tests/integration/deploy/bonemill_rig.h"

namespace bonemill {
namespace {

namespace fs = std::filesystem;
using test::Finished;
using test::LessonTwin;
using test::Process;

constexpr int kScreenWidth = 1280, kScreenHeight = 800;  // as the window is without options
constexpr int kMostClicks = 25, kClicks = 21;
constexpr int kTurnsToEnd = 80;  // of the wheel, through all of the panel
constexpr PixelPoint kPanelsTitle{kScreenWidth - 40,
                                  24};  // where the wheel turns the panel and no table in it
const std::vector<std::string> kTrainees{"Ann", "Ben", "Cleo", "Dev", "Eva"};

std::vector<fs::path> filesIn(const fs::path& folder, const std::string& ending) {
    std::vector<fs::path> files;
    if (!fs::exists(folder)) return files;
    for (const auto& entry : fs::recursive_directory_iterator(folder))
        if (entry.path().extension() == ending) files.push_back(entry.path());
    std::ranges::sort(files);
    return files;
}

std::vector<std::string> linesIn(const fs::path& file) {
    std::istringstream stream(fs::exists(file) ? test::readFile(file) : "");
    std::vector<std::string> lines;
    for (std::string line; std::getline(stream, line);) lines.push_back(line);
    return lines;
}

// Tells whether a camera would find the code in the picture: its squares, dark on light, wherever they are.
bool isSeen(const QrCode& code, const Picture& picture) {
    const auto isThere = [&](int left, int top, int square) {
        for (int n = 0; n < code.width * code.width; ++n) {
            const int x = left + square * (n % code.width) + square / 2,
                      y = top + square * (n / code.width) + square / 2;
            if ((picture.at(x, y)[1] < 128) != code.is_dark[size_t(n)]) return false;
        }
        return true;
    };
    for (int square = 3; square < 12; ++square)
        for (int top = 0; top + square * code.width < picture.height(); ++top)
            for (int left = 0; left + square * code.width < picture.width(); ++left)
                if (isThere(left, top, square)) return true;
    return false;
}

class TeacherDay : public testing::Test {
  protected:
    void SetUp() override {
        test::useSoftwareRenderer();
        display_.emplace(kScreenWidth, kScreenHeight);
        rig_.useRealPrograms();
        for (const char* program : {"make_phantom", "ares_emulator"})
            fs::create_symlink(test::binDir() + "/" + program, rig_.programFile(program));
        for (const char* folder : {"home", "desktop"}) fs::create_directory(rig_.folder() / folder);
        // A desktop that notes which files it was asked to open.
        rig_.putProgram("xdg-open", "#!/bin/bash\necho \"$1\" >>\"" + opened() + "\"\n");
    }
    void TearDown() override {
        if (!session_) return;
        test::run(words({"stop", "all"}));
        if (HasFailure()) ADD_FAILURE() << session_->outSoFar() << session_->errSoFar();
    }

    // What bonemill is told, by somebody whose home folder is empty and who sits at this display.
    std::vector<std::string> words(const std::vector<std::string>& more) const {
        std::vector<std::string> all{"/usr/bin/env", "--chdir=" + rig_.folder() / "desktop"};
        for (const char* name : {"XDG_STATE_HOME", "XDG_DATA_HOME", "XDG_CONFIG_HOME"})
            all.push_back(std::string("--unset=") + name);
        all.push_back("HOME=" + home());
        all.push_back("XDG_RUNTIME_DIR=" + rig_.folder() / "run");
        all.push_back("PATH=" + rig_.folder() / "bin" + ":" + getenv("PATH"));
        all.push_back(rig_.programFile("bonemill"));
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    std::string home() const { return rig_.folder() / "home"; }
    std::string opened() const { return rig_.folder() / "opened"; }
    fs::path classFolder() const { return classFolders().at(0); }
    std::vector<fs::path> classFolders() const {
        std::vector<fs::path> folders;
        const fs::path classes = home() + "/.local/share/bonemill/classes";
        if (fs::exists(classes))
            for (const auto& entry : fs::directory_iterator(classes)) folders.push_back(entry.path());
        return folders;
    }

    void await(const std::string& what, const std::function<bool()>& holds) {
        const bool has_come = test::waitFor([&] {
            if (!session_->isRunning()) throw std::runtime_error("the session has ended before: " + what);
            if (twin_) twin_->look();
            return holds();
        });
        if (!has_come) throw std::runtime_error("waited in vain for: " + what);
    }
    void start() {
        session_.emplace(words({"start", "--device", "simulated", "--session", std::to_string(testSession()),
                                "--domain", std::to_string(testDomain())}));
        twin_.emplace(testDomain(), testSession(), kScreenWidth, kScreenHeight);
        await("the lesson", [&] { return twin_->lesson() && twin_->lesson()->scenes_size() > 3; });
        await("the class' folder", [&] { return !classFolders().empty(); });
        twin_->setClassFolder(classFolder());
        look();
    }

    // Those of F12, whose names sort by time.
    std::vector<fs::path> pictures() const {
        std::vector<fs::path> pictures = filesIn(rig_.folder() / "desktop", ".png");
        for (const fs::path& folder : classFolders())
            for (const fs::path& picture : filesIn(folder / "pictures", ".png")) pictures.push_back(picture);
        std::ranges::sort(pictures, {}, &fs::path::filename);
        return pictures;
    }
    size_t countPictures() const { return pictures().size(); }
    // Returns whether one press of the key, and no other, has made a picture. A slow window takes several
    // presses as one, or later, and those of the time before there is a window are nobody's: then all is
    // waited for that is still under way.
    bool pressForPicture() {
        constexpr std::chrono::seconds kPatience{8}, kQuiet{3};
        const size_t before = countPictures();
        display_->type({"key", "F12"});
        if (test::waitFor([&] { return countPictures() > before; }, kPatience)) return true;
        size_t last = before;
        do {
            last = countPictures();
            std::this_thread::sleep_for(kQuiet);
        } while (countPictures() != last);
        return false;
    }
    // Returns what the window shows after all that was done and has come before: the first picture may have
    // been under way.
    Picture look() {
        await("two pictures", [&] { return pressForPicture() && pressForPicture(); });
        return test::readPng(pictures().back());
    }
    void click(const std::string& label) {
        std::optional<PixelPoint> place;
        await("the control '" + label + "'", [&] { return (place = twin_->find(label)).has_value(); });
        ++clicks_;
        moveTo(*place);
        display_->type({"click", "1"});
    }
    void moveTo(const PixelPoint& place) {
        display_->type({"mousemove", std::to_string(int(place.x)), std::to_string(int(place.y))});
    }
    void typeInField(const std::string& label, const std::string& text) {
        click(label);
        display_->type({"key", "ctrl+a"});
        display_->type({"type", text});
    }
    void scrollToEnd() {
        moveTo(kPanelsTitle);
        display_->type({"click", "--repeat", std::to_string(kTurnsToEnd), "--delay", "2", "5"});
        twin_->scroll(kPanelsTitle, kTurnsToEnd);
        ++turns_to_end_;
    }

    // From the trainee's name to the open report.
    void teach(const std::string& trainee, int number) {
        look();
        typeInField("##trainee", trainee);
        display_->type({"key", "Return"});
        await(trainee + "'s attempt",
              [&] { return twin_->lesson()->is_running() && twin_->lesson()->trainee() == trainee; });
        await("whole bone", [&] { return twin_->status().removed_mm3() < 0.01; });
        await("milled bone", [&] { return twin_->status().removed_mm3() > 0.5; });
        look();
        click(withKey("Stop", Action::kStopAttempt));
        await(trainee + "'s report", [&] {
            return twin_->lesson()->attempts_size() == number &&
                   fs::exists(stemOf(twin_->lesson()->attempts(number - 1)) + ".html");
        });
        look();
        click("Report");
        await("the report to be opened", [&] { return int(linesIn(opened()).size()) == number; });
        EXPECT_EQ(linesIn(opened()).back(), stemOf(twin_->lesson()->attempts(number - 1)) + ".html");
    }
    std::string stemOf(const topics::Attempt& attempt) const {
        return classFolder() / "results" / attempt.verdict().results();
    }
    void expectResultsOfAll() {
        const std::vector<std::string> table = linesIn(classFolder() / "class.csv");
        EXPECT_EQ(table.size(), 1 + kTrainees.size());
        const std::vector<fs::path> reports = filesIn(classFolder() / "results", ".html");
        ASSERT_EQ(reports.size(), kTrainees.size());
        const std::string page = test::readFile(classFolder() / "class.html");
        for (size_t n = 0; n < kTrainees.size(); ++n) {
            EXPECT_NE(table.at(1 + n).find(kTrainees[n]), std::string::npos) << table[1 + n];
            EXPECT_NE(test::readFile(reports[n]).find(kTrainees[n]), std::string::npos) << reports[n];
            EXPECT_NE(page.find(kTrainees[n]), std::string::npos) << page;
        }
    }

    // Returns the link that the window shows, from the clipboard.
    std::string invite(const std::string& guest) {
        scrollToEnd();
        look();
        typeInField("##guest", guest);
        click("Invite");
        twin_->setInvitation({.name = guest, .link = "https://pc/#0", .problem = {}});
        await("an invitation", [&] { return fs::exists(guests()) && !isInviting(); });
        look();
        click("Copy the link");
        look();
        const std::string link = display_->clipboard();
        twin_->setInvitation({.name = guest, .link = link, .problem = {}});
        return link;
    }
    std::string guests() const { return home() + "/.config/bonemill/guests.textproto"; }
    // The window has somebody write the invitation, and the gateway answers when that one is gone.
    bool isInviting() const {
        const std::string words = rig_.programFile("bonemill") + '\0' + "invite";
        for (const auto& process : fs::directory_iterator("/proc"))
            if (test::readFile(process.path() / "cmdline").find(words) != std::string::npos) return true;
        return false;
    }
    // A person who has the link comes in by it: the gateway listens, and knows its token.
    void expectToLead(const std::string& link) {
        std::smatch parts;
        ASSERT_TRUE(std::regex_match(link, parts, std::regex("https://\\S+:([0-9]+)/#([0-9a-f]{32})")))
            << link;
        const std::string port = parts[1], token = parts[2];
        EXPECT_EQ(test::run({"/bin/bash", "-c", ": <>/dev/tcp/127.0.0.1/" + port}).exit_code, 0) << link;
        const Finished digest = test::run({"/bin/bash", "-c", "printf %s " + token + " | sha256sum"});
        EXPECT_NE(test::readFile(guests()).find(digest.out.substr(0, 64)), std::string::npos) << digest.out;
    }

    // Returns the number of the session that shows the recording.
    uint32_t awaitReplay() {
        const fs::path state = rig_.folder() / ("run/bonemill-" + std::to_string(getuid()));
        uint32_t number = 0;
        await("a session that is a replay", [&] {
            for (const fs::path& file : filesIn(state, ".session"))
                if (test::readFile(file).find("scene=replay\n") != std::string::npos)
                    number = uint32_t(std::stoul(file.stem()));
            return number != 0;
        });
        return number;
    }
    void expectToPlayFromWorstMoment(const topics::Attempt& attempt) {
        constexpr double kLead = 3, kSlack = 0.2;  // s, before the moment
        const nlohmann::json result = nlohmann::json::parse(test::readFile(stemOf(attempt) + ".json"));
        ASSERT_FALSE(result["moments"].empty());
        const auto worst = std::ranges::max(
            result["moments"], {}, [](const nlohmann::json& moment) { return double(moment["severity"]); });
        SceneSubscriber observer({.domain = testDomain(), .session = awaitReplay(), .name = "observer"});
        const auto isShown = [&] {
            observer.poll();
            return observer.status() && observer.status()->replay().is_playing() &&
                   !observer.status()->replay().is_seeking() && observer.isComplete() &&
                   !observer.viewers().empty();
        };
        await("a window on a replay that plays", isShown);
        EXPECT_GT(observer.status()->session_s(), double(worst["t_s"]) - kLead - kSlack);
        const double before_s = observer.status()->session_s();
        await("its clock to go on", [&] {
            observer.poll();
            return observer.status()->session_s() > before_s;
        });
    }

    std::optional<test::VirtualDisplay> display_;
    test::BonemillRig rig_;
    std::optional<Process> session_;
    std::optional<LessonTwin> twin_;
    int clicks_ = 0, turns_to_end_ = 0;
};

TEST_F(TeacherDay, TakesTheWindowAloneAndFewClicks) {
    start();
    click(withKey("Lesson", Action::kPanel));
    twin_->openPanel();
    for (size_t n = 0; n < kTrainees.size(); ++n) teach(kTrainees[n], int(n) + 1);

    click("Class page");
    await("the class' page to be opened", [&] { return linesIn(opened()).size() > kTrainees.size(); });
    EXPECT_EQ(linesIn(opened()).back(), classFolder() / "class.html");
    expectResultsOfAll();

    const std::string link = invite("Guest");
    expectToLead(link);
    scrollToEnd();
    EXPECT_TRUE(isSeen(qrCodeOf(link), look())) << "a camera sees no code of the link";

    click("Replay");
    expectToPlayFromWorstMoment(twin_->lesson()->attempts(int(kTrainees.size()) - 1));
    EXPECT_LE(clicks_, kMostClicks);
    EXPECT_EQ(clicks_, kClicks) << "docs/howto/start.md has the table";
    EXPECT_EQ(turns_to_end_, 2);
}

}  // namespace
}  // namespace bonemill
