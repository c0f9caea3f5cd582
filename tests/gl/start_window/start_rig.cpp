#include "tests/gl/start_window/start_rig.h"

#include <signal.h>
#include <unistd.h>

#include <filesystem>
#include <sstream>
#include <stdexcept>

#include "common/text/printed_text.h"

namespace bonemill::test {
namespace {

namespace fs = std::filesystem;

// "bonemill 12, haptic_server 34" as a session's file tells it.
void addPids(const std::string& list, std::map<std::string, int>& pids) {
    std::istringstream stream(list);
    std::string name;
    for (int pid = 0; stream >> name >> pid; stream.ignore(1)) pids[name] = pid;
}

}  // namespace

StartRig::StartRig(int width, int height) : display_(width, height) {
    rig_.useRealPrograms();
    for (const char* program : {"ares_emulator", "make_phantom", "start_window"})
        fs::create_symlink(binDir() + "/" + program, rig_.programFile(program));
    fs::create_directory(rig_.folder() / "home");
    const Finished made = run({sourceDir() + "/deploy/make-phantoms", "--bin", binDir(), "--out",
                               rig_.folder() / "home/.local/share/bonemill/build/data", "tooth"});
    EXPECT_EQ(made.exit_code, 0) << made.err;
    std::string script = "#!/bin/sh\nexec";
    for (const std::string& word : words({})) script += " " + quoted(word);
    rig_.putProgram("as_typed", script + " \"$@\"\n");
    twin_ = std::make_unique<ClickedStart>(rig_.programFile("as_typed"), width, height);
}

StartRig::~StartRig() {
    if (!window_) return;
    window_->signal(SIGTERM);
    waitFor([this] { return processes().empty(); });
}

std::vector<std::string> StartRig::words(const std::vector<std::string>& more) const {
    std::vector<std::string> all{"/usr/bin/env", "LIBGL_ALWAYS_SOFTWARE=1", "LP_NUM_THREADS=1"};
    for (const char* name : {"XDG_STATE_HOME", "XDG_DATA_HOME", "XDG_CONFIG_HOME"})
        all.push_back(std::string("--unset=") + name);
    all.insert(all.end(), {"HOME=" + rig_.folder() / "home", "XDG_RUNTIME_DIR=" + rig_.folder() / "run",
                           rig_.programFile("bonemill")});
    all.insert(all.end(), more.begin(), more.end());
    return all;
}

void StartRig::open() {
    window_ = std::make_unique<Process>(words({"window", "--domain", std::to_string(testDomain())}));
    // Until the window is there nothing can be clicked in it: xdotool waits for it.
    display_.type({"search", "--sync", "--onlyvisible", "--name", "^bonemill: start$"});
}

// The window may not have its list yet: whoever clicks too early clicks once more, as nobody has heard it.
void StartRig::click(const std::string& label) {
    twin_->look();
    const auto place = twin_->screen.find(label);
    if (!place) throw std::runtime_error("the window has no control '" + label + "'");
    display_.type({"mousemove", std::to_string(int(place->x)), std::to_string(int(place->y))});
    display_.type({"click", "1"});
    ++clicks_;
}

void StartRig::hold(int x, int y) {
    display_.type({"mousemove", std::to_string(x), std::to_string(y)});
    display_.type({"mousedown", "1"});
    ++clicks_;
}

std::optional<StartRig::Session> StartRig::session() const {
    const fs::path state = rig_.folder() / ("run/bonemill-" + std::to_string(getuid()));
    std::error_code error;
    for (fs::directory_iterator file(state, error), end; !error && file != end; file.increment(error)) {
        if (file->path().extension() != ".session") continue;
        Session session{uint32_t(std::stoul(file->path().stem())), {}, {}};
        std::istringstream lines(readFile(file->path()));
        for (std::string line; std::getline(lines, line);) {
            if (line.starts_with("logs=")) session.logs = line.substr(5);
            if (line.starts_with("script=")) addPids("bonemill " + line.substr(7), session.pids);
            if (line.starts_with("programs=, ")) addPids(line.substr(11), session.pids);
        }
        return session;
    }
    return std::nullopt;
}

std::vector<int> StartRig::processes() const {
    std::vector<int> pids;
    for (const auto& folder : fs::directory_iterator("/proc")) {
        const std::string name = folder.path().filename();
        if (name.find_first_not_of("0123456789") != std::string::npos) continue;
        if (readFile(folder.path() / "cmdline").find(rig_.folder().path()) != std::string::npos)
            pids.push_back(std::stoi(name));
    }
    return pids;
}

void StartRig::await(const std::string& what, const std::function<bool()>& holds) const {
    if (!waitFor(holds))
        throw std::runtime_error("waited in vain for " + what + "\n" + window_->outSoFar() +
                                 window_->errSoFar());
}

}  // namespace bonemill::test
