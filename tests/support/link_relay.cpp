// This is a bad line: it carries frames between two TAP devices with a limited rate, delay and loss, the same
// in each direction.
//   link_relay NEAR FAR_NAMESPACE FAR RATE_KBIT_PER_S DELAY_MS LOSS_PER_MILLE QUEUE_KIB
// It makes NEAR in its own network namespace and FAR in the other one (a file of /proc/PID/ns/net's kind),
// prints "ready", and runs until it is killed. A rate of 0 is no limit. Frames that find the queue full are
// lost. Loss comes from a generator with a fixed seed.
#include <fcntl.h>
#include <linux/if.h>
#include <linux/if_tun.h>
#include <poll.h>
#include <sched.h>
#include <sys/ioctl.h>
#include <unistd.h>

#include <algorithm>
#include <array>
#include <cerrno>
#include <chrono>
#include <cstring>
#include <deque>
#include <iostream>
#include <random>
#include <stdexcept>
#include <string>
#include <vector>

namespace {

using Clock = std::chrono::steady_clock;
using Frame = std::vector<char>;

constexpr size_t kLargestFrame = 65536 + 64;
constexpr unsigned kSeed = 20121;

struct Line {
    double rate_bytes_per_s = 0;  // 0: no limit
    Clock::duration delay{};
    int loss_per_mille = 0;
    size_t queue_bytes = 0;
};

[[noreturn]] void fail(const std::string& what) {
    throw std::runtime_error("link_relay: " + what + " (" + std::strerror(errno) + ")");
}

int openTap(const std::string& name) {
    const int device = open("/dev/net/tun", O_RDWR | O_NONBLOCK | O_CLOEXEC);
    if (device < 0) fail("/dev/net/tun");
    ifreq request{};
    request.ifr_flags = IFF_TAP | IFF_NO_PI;
    name.copy(request.ifr_name, IFNAMSIZ - 1);
    if (ioctl(device, TUNSETIFF, &request) != 0) fail("TAP device " + name);
    return device;
}

void enterNamespace(const std::string& file) {
    const int descriptor = open(file.c_str(), O_RDONLY | O_CLOEXEC);
    if (descriptor < 0 || setns(descriptor, CLONE_NEWNET) != 0) fail(file);
    close(descriptor);
}

class Direction {
  public:
    Direction(const Line& line, unsigned seed) : line_(line), generator_(seed) {}

    void take(const char* bytes, size_t size, Clock::time_point now) {
        const bool is_lost = loss_(generator_) < line_.loss_per_mille;
        if (is_lost || waiting_bytes_ + size > line_.queue_bytes) return;
        line_free_ = std::max(line_free_, now) + timeOnLine(size);
        waiting_bytes_ += size;
        waiting_.push_back({line_free_ + line_.delay, Frame(bytes, bytes + size)});
    }
    // Frames on the wire are delivered in their order; what the far end does not take is lost, as on a wire.
    void deliver(int to, Clock::time_point now) {
        while (!waiting_.empty() && waiting_.front().due <= now) {
            const Frame& frame = waiting_.front().frame;
            [[maybe_unused]] const ssize_t written = write(to, frame.data(), frame.size());
            waiting_bytes_ -= frame.size();
            waiting_.pop_front();
        }
    }
    Clock::time_point nextDue() const {
        return waiting_.empty() ? Clock::time_point::max() : waiting_.front().due;
    }

  private:
    struct Waiting {
        Clock::time_point due;
        Frame frame;
    };
    Clock::duration timeOnLine(size_t size) const {
        if (line_.rate_bytes_per_s == 0) return {};
        return std::chrono::duration_cast<Clock::duration>(
            std::chrono::duration<double>(double(size) / line_.rate_bytes_per_s));
    }

    Line line_;
    std::mt19937 generator_;
    std::uniform_int_distribution<int> loss_{0, 999};
    Clock::time_point line_free_{};
    size_t waiting_bytes_ = 0;
    std::deque<Waiting> waiting_;
};

int waitTimeMs(Clock::time_point due, Clock::time_point now) {
    if (due == Clock::time_point::max()) return -1;
    const auto left = std::chrono::ceil<std::chrono::milliseconds>(due - now).count();
    return int(std::clamp<long>(left, 0, 1000));
}

void relay(const std::array<int, 2>& taps, const Line& line) {
    std::array<Direction, 2> directions{Direction(line, kSeed), Direction(line, kSeed + 1)};
    std::vector<char> buffer(kLargestFrame);
    while (true) {
        const Clock::time_point due = std::min(directions[0].nextDue(), directions[1].nextDue());
        pollfd inputs[2] = {{taps[0], POLLIN, 0}, {taps[1], POLLIN, 0}};
        if (poll(inputs, 2, waitTimeMs(due, Clock::now())) < 0 && errno != EINTR) fail("poll");
        for (size_t from = 0; from < 2; ++from) {
            for (ssize_t size; (size = read(taps[from], buffer.data(), buffer.size())) > 0;)
                directions[from].take(buffer.data(), size_t(size), Clock::now());
            directions[from].deliver(taps[1 - from], Clock::now());
        }
    }
}

}  // namespace

int main(int argc, char** argv) {
    if (argc != 8) {
        std::cerr << "link_relay: seven arguments, see its source\n";
        return 2;
    }
    try {
        const Line line{.rate_bytes_per_s = std::stod(argv[4]) * 1000 / 8,
                        .delay = std::chrono::milliseconds(std::stoi(argv[5])),
                        .loss_per_mille = std::stoi(argv[6]),
                        .queue_bytes = size_t(std::stoi(argv[7])) * 1024};
        const int near = openTap(argv[1]);
        enterNamespace(argv[2]);
        const int far = openTap(argv[3]);
        std::cout << "ready" << std::endl;
        relay({near, far}, line);
    } catch (const std::exception& error) {
        std::cerr << error.what() << '\n';
        return 1;
    }
}
