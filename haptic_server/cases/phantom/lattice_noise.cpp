#include "haptic_server/cases/phantom/lattice_noise.h"

namespace bonemill {
namespace {

double latticeNoise(int i, int j, int k) noexcept {
    return unitOf(splitMix64(uint64_t(uint16_t(i)) << 32 | uint64_t(uint16_t(j)) << 16 | uint16_t(k)));
}

}  // namespace

uint64_t splitMix64(uint64_t word) noexcept {
    word += 0x9e3779b97f4a7c15u;
    word = (word ^ (word >> 30)) * 0xbf58476d1ce4e5b9u;
    word = (word ^ (word >> 27)) * 0x94d049bb133111ebu;
    return word ^ (word >> 31);
}

double unitOf(uint64_t random) noexcept {
    return double(random >> 40) / double((1 << 24) - 1);
}

double smoothNoise(const Eigen::Vector3d& p, double step) noexcept {
    const Eigen::Vector3d at = p / step;
    const Eigen::Vector3i low = at.array().floor().cast<int>();
    const Eigen::Vector3d part = at - low.cast<double>();
    double noise = 0;
    for (int corner = 0; corner < 8; ++corner) {
        const Eigen::Vector3i up(corner & 1, corner >> 1 & 1, corner >> 2);
        double weight = 1;
        for (int a = 0; a < 3; ++a) weight *= up[a] ? part[a] : 1 - part[a];
        noise += weight * latticeNoise(low.x() + up.x(), low.y() + up.y(), low.z() + up.z());
    }
    return noise;
}

}  // namespace bonemill
