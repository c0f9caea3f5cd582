#include "common/density_codec/density_codec.h"

#include <zstd.h>

#include <algorithm>
#include <new>

#include "common/base/assert.h"

namespace bonemill {
namespace {

enum Kind : uint8_t { kUniform, kCoded };           // of a scanned brick: its first byte
enum Voxel : uint8_t { kAsScanned, kAir, kOther };  // of a change
constexpr size_t kUniformSize = 3;
constexpr size_t kHeader = 5;        // kind, steps, the density beside the ladder; low bytes first
constexpr int kLevel = 1;            // higher ones gain 2 % and take several times as long
constexpr uint16_t kFinest = 65535;  // steps: every density is one

size_t voxelsOf(int edge) {
    return size_t(edge) * size_t(edge) * size_t(edge);
}

// Both sides compute it by the same IEEE operations, so a density that comes back once always does. The
// import computes densities of whole HU by the same ones (DensityMapping): halves are rounded alike.
constexpr double kHalf = 0.5;
uint16_t densityAt(uint16_t step, uint16_t steps) {
    return uint16_t(step / double(steps) * 65535.0 + kHalf);
}
uint16_t stepOf(uint16_t density, uint16_t steps) {
    return uint16_t(density * (steps / 65535.0) + kHalf);
}

// Small numbers of either sign become small ones.
uint16_t folded(uint16_t difference) {
    return uint16_t((difference << 1) ^ (difference & 0x8000 ? 0xffff : 0));
}
uint16_t unfolded(uint16_t number) {
    return uint16_t((number >> 1) ^ (number & 1 ? 0xffff : 0));
}

// Foretells a voxel from those before it: the median edge detector of LOCO-I, in its plane or, in the first
// row, in the one across.
uint16_t foretold(const uint16_t* voxel, int x, int y, int z, int edge) {
    const ptrdiff_t across = y > 0 ? -edge : z > 0 ? -ptrdiff_t(edge) * edge : 0;
    if (x == 0) return across != 0 ? voxel[across] : 0;
    if (across == 0) return voxel[-1];
    const int a = voxel[-1], b = voxel[across], corner = voxel[across - 1];
    return uint16_t(std::clamp(a + b - corner, std::min(a, b), std::max(a, b)));
}

template <class Visit>
void forEachVoxel(int edge, Visit&& visit) {
    size_t n = 0;
    for (int z = 0; z < edge; ++z)
        for (int y = 0; y < edge; ++y)
            for (int x = 0; x < edge; ++x) visit(n++, x, y, z);
}

void append(std::string& bytes, uint16_t number) {
    bytes += char(number & 0xff);
    bytes += char(number >> 8);
}
uint16_t numberAt(std::string_view bytes, size_t place) {
    return uint16_t(uint8_t(bytes[place]) | uint8_t(bytes[place + 1]) << 8);
}

}  // namespace

DensityEncoder::DensityEncoder(uint16_t steps) : zstd_(ZSTD_createCCtx(), ZSTD_freeCCtx), steps_(steps) {
    BONEMILL_ASSERT(steps >= 1);
    if (!zstd_) throw std::bad_alloc();
}

int DensityEncoder::standOn(uint16_t steps, std::span<const uint16_t> densities) {
    numbers_.resize(densities.size());
    int beside = 0;
    odd_ = 0;
    for (size_t n = 0; n < densities.size(); ++n) {
        numbers_[n] = stepOf(densities[n], steps);
        if (densityAt(numbers_[n], steps) == densities[n]) continue;
        if (beside == 0) odd_ = densities[n];
        beside = beside == 0 || (beside == 1 && odd_ == densities[n]) ? 1 : 2;
        numbers_[n] = uint16_t(steps + 1);
    }
    return beside;
}

void DensityEncoder::compress(std::string& out) {
    const size_t header = out.size();
    out.resize(header + ZSTD_compressBound(plain_.size()));
    const size_t size = ZSTD_compressCCtx(zstd_.get(), out.data() + header, out.size() - header,
                                          plain_.data(), plain_.size(), kLevel);
    if (ZSTD_isError(size)) throw std::bad_alloc();  // nothing else can go wrong
    out.resize(header + size);
}

std::string DensityEncoder::scanned(std::span<const uint16_t> densities, int edge) {
    BONEMILL_ASSERT(edge >= 1 && edge <= kMaxBrickEdge && densities.size() == voxelsOf(edge));
    const uint16_t first = densities[0];
    if (std::ranges::all_of(densities, [first](uint16_t density) { return density == first; })) {
        std::string out(1, char(kUniform));
        append(out, first);
        return out;
    }
    const uint16_t steps = standOn(steps_, densities) <= 1 ? steps_ : kFinest;
    if (steps != steps_) standOn(steps, densities);
    plain_.resize(2 * densities.size());
    forEachVoxel(edge, [&](size_t n, int x, int y, int z) {
        const uint16_t* const number = numbers_.data() + n;
        const uint16_t rest = folded(uint16_t(*number - foretold(number, x, y, z, edge)));
        plain_[n] = char(rest & 0xff);
        plain_[n + densities.size()] = char(rest >> 8);
    });
    std::string out(1, char(kCoded));
    append(out, steps);
    append(out, odd_);
    compress(out);
    return out;
}

std::string DensityEncoder::change(std::span<const uint16_t> scanned, std::span<const uint16_t> present) {
    BONEMILL_ASSERT(scanned.size() == present.size());
    if (std::ranges::equal(scanned, present)) return {};
    plain_.clear();
    std::string low, high;
    Voxel voxel = kAsScanned;
    for (size_t n = 0; n < scanned.size(); ++n) {
        const bool is_same = present[n] == scanned[n], is_air = present[n] == 0;
        // Air that was scanned as air is either: it goes on with the run that it is in.
        if (!(is_same && is_air) || voxel == kOther) voxel = is_same ? kAsScanned : is_air ? kAir : kOther;
        plain_ += char(voxel);
        if (voxel != kOther) continue;
        low += char(present[n] & 0xff);
        high += char(present[n] >> 8);
    }
    plain_ += low + high;
    std::string out;
    compress(out);
    return out;
}

std::string DensityEncoder::materials(std::span<const uint8_t> materials) {
    if (std::ranges::all_of(materials, [](uint8_t material) { return material == 0; })) return {};
    plain_.assign(materials.begin(), materials.end());
    std::string out;
    compress(out);
    return out;
}

DensityDecoder::DensityDecoder() : zstd_(ZSTD_createDCtx(), ZSTD_freeDCtx) {
    if (!zstd_) throw std::bad_alloc();
}

bool DensityDecoder::decompress(std::string_view bytes, size_t least, size_t most) {
    plain_.resize(most);
    const size_t size = ZSTD_decompressDCtx(zstd_.get(), plain_.data(), most, bytes.data(), bytes.size());
    if (ZSTD_isError(size) || size < least) return false;
    plain_.resize(size);
    return true;
}

std::optional<std::vector<uint16_t>> DensityDecoder::scanned(std::string_view bytes, int edge) {
    if (edge < 1 || edge > kMaxBrickEdge || bytes.size() < kUniformSize) return {};
    const size_t count = voxelsOf(edge);
    const uint16_t steps = numberAt(bytes, 1);
    if (bytes[0] == kUniform && bytes.size() == kUniformSize) return std::vector<uint16_t>(count, steps);
    if (bytes[0] != kCoded || bytes.size() < kHeader || steps == 0 ||
        !decompress(bytes.substr(kHeader), 2 * count, 2 * count))
        return {};
    std::vector<uint16_t> densities(count);
    uint16_t highest = 0;
    forEachVoxel(edge, [&](size_t n, int x, int y, int z) {
        uint16_t* const step = densities.data() + n;
        const auto rest = uint16_t(plain_[n] | plain_[n + count] << 8);
        *step = uint16_t(foretold(step, x, y, z, edge) + unfolded(rest));
        highest = std::max(highest, *step);
    });
    const uint16_t odd = numberAt(bytes, 3);
    if (highest > steps + 1) return {};
    for (uint16_t& step : densities) step = step > steps ? odd : densityAt(step, steps);
    return densities;
}

std::optional<std::vector<uint16_t>> DensityDecoder::present(std::string_view bytes,
                                                             std::span<const uint16_t> scanned) {
    std::vector<uint16_t> densities(scanned.begin(), scanned.end());
    if (bytes.empty()) return densities;
    const size_t count = scanned.size();
    if (!decompress(bytes, count, 3 * count)) return {};
    const auto others = size_t(std::count(plain_.begin(), plain_.begin() + ptrdiff_t(count), kOther));
    if (plain_.size() != count + 2 * others) return {};
    const uint8_t* low = plain_.data() + count;
    for (size_t n = 0; n < count; ++n) {
        if (plain_[n] > kOther) return {};
        if (plain_[n] == kAir) densities[n] = 0;
        if (plain_[n] != kOther) continue;
        densities[n] = uint16_t(low[0] | low[others] << 8);
        ++low;
    }
    return densities;
}

std::optional<std::vector<uint8_t>> DensityDecoder::materials(std::string_view bytes, size_t voxels) {
    if (bytes.empty()) return std::vector<uint8_t>();
    if (!decompress(bytes, voxels, voxels)) return {};
    return plain_;
}

}  // namespace bonemill
