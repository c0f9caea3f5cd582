// Reads DICOM segmentations (SEG, PS3.3 A.51): label maps with named segments, drawn on the slices of a scan.
#pragma once

#include <Eigen/Core>
#include <algorithm>
#include <array>
#include <cstdint>
#include <filesystem>

#include "common/math/pinned_math.h"
#include "haptic_server/core/volume/raw_volume.h"

namespace bonemill {

// Binary segments, and fractional ones from half of their largest value on, on a grid of their own; voxels
// have the segment's number, or where segments overlap that of a combination (segments.h). The file has been
// scanned (dicom_scan.h). Throws UserError naming it.
RawVolume importDicomSegments(const std::filesystem::path& file);

// The colours are CIELab of the profile connection space (illuminant D50), PS3.3 C.10.7.1.1. Of L*, a* and b*
// as stored (L* of 0 .. 100 and a*, b* of -128 .. 127 over 0 .. 65535): red, green, blue of sRGB, 0 .. 1,
// each cut off there.
inline Eigen::Vector3d colorOfLab(const std::array<uint16_t, 3>& stored) {
    constexpr double kMax = 65535;
    const double lightness = stored[0] / kMax * 100;
    const double a = stored[1] / kMax * 255 - 128, b = stored[2] / kMax * 255 - 128;
    const auto unfold = [](double f) {
        constexpr double kBend = 6.0 / 29;
        return f > kBend ? f * f * f : 3 * kBend * kBend * (f - 4.0 / 29);
    };
    const double fy = (lightness + 16) / 116;
    const Eigen::Vector3d white(0.96422, 1, 0.82521);
    const Eigen::Vector3d xyz =
        white.cwiseProduct(Eigen::Vector3d(unfold(fy + a / 500), unfold(fy), unfold(fy - b / 200)));
    // From D50 to the sRGB of IEC 61966-2-1, whose white is D65, by Bradford's adaptation.
    Eigen::Matrix3d to_linear;
    to_linear << 3.1338561, -1.6168667, -0.4906146, -0.9787684, 1.9161415, 0.0334540, 0.0719453, -0.2289914,
        1.4052427;
    return (to_linear * xyz).unaryExpr([](double linear) {
        if (!(linear > 0)) return 0.0;
        const double shown =
            linear <= 0.0031308 ? 12.92 * linear : 1.055 * pinned::pow(linear, 1 / 2.4) - 0.055;
        return std::min(shown, 1.0);
    });
}

}  // namespace bonemill
