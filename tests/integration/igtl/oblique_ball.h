// A scan whose axes are oblique to the patient's, as one file and as numbers: a ball of bone in air.
#pragma once

#include <gtest/gtest.h>

#include <Eigen/Geometry>
#include <fstream>
#include <vector>

namespace bonemill::test {

struct ObliqueBall {
    static constexpr int kEdge = 44;  // voxels
    static constexpr double kSpacing_mm = 0.5, kRadius_mm = 8, kIso = 300;
    // Where voxel (0, 0, 0) is, and one step along each axis, as NRRD has them: LPS, mm.
    Eigen::Vector3d origin{-31, 12, 140};
    Eigen::Matrix3d steps =
        kSpacing_mm * Eigen::AngleAxisd(0.5, Eigen::Vector3d(1, -2, 0.7).normalized()).toRotationMatrix();

    // Left-handed axes, as of scans that go from the head down.
    void mirror() { steps.col(2) *= -1; }
    Eigen::Vector3d middle() const { return origin + steps * Eigen::Vector3d::Constant((kEdge - 1) / 2.0); }
    int16_t valueAt(const Eigen::Vector3d& p_LPS) const {
        return int16_t(std::lround(kIso + 100 * (kRadius_mm - (p_LPS - middle()).norm())));
    }
    std::vector<int16_t> voxels() const {
        std::vector<int16_t> values;
        for (int k = 0; k < kEdge; ++k)
            for (int j = 0; j < kEdge; ++j)
                for (int i = 0; i < kEdge; ++i)
                    values.push_back(valueAt(origin + steps * Eigen::Vector3d(i, j, k)));
        return values;
    }
    void write(const std::string& path) const {
        std::ofstream file(path, std::ios::binary);
        const auto vector = [](const Eigen::Vector3d& v) {
            std::ostringstream text;
            text.precision(17);
            text << "(" << v.x() << "," << v.y() << "," << v.z() << ")";
            return text.str();
        };
        file << "NRRD0004\ntype: short\ndimension: 3\nspace: left-posterior-superior\nsizes: " << kEdge << " "
             << kEdge << " " << kEdge << "\nspace directions: " << vector(steps.col(0)) << " "
             << vector(steps.col(1)) << " " << vector(steps.col(2))
             << "\nkinds: domain domain domain\nendian: little\nencoding: raw\nspace origin: "
             << vector(origin) << "\n\n";
        const std::vector<int16_t> values = voxels();
        file.write(reinterpret_cast<const char*>(values.data()), std::streamsize(values.size() * 2));
        ASSERT_TRUE(file.good());
    }
};

// What 3D Slicer makes of a place in LPS.
inline Eigen::Vector3d rasOfLps(const Eigen::Vector3d& p) {
    return {-p.x(), -p.y(), p.z()};
}

}  // namespace bonemill::test
