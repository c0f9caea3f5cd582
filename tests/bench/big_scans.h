// Makes large scans of things that look like what is scanned, for scan_bench: as large as a clinic's and a
// micro-CT's, with noise, so that nothing packs or predicts better than it would.
#pragma once

#include <filesystem>

namespace bonemill::bench {

// A CT head in a DICOM series: 512 x 512 pixels of 0.45 mm, `slices` of them over 224 mm, 16 bit, not packed:
// skull with a sponge of cells behind the ear, brain, skin, air, a head rest. x = y = 0 is the middle, z = 0
// the lowest slice. Throws UserError.
void makeHead(const std::filesystem::path& folder, int slices);

// The same files in another transfer syntax, by GDCM. Throws UserError.
enum class Packing { kJpegLossless, kJpeg2000, kRle };
void packSeries(const std::filesystem::path& from, const std::filesystem::path& folder, Packing packing);

// A micro-CT: `edge`^3 voxels of 0.1 mm, 16 bit: a rod of trabecular bone in air, 80 % of the edge long and
// wide. Writes micro.raw, and micro.nhdr and micro.mhd that name it. The first voxel is at the origin.
// Throws UserError.
void makeMicro(const std::filesystem::path& folder, int edge);

}  // namespace bonemill::bench
