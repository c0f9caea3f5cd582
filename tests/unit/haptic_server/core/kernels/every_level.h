// Tests run with the kernels of every instruction set that this CPU has, beside the baseline.
#pragma once

#include <gtest/gtest.h>

#include <cstring>
#include <random>
#include <string>
#include <vector>

#include "haptic_server/core/kernels/kernels.h"

namespace bonemill::test {

class EveryLevel : public testing::TestWithParam<CpuLevel> {
  protected:
    void SetUp() override {
        if (!isSupported(GetParam())) GTEST_SKIP() << "this CPU has no " << cpuLevelName(GetParam());
    }
    const Kernels& ours() const { return kernelsOf(GetParam()); }
    const Kernels& oracle() const { return kernelsOf(CpuLevel::kBaseline); }

    template <class Scalar>
    std::vector<Scalar> randoms(int count, double low, double high) {
        std::uniform_real_distribution<double> uniform(low, high);
        std::vector<Scalar> values(size_t(count) + kCellLanes);
        for (Scalar& v : values) v = Scalar(uniform(random_));
        return values;
    }
    int below(int end) { return std::uniform_int_distribution<int>(0, end - 1)(random_); }

    std::mt19937 random_{17};
};

inline std::string levelName(const testing::TestParamInfo<CpuLevel>& info) {
    return info.param == CpuLevel::kBaseline ? "baseline" : cpuLevelName(info.param);
}

template <class T>
void expectSameBits(const std::vector<T>& a, const std::vector<T>& b, int count) {
    EXPECT_EQ(std::memcmp(a.data(), b.data(), size_t(count) * sizeof(T)), 0);
}

}  // namespace bonemill::test
