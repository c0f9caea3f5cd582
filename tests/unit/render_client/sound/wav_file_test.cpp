#include <gtest/gtest.h>

#include <fstream>
#include <iterator>

#include "common/base/user_error.h"
#include "render_client/sound/sound_output.h"
#include "tests/support/temporary_folder.h"

namespace bonemill {
namespace {

TEST(WavFile, saysWhatItHolds) {
    const test::TemporaryFolder folder;
    WavFile file(folder / "sound.wav", 48000);
    const float samples[] = {0, 0.5f, -1, 3, -3};
    file.write(samples);
    file.finish();
    std::ifstream stream(folder / "sound.wav", std::ios::binary);
    const std::string bytes((std::istreambuf_iterator<char>(stream)), {});
    ASSERT_EQ(bytes.size(), 44u + 10u);
    EXPECT_EQ(bytes.substr(0, 4), "RIFF");
    EXPECT_EQ(bytes.substr(8, 8), "WAVEfmt ");
    const auto number = [&](size_t at, int count) {
        uint32_t value = 0;
        for (int i = 0; i < count; ++i) value |= uint32_t(uint8_t(bytes[at + size_t(i)])) << (8 * i);
        return value;
    };
    EXPECT_EQ(number(4, 4), bytes.size() - 8);
    EXPECT_EQ(number(22, 2), 1u);
    EXPECT_EQ(number(24, 4), 48000u);
    EXPECT_EQ(number(40, 4), 10u);
    const int expected[] = {0, 16384, -32767, 32767, -32767};
    for (size_t i = 0; i < 5; ++i) EXPECT_EQ(int16_t(number(44 + 2 * i, 2)), expected[i]);
}

TEST(WavFile, saysWhereItCannotBe) {
    try {
        WavFile("/nowhere/sound.wav", 48000);
        FAIL();
    } catch (const UserError& error) {
        EXPECT_NE(std::string(error.what()).find("/nowhere/sound.wav"), std::string::npos) << error.what();
    }
}

}  // namespace
}  // namespace bonemill
