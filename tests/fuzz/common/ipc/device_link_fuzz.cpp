// Random bytes in the shared memory lead to a clear refusal at the start, or to messages that isPlausible()
// can judge, never to a crash.
#include <gtest/gtest.h>

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <limits>
#include <random>
#include <vector>

#include "tests/unit/common/ipc/link_test_tools.h"

namespace bonemill {
namespace {

#if defined(__SANITIZE_ADDRESS__) || defined(__SANITIZE_THREAD__)
constexpr int kImages = 50'000;
#else
constexpr int kImages = 1'000'000;
#endif

using Random = std::mt19937_64;

void fillWithRandomBytes(Random& random, unsigned char* bytes, size_t size) {
    for (size_t i = 0; i < size; i += sizeof(uint64_t)) {
        const uint64_t word = random();
        std::memcpy(bytes + i, &word, std::min(sizeof(word), size - i));
    }
}

TEST(DeviceLinkFuzz, randomMemoryOfNobodyIsRefused) {
    Random random(1);
    const TestSession session;
    for (int round = 0; round < 500; ++round) {
        const size_t size = 8 + random() % (2 * sizeof(LinkMemory));
        RawMemory memory(session, size);
        fillWithRandomBytes(random, memory.bytes(), size);
        EXPECT_NE(session.refusalOf(LinkSide::kServer), "");
        memory.remove();
    }
}

TEST(DeviceLinkFuzz, randomMemoryOfALivingPeerIsRefused) {
    Random random(2);
    const TestSession session;
    const HeldSemaphore living(session, kDaemonSemaphore);
    for (int round = 0; round < 500; ++round) {
        const size_t size = 8 + random() % (2 * sizeof(LinkMemory));
        RawMemory memory(session, size);
        fillWithRandomBytes(random, memory.bytes(), size);
        // Some get past the first checks.
        if (round % 2) memory.write(kLinkMagic, offsetof(LinkHeader, magic));
        if (round % 4 == 3) memory.write(kLinkLayoutVersion, offsetof(LinkHeader, layout_version));
        EXPECT_NE(session.refusalOf(LinkSide::kServer), "");
        memory.remove();
    }
}

// What no reader may ever be handed; isPlausible() is judged by it.
template <size_t n>
bool isWithin(const double (&values)[n], double most) {
    for (const double value : values) {
        if (!(value >= -most && value <= most)) return false;
    }
    return true;
}

bool isSound(const DeviceSample& sample) {
    double squares = 0;
    for (const double q : sample.q_DT) squares += q * q;
    return isWithin(sample.p_DT, 10) && squares > 0.99 && squares < 1.01 && isWithin(sample.v_DT, 100) &&
           isWithin(sample.w_DT, 1000) && SafetyState(sample.state) <= SafetyState::kFault &&
           StopCause(sample.stop_cause) <= StopCause::kLatePackets;
}

bool isSound(const WrenchCommand& command) {
    constexpr double kLargest = std::numeric_limits<double>::max();
    return isWithin(command.f_hand_D, kLargest) && isWithin(command.t_hand_D, kLargest);
}

bool isSound(const DeviceCapabilities& capabilities) {
    const double figures[] = {capabilities.max_force, capabilities.max_torque, capabilities.max_stiffness,
                              capabilities.max_rotation_stiffness, capabilities.workspace_radius};
    const HandleDynamics& handle = capabilities.handle;
    const double of_handle[] = {
        handle.mass,           handle.damping, handle.inertia,      handle.angular_damping,
        handle.amplifier_time, handle.delay,   handle.encoder_step, handle.encoder_angle};
    const auto isFigure = [](double figure) { return figure >= 0 && !std::isinf(figure); };
    if (!std::all_of(std::begin(figures), std::end(figures), isFigure)) return false;
    if (!std::all_of(std::begin(of_handle), std::end(of_handle), isFigure)) return false;
    return strnlen(capabilities.name, sizeof(capabilities.name)) < sizeof(capabilities.name) &&
           DeviceKind(capabilities.kind) <= DeviceKind::kGamepad;
}

struct Tally {
    int read = 0, accepted = 0, malformed = 0;

    template <class Message>
    void judge(const Message& message) {
        ++read;
        if (!isPlausible(message)) return;
        ++accepted;
        if (!isSound(message)) ++malformed;
    }
};

// Draws what may lie behind the header of a link: all of it random, or an honest content with some words
// changed.
class Images {
  public:
    explicit Images(const unsigned char* honest) : honest_(honest, honest + sizeof(LinkMemory)) {}

    void drawInto(unsigned char* memory) {
        if (random_() % 4 == 0) {
            fillWithRandomBytes(random_, memory + kBody, sizeof(LinkMemory) - kBody);
            return;
        }
        std::memcpy(memory + kBody, honest_.data() + kBody, sizeof(LinkMemory) - kBody);
        version_ += 2;  // as if just written
        for (const size_t channel : kChannels) std::memcpy(memory + channel, &version_, sizeof(version_));
        for (auto changes = random_() % 8; changes > 0; --changes) changeWord(memory);
        if (random_() % 32 == 0) std::memset(memory + kName, 'x', sizeof(DeviceCapabilities::name));
    }

  private:
    static constexpr size_t kBody = offsetof(LinkMemory, server);
    // Each begins with the counter of its seqlock, and the message follows.
    static constexpr size_t kChannels[] = {offsetof(LinkMemory, sample), offsetof(LinkMemory, command),
                                           offsetof(LinkMemory, capabilities)};
    static constexpr size_t kName = offsetof(LinkMemory, capabilities) + sizeof(uint64_t);

    void changeWord(unsigned char* memory) {
        uint64_t word = 0;
        const size_t place = kBody + random_() % ((sizeof(LinkMemory) - kBody) / sizeof(word)) * sizeof(word);
        std::memcpy(&word, memory + place, sizeof(word));
        word = changed(word);
        std::memcpy(memory + place, &word, sizeof(word));
    }

    uint64_t changed(uint64_t word) {
        using Double = std::numeric_limits<double>;
        constexpr double kEdges[] = {
            Double::quiet_NaN(), Double::infinity(), -Double::infinity(), 1e300, -1e-310, -1.0, 10.0, 100.1};
        switch (random_() % 4) {
            case 0:
                return random_();
            case 1:
                return word ^ (uint64_t(1) << random_() % 64);
            case 2:
                return std::bit_cast<uint64_t>(kEdges[random_() % std::size(kEdges)]);
            default:
                return random_() % 16 | (random_() % 16) << 32;  // two numbers of states, causes or kinds
        }
    }

    std::vector<unsigned char> honest_;
    Random random_{3};
    uint32_t version_ = 0;
};

void writeHonestContent(DeviceLink& server, DeviceLink& daemon) {
    DeviceSample sample{};
    sample.q_DT[0] = 1.0;
    daemon.writeSample(sample);
    server.writeCommand({});
    daemon.writeCapabilities({});
}

TEST(DeviceLinkFuzz, whateverIsReadAndAcceptedIsSound) {
    const TestSession session;
    DeviceLink server = session.open(LinkSide::kServer);
    DeviceLink daemon = session.open(LinkSide::kDaemon);
    writeHonestContent(server, daemon);
    const RawMemory memory(session);
    Images images(memory.bytes());
    Tally samples, commands, capabilities;
    DeviceSample sample{};
    WrenchCommand command{};
    DeviceCapabilities device{};
    for (int image = 0; image < kImages; ++image) {
        images.drawInto(memory.bytes());
        if (image % 64 == 0) {
            server.waitForSample(0);
            daemon.waitForCommand(0);
        }
        if (server.readSample(sample)) samples.judge(sample);
        if (daemon.readCommand(command)) commands.judge(command);
        if (server.readCapabilities(device)) capabilities.judge(device);
    }
    for (const Tally& tally : {samples, commands, capabilities}) {
        EXPECT_EQ(tally.malformed, 0);
        EXPECT_GT(tally.accepted, kImages / 4);  // the judge saw both kinds
        EXPECT_GT(tally.read - tally.accepted, kImages / 200);
    }
    writeHonestContent(server, daemon);  // which repairs the link
    EXPECT_TRUE(server.readSample(sample) && isPlausible(sample));
    EXPECT_TRUE(daemon.readCommand(command) && isPlausible(command));
    EXPECT_TRUE(server.readCapabilities(device) && isPlausible(device));
}

}  // namespace
}  // namespace bonemill
