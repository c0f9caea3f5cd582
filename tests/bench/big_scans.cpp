#include "tests/bench/big_scans.h"

#include <cmath>
#include <fstream>
#include <span>
#include <vector>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "haptic_server/cases/phantom_dicom/dicom_series_writer.h"

namespace bonemill::bench {
namespace {

namespace fs = std::filesystem;

// Cheap noise, the same in every run: a sum of two bytes of a linear congruential generator, about -1 .. 1.
class Noise {
  public:
    explicit Noise(uint32_t seed) : state_(seed * 2654435761u + 1) {}
    float next() {
        state_ = state_ * 1664525u + 1013904223u;
        return (float(state_ >> 24) + float(state_ >> 16 & 255)) / 255 - 1;
    }

  private:
    uint32_t state_;
};

// A sponge of struts and holes that meet everywhere (gyroid), -1.5 .. 1.5, of this period.
class Sponge {
  public:
    Sponge(int count, double step, double period) : sin_(size_t(count)), cos_(size_t(count)) {
        for (size_t n = 0; n < sin_.size(); ++n) {
            sin_[n] = float(std::sin(2 * M_PI * double(n) * step / period));
            cos_[n] = float(std::cos(2 * M_PI * double(n) * step / period));
        }
    }
    float at(size_t i, size_t j, size_t k) const {
        return sin_[i] * cos_[j] + sin_[j] * cos_[k] + sin_[k] * cos_[i];
    }

  private:
    std::vector<float> sin_, cos_;
};

constexpr int kHeadEdge = 512;
constexpr double kPixelMm = 0.45, kHeadMm = 224;

float ellipsoid(float x, float y, float z, float a, float b, float c) {
    return std::sqrt(x * x / (a * a) + y * y / (b * b) + z * z / (c * c));
}

// HU without noise at a place in mm; z counts from the head's middle.
float headAt(float x, float y, float z, float sponge) {
    const float skin = ellipsoid(x, y, z, 84, 104, 106);
    if (skin > 1) return y > 108 && y < 112 && std::abs(x) < 60 ? 400.f : -1000.f;  // head rest
    const float outer = ellipsoid(x, y, z, 76, 96, 98), inner = ellipsoid(x, y, z, 70, 90, 92);
    const float mastoid = ellipsoid(std::abs(x) - 58, y - 18, z + 45, 16, 18, 22);
    if (mastoid < 1 && outer < 1) return sponge > 0.2f ? 1400.f : sponge < -0.4f ? -700.f : 500.f;
    if (outer > 1) return 40;
    if (inner > 1) return outer > 0.985f || inner < 1.02f ? 1600.f : 700.f;
    return 35;
}

}  // namespace

void makeHead(const fs::path& folder, int slices) {
    RawVolume head;
    head.geometry.dims = {kHeadEdge, kHeadEdge, slices};
    head.geometry.spacing = Eigen::Vector3d(kPixelMm, kPixelMm, kHeadMm / slices) * kMillimetre;
    head.geometry.X_WV.position = Eigen::Vector3d(-kHeadEdge / 2, -kHeadEdge / 2, 0) * kPixelMm * kMillimetre;
    const Sponge sponge(std::max(kHeadEdge, slices), kPixelMm, 5);
    head.values.reserve(head.geometry.voxelCount());
    std::vector<int16_t> slice(size_t(kHeadEdge) * kHeadEdge);
    for (int k = 0; k < slices; ++k) {
        Noise noise{uint32_t(k)};
        const auto z = float(k * kHeadMm / slices - kHeadMm / 2);
        for (size_t at = 0; at < slice.size(); ++at) {
            const size_t i = at % kHeadEdge, j = at / kHeadEdge;
            const float x = (float(i) - kHeadEdge / 2) * float(kPixelMm);
            const float y = (float(j) - kHeadEdge / 2) * float(kPixelMm);
            slice[at] = int16_t(headAt(x, y, z, sponge.at(i, j, size_t(k))) + 25 * noise.next());
        }
        head.values.append(std::span<const int16_t>(slice));
    }
    writeCtSeries(folder, head, {"PHANTOM", "head", "scan_bench " + std::to_string(slices)});
}

void makeMicro(const fs::path& folder, int edge) {
    constexpr double kVoxelMm = 0.1;
    const Sponge sponge(edge, kVoxelMm, 1.6);
    std::ofstream raw(folder / "micro.raw", std::ios::binary);
    std::vector<uint16_t> slice(size_t(edge) * size_t(edge));
    const float middle = float(edge) / 2, reach = 0.4f * float(edge);
    for (int k = 0; k < edge; ++k) {
        Noise noise{uint32_t(k)};
        const bool is_beyond = std::abs(float(k) - middle) > reach;
        for (size_t at = 0; at < slice.size(); ++at) {
            const size_t i = at % size_t(edge), j = at / size_t(edge);
            const float r = std::hypot(float(i) - middle, float(j) - middle);
            float value = 3000;  // air
            if (r <= reach && !is_beyond)
                value = r > reach - 8
                            ? 24000
                            : 9000 + 15000 * std::clamp(3 * (sponge.at(i, j, size_t(k)) - 0.3f), 0.f, 1.f);
            slice[at] = uint16_t(value + 800 * noise.next());
        }
        raw.write(reinterpret_cast<const char*>(slice.data()), std::streamsize(slice.size() * 2));
    }
    raw.close();
    if (!raw) throw UserError("cannot write " + (folder / "micro.raw").string() + "; is the disk full?");
    const std::string n = std::to_string(edge), dims = n + " " + n + " " + n;
    std::ofstream(folder / "micro.nhdr") << "NRRD0004\ntype: uint16\ndimension: 3\nsizes: " << dims
                                         << "\nspacings: 0.1 0.1 0.1\nencoding: raw\nendian: little\n"
                                            "data file: micro.raw\n";
    std::ofstream(folder / "micro.mhd") << "ObjectType = Image\nNDims = 3\nBinaryData = True\n"
                                           "BinaryDataByteOrderMSB = False\nDimSize = "
                                        << dims
                                        << "\nElementSpacing = 0.1 0.1 0.1\nElementType = MET_USHORT\n"
                                           "ElementDataFile = micro.raw\n";
}

}  // namespace bonemill::bench
