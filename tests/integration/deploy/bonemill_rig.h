// Puts bonemill where an installed one lies, beside programs that are stand-ins or the real ones, with state,
// logs and data in a folder of its own.
#pragma once

#include <gtest/gtest.h>
#include <signal.h>

#include <algorithm>
#include <filesystem>
#include <sstream>
#include <string>
#include <vector>

#include "tests/support/places.h"
#include "tests/support/process.h"

namespace bonemill::test {

// A stand-in notes in `events` how it was started and that it was told to end, and prints what is in
// NAME.says. It leaves with the number in NAME.leave as soon as that is there.
constexpr const char* kStandIn = R"sh(#!/bin/bash
name=${0##*/} folder=${0%/*}/..
if [[ $1 == --help || $1 == --list ]]; then cat "$folder/$name.help"; exit; fi
trap 'echo "end $name" >>"$folder/events"; exit "$(cat "$folder/$name.end" 2>/dev/null || echo 0)"' TERM
echo "start $name $$ $*" >>"$folder/events"
[[ ! -e $folder/$name.says ]] || cat "$folder/$name.says"
while [[ ! -e $folder/$name.leave ]]; do sleep 0.02; done
exit "$(cat "$folder/$name.leave")"
)sh";

class BonemillRig {
  public:
    BonemillRig() {
        namespace fs = std::filesystem;
        for (const char* folder : {"bin", "share", "run"}) fs::create_directory(folder_ / folder);
        fs::copy_file(sourceDir() + "/deploy/bonemill", folder_ / "bin/bonemill");
        fs::create_directory_symlink(sourceDir() + "/deploy", folder_ / "share/bonemill");
        writeFile(folder_ / "own.textproto", "name: \"own\"\n");
        writeFile(folder_ / "device_daemon.help",
                  "  --device TEXT\n  --profile TEXT\n  --stop-dir TEXT\n  --list\n");
    }

    void useStandIns() const {
        for (const char* program : {"bonemill_lab", "haptic_server", "device_daemon", "render_client"})
            putProgram(program, kStandIn);
    }
    void useRealPrograms() const {
        for (const char* program : {"bonemill_lab", "haptic_server", "device_daemon", "render_client"})
            std::filesystem::create_symlink(binDir() + "/" + program, programFile(program));
    }
    void putProgram(const std::string& name, const std::string& script) const {
        writeFile(programFile(name), script);
        std::filesystem::permissions(programFile(name), std::filesystem::perms::owner_all);
    }
    std::string programFile(const std::string& name) const { return folder_ / ("bin/" + name); }
    std::string scene() const { return folder_ / "own.textproto"; }
    const TemporaryFolder& folder() const { return folder_; }

    std::vector<std::string> words(const std::vector<std::string>& more) const {
        std::vector<std::string> all{"/usr/bin/env",
                                     "--default-signal=INT",  // A test in the background may have it ignored.
                                     "--unset=DISPLAY",
                                     "--unset=WAYLAND_DISPLAY",
                                     "XDG_RUNTIME_DIR=" + folder_ / "run",
                                     "XDG_STATE_HOME=" + folder_ / "logs",
                                     "XDG_DATA_HOME=" + folder_ / "data"};
        if (has_display_) all.push_back("DISPLAY=:99");
        all.push_back(programFile("bonemill"));
        all.insert(all.end(), more.begin(), more.end());
        return all;
    }
    Finished call(const std::vector<std::string>& more) const { return run(words(more)); }
    void setDisplay(bool has_display) { has_display_ = has_display; }

    std::string events() const { return readFile(folder_ / "events"); }
    // Returns the processes of all stand-ins of this name, in the order in which they were started.
    std::vector<int> pidsOf(const std::string& name) const {
        std::vector<int> pids;
        std::istringstream lines(events());
        for (std::string line; std::getline(lines, line);)
            if (line.rfind("start " + name + " ", 0) == 0)
                pids.push_back(std::stoi(line.substr(name.size() + 7)));
        return pids;
    }
    bool awaitStarts(const std::string& name, size_t count) const {
        return waitFor([&] { return pidsOf(name).size() >= count; });
    }
    void letSay(const std::string& name, const std::string& text) const {
        writeFile(folder_ / (name + ".says"), text);
    }
    void letLeave(const std::string& name, int exit_code) const {
        writeFile(folder_ / "leave", std::to_string(exit_code) + "\n");
        std::filesystem::rename(folder_ / "leave", folder_ / (name + ".leave"));
    }

  private:
    TemporaryFolder folder_;
    bool has_display_ = true;
};

// What has died but was not waited for yet is gone, too.
inline bool isGone(int pid) {
    const std::string stat = readFile("/proc/" + std::to_string(pid) + "/stat");
    const size_t name_end = stat.rfind(") ");
    return name_end == std::string::npos || stat[name_end + 2] == 'Z';
}

inline long linesOf(const std::string& text) {
    return std::count(text.begin(), text.end(), '\n');
}

// One line that holds `part` says what was wrong with the words.
inline void expectRefusal(const Finished& finished, const std::string& part) {
    EXPECT_EQ(finished.exit_code, 2) << finished.out;
    EXPECT_EQ(finished.err.rfind("bonemill: ", 0), 0u) << finished.err;
    EXPECT_NE(finished.err.find(part), std::string::npos) << finished.err;
    EXPECT_EQ(linesOf(finished.err), 1) << finished.err;
}

}  // namespace bonemill::test
