// It is the scan of the milled block (milled_scene.h): a dense shell around softer bone, with a canal and a
// dense grain on one side, so that no mirrored picture looks the same.
#pragma once

#include "render_client/link/density_store/density_store.h"
#include "tests/gl/milled_scene.h"

namespace bonemill::test {

inline DensityGrid blockGrid() {
    return {{65, 65, 65}, Eigen::Vector3d::Constant(2.5e-4), Eigen::Vector3d::Zero(), 16, -1000, 3000, 400};
}

struct ScanParts {
    bool has_canal = true;
    bool is_milled = true;  // the cavity is not in the scan
};

// Returns what the scan measured there (V), HU; the values of the bone's inside vary slowly.
inline double blockValue(const Eigen::Vector3d& p, const ScanParts& parts) {
    const double outside = (p - kBlockCenter).norm() - kBlockRadius;
    if (outside > 2e-4) return -950;
    if (outside > -2e-4) return 400 - 1350 * outside / 2e-4;
    const double hollow = (p - kHollowCenter).norm() - kHollowRadius;
    if (hollow < 2e-4) return std::max(-950.0, 400 + 1350 * hollow / 2e-4);
    const Eigen::Vector3d canal = p - kBlockCenter - Eigen::Vector3d(0, 0.0022, 0.0012);
    const Eigen::Vector3d grain = p - kBlockCenter - Eigen::Vector3d(-0.0006, -0.0012, 0.0026);
    if (parts.has_canal && canal.tail<2>().norm() < 0.8e-3) return 450;
    if (grain.norm() < 0.7e-3) return 2700;
    return outside > -1.2e-3 ? 1750 : 1050 + 3e4 * (p.y() - kBlockCenter.y());
}

// Returns what is left there, HU.
inline double blockValueNow(const Eigen::Vector3d& p, const ScanParts& parts) {
    const double into_cavity = kCavityRadius - (p - kCavityCenter).norm();
    const double scanned = blockValue(p, parts);
    if (into_cavity < -2e-4) return scanned;
    return into_cavity > 2e-4 ? -1000 : std::min(scanned, 400 - 1400 * into_cavity / 2e-4);
}

inline DensityBrick blockBrick(uint32_t number, const ScanParts& parts) {
    const DensityGrid grid = blockGrid();
    const auto density = [&](double value) { return uint16_t(std::lround((value + 1000) / 4000 * 65535)); };
    DensityBrick brick;
    const Eigen::Vector3i first = firstVoxelOf(grid, number);
    for (int k = 0; k < grid.brick_edge; ++k)
        for (int j = 0; j < grid.brick_edge; ++j)
            for (int i = 0; i < grid.brick_edge; ++i) {
                const Eigen::Vector3d p = 2.5e-4 * (first + Eigen::Vector3i(i, j, k)).cast<double>();
                brick.scanned.push_back(density(blockValue(p, parts)));
                if (parts.is_milled) brick.present.push_back(density(blockValueNow(p, parts)));
                brick.materials.push_back(blockMaterial(p));
            }
    brick.revision = 1;
    return brick;
}

}  // namespace bonemill::test
