// A recorded session can be checked on another PC: the state hash of a scene with effects does not depend on
// which variants of exp, log, sin, ... the C library picks for the CPU.
#include <gtest/gtest.h>

#include <cmath>
#include <cstdlib>
#include <nlohmann/json.hpp>
#include <sstream>

#include "tests/support/every_effect_scene.h"
#include "tests/support/places.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

using test::TemporaryFolder;

// This is glibc without fused multiply-add: it has the names of glibc 2.33 and later, and those from before,
// which know no others.
const char* const kWithoutFma = "glibc.cpu.hwcaps=-FMA,-AVX2,-FMA4,-FMA_Usable,-AVX2_Usable,-FMA4_Usable";

// The hand goes down into the block, to and fro with the pedal, then with added material, and out.
std::string millingPath(const test::EveryEffectBlock& block) {
    const double edge = block.edge * block.voxel_mm * 1e-3, face = edge / 2 + block.burr_radius_mm * 1e-3;
    std::ostringstream csv;
    csv.precision(17);
    csv << "t_s,px_m,py_m,pz_m,qw,qx,qy,qz,buttons\n";
    for (int n = 0; n < 700; ++n) {
        const double share = n / 700.0, down = 1 - std::abs(2 * share - 1);
        const double x = edge / 2 + 1e-3 * (4 * std::abs(share - 0.5) - 1), z = face + 0.3e-3 - 2.5e-3 * down;
        const int buttons = n < 150 ? 0 : n < 500 ? 1 : n < 600 ? 2 : 0;
        csv << n * 1e-3 << ',' << x << ',' << edge / 2 << ',' << z << ",0.6,0.77,0.2,0.0843," << buttons
            << '\n';
    }
    return csv.str();
}

nlohmann::json simulate(const TemporaryFolder& folder, const char* tunables) {
    if (tunables) setenv("GLIBC_TUNABLES", tunables, 1);
    const auto finished = test::run({"haptic_server", "simulate", "--scene", folder / "scene.textproto",
                                     "--trajectory", folder / "path.csv"});
    unsetenv("GLIBC_TUNABLES");
    EXPECT_EQ(finished.exit_code, 0) << finished.err;
    return nlohmann::json::parse(finished.out.substr(finished.out.rfind('\n', finished.out.size() - 2) + 1));
}

class CpuBits : public testing::TestWithParam<const char*> {};

TEST_P(CpuBits, TheHashIsTheSameWithoutFusedMultiplyAdd) {
    if (!__builtin_cpu_supports("fma"))
        GTEST_SKIP() << "this CPU has no fused multiply-add: there is nothing to turn off";
    const TemporaryFolder folder;
    const test::EveryEffectBlock block;
    test::writeBlock(folder.path().string(), block);
    test::writeScene(folder / "scene.textproto", test::everyEffectScene(block, GetParam()));
    test::writeFile(folder / "path.csv", millingPath(block));
    const auto with = simulate(folder, nullptr), without = simulate(folder, kWithoutFma);
    EXPECT_GT(with["removed_mm3"].get<double>(), 0);
    EXPECT_EQ(with["state_hash"], without["state_hash"]);
}

INSTANTIATE_TEST_SUITE_P(Law, CpuBits, testing::Values(test::kByTime, test::kByEnergy),
                         [](const auto& info) { return std::string(info.param); });

// Otherwise the test above compares a run with itself.
TEST(CpuBitsTunables, ChangeTheCLibrarysLastBits) {
    if (!__builtin_cpu_supports("fma"))
        GTEST_SKIP() << "this CPU has no fused multiply-add: there is nothing to turn off";
    const auto sum = [](const char* tunables) {
        if (tunables) setenv("GLIBC_TUNABLES", tunables, 1);
        const auto finished = test::run({test::helperDir() + "/library_bits"});
        unsetenv("GLIBC_TUNABLES");
        EXPECT_EQ(finished.exit_code, 0) << finished.err;
        return finished.out;
    };
    EXPECT_NE(sum(nullptr), sum(kWithoutFma));
}

}  // namespace
}  // namespace bonemill
