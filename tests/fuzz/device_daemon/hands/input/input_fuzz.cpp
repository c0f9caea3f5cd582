// Whatever bytes a SpaceMouse's socket or an input file gives, in whatever pieces, nothing crashes and no
// rate exceeds the largest one.
#include <gtest/gtest.h>

#include <cmath>
#include <random>

#include "device_daemon/hands/input/gamepad_device.h"
#include "device_daemon/hands/input/rate_device.h"
#include "device_daemon/hands/input/spacemouse_device.h"
#include "tests/support/mutated_bytes.h"
#include "tests/unit/device_daemon/hands/input/input_test_tools.h"

namespace bonemill {
namespace {

using test::bytesOf;

template <class T>
void append(std::string& bytes, const T& value) {
    bytes.append(reinterpret_cast<const char*>(&value), sizeof value);
}

// Hands the bytes over in pieces of random length.
template <class Stream>
void feed(Stream& stream, const std::string& bytes, std::mt19937& random) {
    auto left = std::as_bytes(std::span(bytes));
    while (!left.empty()) {
        const size_t size = std::min<size_t>(left.size(), 1 + random() % 50);
        stream.take(left.first(size));
        left = left.subspan(size);
    }
}

void expectBounded(const std::array<float, 6>& deflections, bool is_fine) {
    const RateConfig config;
    for (const float deflection : deflections) EXPECT_LE(std::abs(deflection), 1);
    const Rates rates = ratesOf(deflections, is_fine, config);
    EXPECT_LE(rates.v_D.norm(), config.max_speed * (1 + 1e-12));
    EXPECT_LE(rates.w_D.norm(), config.max_spin * (1 + 1e-12));
}

TEST(InputFuzz, SpacenavdMaySendAnything) {
    std::mt19937 random(1);
    std::string honest;
    append(honest, SpnavStream::kAskForProtocol1);
    append(honest, SpnavStream::Request{SpnavStream::kAskForDevice[0]});
    for (int i = 0; i < 20; ++i) {
        append(honest, SpnavStream::Request{0, 10 * i, -350, 350, 0, 5, -i, 8});
        append(honest, SpnavStream::Request{i % 4, i % 3});
    }
    FullScale scale;
    int seen = 0;
    for (int round = 0; round < 5000; ++round) {
        SpnavStream stream;
        feed(stream, test::mutated(honest, random), random);
        std::array<float, 6> deflections;
        for (size_t i = 0; i < 6; ++i) deflections[i] = scale.shareOf(stream.counts()[i]);
        expectBounded(deflections, stream.buttons() & 4);
        seen += stream.counts()[1] == -350;
    }
    EXPECT_GT(seen, 500);  // many honest messages came through beside the damaged ones
}

TEST(InputFuzz, AnInputFileMayGiveAnything) {
    std::mt19937 random(2);
    std::string honest;
    for (int i = 0; i < 20; ++i) {
        append(honest, test::inputEvent(EV_ABS, int(random() % ABS_CNT), int(random())));
        append(honest, test::inputEvent(EV_KEY, int(random() % KEY_CNT), int(random() % 3)));
        append(honest, test::inputEvent(EV_ABS, ABS_X, 30000));
        append(honest, test::inputEvent(EV_SYN, SYN_REPORT, 0));
    }
    int seen = 0;
    for (int round = 0; round < 5000; ++round) {
        EvdevStream stream(test::padState());
        feed(stream, test::mutated(honest, random), random);
        const HandInput input = handInputOf(stream.state());
        expectBounded(input.deflections, input.is_fine);
        seen += stream.state().axes[ABS_X].value == 30000;
    }
    EXPECT_GT(seen, 500);
}

TEST(InputFuzz, RangesMayBeAnything) {
    std::mt19937 random(3);
    for (int round = 0; round < 5000; ++round) {
        EvdevState state;
        for (EvdevAxis& axis : state.axes) {
            const auto extreme = [&] {
                return random() % 4 ? int32_t(random()) : INT32_MIN + int32_t(random() % 2);
            };
            axis = {.value = extreme(), .min = extreme(), .max = extreme()};
        }
        expectBounded(handInputOf(state).deflections, false);
    }
}

TEST(InputFuzz, AWishStaysOnItsLeashWhateverTheRates) {
    std::mt19937 random(4);
    std::uniform_real_distribution<double> any(-5, 5);
    const Leash leash{.distance = 0.013, .angle = 0.1};
    RateWish wish(Pose{}, leash);
    for (int round = 0; round < 20000; ++round) {
        const Pose X_DT_handle{Eigen::Vector3d(any(random), any(random), any(random)) * 0.05,
                               expRotation({any(random), any(random), any(random)})};
        const Rates rates{.v_D = {any(random), any(random), any(random)},
                          .w_D = {any(random), any(random), any(random)}};
        wish.advance(any(random), rates, X_DT_handle);
        ASSERT_LE((wish.pose().position - X_DT_handle.position).norm(), leash.distance * (1 + 1e-9));
        ASSERT_LE(wish.pose().rotation.angularDistance(X_DT_handle.rotation), leash.angle * (1 + 1e-6));
    }
}

}  // namespace
}  // namespace bonemill
