// Makes a molar-like tooth in Hounsfield units: enamel shell, dentine, pulp chamber with root canals, caries
// in the fissure.
//
// Lengths are in m. In W z runs along the tooth axis with the crown towards +z, and the axis goes through x =
// y = 0. x runs along the row of teeth (mesio-distal, crown 11 mm), y across it (10.5 mm); root tips are near
// z = 0.55 mm, cusp tips near z = 19.5 mm. Thread-safe; start-up only.
#pragma once

#include <cstdint>

#include "haptic_server/core/volume/raw_volume.h"

namespace bonemill {

enum class ToothTissue : uint8_t { kAir, kPulp, kCaries, kDentine, kEnamel };

inline constexpr double kToothHu[] = {-1000, 40, 700, 1600, 2900};  // by ToothTissue

ToothTissue toothTissue(const Eigen::Vector3d& p_W) noexcept;

// The same tooth without caries, as signed distances in m, negative inside, exact to some 20 % near a
// surface.
struct SoundTooth {
    double outer;   // the whole tooth
    double enamel;  // between it and the dentine, negative in the enamel of a place inside the tooth
    double pulp;
};
SoundTooth soundTooth(const Eigen::Vector3d& p_W) noexcept;

struct ToothScan {
    double noise_hu = 0;  // standard deviation of Gaussian noise
    uint64_t seed = 1;
};

// The grid has the thesis' tooth size: 256 x 256 x 161 voxels of 0.125 mm, z from 0 to 20 mm.
VolumeGeometry toothGrid();

// Each voxel is the mean of the tissues in the 1.5 voxels around it (the scanner's blur), rounded to whole
// HU. The same arguments give the same values everywhere.
RawVolume scanTooth(const VolumeGeometry& geometry, const ToothScan& scan);

}  // namespace bonemill
