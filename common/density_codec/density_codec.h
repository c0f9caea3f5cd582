// Turns a brick of densities into bytes on the wire and back, without loss: as scanned, and what has changed
// since. A brick has edge³ voxels, x fastest. It is not RT-safe (it allocates); an object is for one thread.
//
// Scanned: where all densities stand on a ladder of equal steps, as those of a scan in whole HU do, they are
// coded as steps; one density beside the ladder may be among them (the import gives one to small pieces that
// it removes). What the neighbours do not foretell goes through zstd, low bytes before high bytes. Change:
// per voxel, whether it is as scanned, air or neither, and the densities of the last. Materials: a byte per
// voxel through zstd.
#pragma once

#include <cstdint>
#include <memory>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

struct ZSTD_CCtx_s;  // zstd's ZSTD_CCtx
struct ZSTD_DCtx_s;

namespace bonemill {

inline constexpr int kMaxBrickEdge = 64;

class DensityEncoder {
  public:
    // The ladder has this many steps from 0 to 65535, 1 to 65535: for a scan in whole numbers those of its
    // window. A brick that does not stand on it costs more bytes.
    explicit DensityEncoder(uint16_t steps);

    // `densities` has edge³ values; edge is 1 to kMaxBrickEdge.
    std::string scanned(std::span<const uint16_t> densities, int edge);
    // Both are of the same brick. It is empty if they are the same.
    std::string change(std::span<const uint16_t> scanned, std::span<const uint16_t> present);
    // One number per voxel. It is empty if all are 0.
    std::string materials(std::span<const uint8_t> materials);

  private:
    // Returns the number of densities beside the ladder that it found, 2 at most.
    int standOn(uint16_t steps, std::span<const uint16_t> densities);
    void compress(std::string& out);

    std::unique_ptr<ZSTD_CCtx_s, size_t (*)(ZSTD_CCtx_s*)> zstd_;
    uint16_t steps_;
    std::vector<uint16_t> numbers_;  // of the steps, and `steps` + 1 for odd_
    uint16_t odd_ = 0;               // stands beside the ladder
    std::string plain_;
};

// It takes any bytes: it never throws on them, and never allocates more than some bytes per voxel.
class DensityDecoder {
  public:
    DensityDecoder();

    // Returns nothing for what is no brick of this edge.
    std::optional<std::vector<uint16_t>> scanned(std::string_view bytes, int edge);
    // Returns the densities now.
    std::optional<std::vector<uint16_t>> present(std::string_view bytes, std::span<const uint16_t> scanned);
    // Returns nothing where all are 0.
    std::optional<std::vector<uint8_t>> materials(std::string_view bytes, size_t voxels);

  private:
    bool decompress(std::string_view bytes, size_t least, size_t most);

    std::unique_ptr<ZSTD_DCtx_s, size_t (*)(ZSTD_DCtx_s*)> zstd_;
    std::vector<uint8_t> plain_;
};

}  // namespace bonemill
