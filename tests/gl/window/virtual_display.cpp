#include "tests/gl/window/virtual_display.h"

#include <poll.h>
#include <stdlib.h>
#include <unistd.h>

#include <filesystem>
#include <stdexcept>

namespace bonemill::test {
namespace {

constexpr char kServer[] = "/usr/bin/Xvfb";
constexpr char kHands[] = "/usr/bin/xdotool";
constexpr char kClipboard[] = "/usr/bin/xclip";
constexpr int kPatience_ms = 30000;

void require(const char* program, const char* package) {
    if (!std::filesystem::exists(program))
        throw std::runtime_error(std::string(program) + " is missing: install the package " + package +
                                 " (deploy/install-deps)");
}

// Returns the line that Xvfb writes when it is ready: the number of its display.
std::string readLine(int descriptor) {
    std::string line;
    char sign = 0;
    pollfd ready{descriptor, POLLIN, 0};
    while (poll(&ready, 1, kPatience_ms) == 1 && read(descriptor, &sign, 1) == 1 && sign != '\n')
        line += sign;
    return line;
}

}  // namespace

VirtualDisplay::VirtualDisplay(int width, int height) {
    require(kServer, "xvfb");
    require(kHands, "xdotool");
    require(kClipboard, "xclip");
    int ends[2];
    if (pipe(ends) != 0) throw std::runtime_error("no pipe for Xvfb");
    const std::string screen = std::to_string(width) + "x" + std::to_string(height) + "x24";
    server_ = std::make_unique<Process>(std::vector<std::string>{kServer, "-displayfd",
                                                                 std::to_string(ends[1]), "-screen", "0",
                                                                 screen, "-nolisten", "tcp", "-noreset"});
    close(ends[1]);
    const std::string number = readLine(ends[0]);
    close(ends[0]);
    if (number.empty()) throw std::runtime_error("Xvfb does not start: " + server_->errSoFar());
    setenv("DISPLAY", (":" + number).c_str(), 1);
    unsetenv("WAYLAND_DISPLAY");
    setenv("XDG_CONFIG_HOME", remembered_.path().c_str(), 1);
    setenv("LANGUAGE", "en", 1);  // what the tests look for
}

void VirtualDisplay::type(const std::vector<std::string>& words) const {
    std::vector<std::string> command{kHands};
    command.insert(command.end(), words.begin(), words.end());
    const Finished finished = run(command);
    if (finished.exit_code != 0) throw std::runtime_error("xdotool " + words[0] + ": " + finished.err);
}

std::string VirtualDisplay::clipboard() const {
    return run({kClipboard, "-out", "-selection", "clipboard"}).out;
}

}  // namespace bonemill::test
