#include <algorithm>
#include <cmath>
#include <string_view>
#include <vector>

#include "common/base/units.h"
#include "common/base/user_error.h"
#include "common/text/printed_text.h"
#include "haptic_server/core/volume/surface_ramp.h"
#include "haptic_server/scans/confined/import_limits.h"
#include "haptic_server/scans/confined/shared_name.h"
#include "haptic_server/scans/formats/volume_file.h"
#include "haptic_server/scans/nrrd/nrrd_header.h"
#include "haptic_server/scans/solid_mesh/mesh_distance.h"
#include "haptic_server/scans/solid_mesh/mesh_file.h"

namespace bonemill {
namespace {

using Eigen::Vector3d;

constexpr double kVoxelsOfLongestEdge = 128;
constexpr double kFinestMm = 0.02, kCoarsestMm = 10;
constexpr int kMarginVoxels = 3;           // of air: the ramp and one
constexpr double kMostVoxels = 1 << 29;    // a minute of computing
constexpr double kLipschitzSlack = 1.001;  // float rounding
// Comments stand there: in the first of an STL, and in all of the longest head that a PLY may have.
constexpr size_t kStlHeadBytes = 1024, kPlyHeadBytes = size_t(1) << 16;

std::string number(double value) {
    return printed("%.3g", value);
}

VolumeGeometry gridAround(const Eigen::AlignedBox3d& box, std::optional<double> voxel_mm,
                          const std::string& file) {
    const double longest = box.sizes().maxCoeff();
    const double by_default = longest / kVoxelsOfLongestEdge * kPerMillimetre;
    const double voxel = voxel_mm.value_or(std::clamp(by_default, kFinestMm, kCoarsestMm)) * kMillimetre;
    const Vector3d dims = (box.sizes() / voxel).array().ceil() + 1 + 2 * kMarginVoxels;
    if (dims.prod() > kMostVoxels)
        throw UserError(file + ": voxels of " + number(voxel * kPerMillimetre) + " mm would be " +
                        number(dims.x()) + " x " + number(dims.y()) + " x " + number(dims.z()) +
                        ", more than 2^29; raise volume.surface_voxel_mm");
    VolumeGeometry grid;
    grid.dims = dims.cast<int>();
    grid.spacing.setConstant(voxel);
    grid.X_WV.position = box.min() - Vector3d::Constant(kMarginVoxels * voxel);
    const std::vector<uint64_t> sizes(grid.dims.begin(), grid.dims.end());
    checkVolumeSize(sizes, sizeof(uint16_t), file);
    return grid;
}

// Goes through the grid row by row, and no closer than it must: as long as the surface is farther off than
// its ramp, the voxels on the way to it are all full or all empty.
class SurfaceSampler {
  public:
    SurfaceSampler(const TriangleMesh& mesh, const VolumeGeometry& grid, double inside, std::string file)
        : distance_(mesh), grid_(grid), inside_(inside), file_(std::move(file)) {}

    RawValues sample() {
        RawValues values;
        values.reserve(grid_.voxelCount());
        std::vector<uint16_t> slice, before;
        for (int k = 0; k < grid_.dims.z(); ++k) {
            slice.clear();
            for (int j = 0; j < grid_.dims.y(); ++j) addRow(j, k, slice);
            checkSteps(slice, before, k);
            values.append(std::span<const uint16_t>(slice));
            std::swap(slice, before);
        }
        return values;
    }

  private:
    void addRow(int j, int k, std::vector<uint16_t>& slice) {
        const double voxel = grid_.spacing.x();
        const int length = grid_.dims.x();
        double before = 0;
        int step = 0;
        for (int i = 0; i < length; i += step) {
            const double distance = distanceAt({i, j, k});
            if (step > 0 && std::abs(distance - before) > kLipschitzSlack * step * voxel)
                refuseContradiction({i, j, k});
            before = distance;
            step = std::clamp(int(std::abs(distance) / voxel - kRampVoxels), 1, length - i);
            slice.insert(slice.end(), size_t(step),
                         uint16_t(std::lround(inside_ * rampShare(distance, voxel))));
        }
    }
    double distanceAt(const Eigen::Vector3i& voxel) {
        const MeshDistance::Nearest nearest =
            distance_.query(grid_.X_WV * Vector3d(grid_.spacing.cwiseProduct(voxel.cast<double>())), guess_);
        guess_ = nearest.triangle;
        return nearest.distance;
    }
    // Where the sign jumps, values differ by more than the ramp's step between neighbours.
    void checkSteps(const std::vector<uint16_t>& slice, const std::vector<uint16_t>& before, int k) const {
        const int most = int(inside_ / (2 * kRampVoxels) * kLipschitzSlack) + 1;
        const auto row = size_t(grid_.dims.x());
        for (size_t n = 0; n < slice.size(); ++n) {
            const bool is_below_even = before.empty() || std::abs(slice[n] - before[n]) <= most;
            if (is_below_even && (n < row || std::abs(slice[n] - slice[n - row]) <= most)) continue;
            refuseContradiction({int(n % row), int(n / row), k});
        }
    }
    [[noreturn]] void refuseContradiction(const Eigen::Vector3i& voxel) const {
        const Vector3d p =
            kPerMillimetre * (grid_.X_WV * Vector3d(grid_.spacing.cwiseProduct(voxel.cast<double>())));
        throw UserError(file_ + ": inside and outside cannot be told apart near (" + number(p.x()) + ", " +
                        number(p.y()) + ", " + number(p.z()) +
                        ") mm: parts pass through each other or are inside out; merge them into one solid "
                        "(boolean union), then export again");
    }

    MeshDistance distance_;
    VolumeGeometry grid_;
    double inside_;
    std::string file_;
    uint32_t guess_ = 0;
};

std::string headOf(const std::filesystem::path& path) {
    const std::string bytes = firstBytes(path, kPlyHeadBytes);
    return bytes.substr(0, bytes.starts_with("ply") ? bytes.find("\nend_header") : kStlHeadBytes);
}

// 3D Slicer writes which axes it means into the head of the files that it saves; empty: nothing is said.
std::string spaceOf(const std::string& head, const std::string& file) {
    constexpr std::string_view kWord = "SPACE=";
    const size_t at = head.find(kWord);
    if (at == std::string::npos) return {};
    const std::string space = head.substr(at + kWord.size(), 3);
    if (space == "RAS" || space == "LPS") return space;
    throw UserError(file + ": its head says " + std::string(kWord) + printable(space) +
                    "..., which is neither LPS nor RAS; export it in one of them");
}

}  // namespace

RawVolume importSurface(const std::filesystem::path& path, std::optional<double> voxel_mm, double inside) {
    noteFileBeingRead(path);
    const std::string file = path.string(), head = headOf(path);
    std::vector<Vector3d> corners = readMeshFile(path, kBoneSolid);
    const std::string space = spaceOf(head, file);
    if (space == "RAS")
        for (Vector3d& p : corners) p.head<2>() = -p.head<2>();
    const TriangleMesh mesh = closedMesh(corners, file, kBoneSolid);
    RawVolume raw;
    raw.geometry = gridAround(mesh.box(), voxel_mm, file);
    raw.values = SurfaceSampler(mesh, raw.geometry, inside, file).sample();
    raw.surface_value = inside / 2;
    raw.lacks_patient_axes = space.empty();
    const Vector3d size_mm = kPerMillimetre * mesh.box().sizes();
    raw.description =
        "surface of " + std::to_string(mesh.triangles.size()) + " triangles, " + number(size_mm.x()) + " x " +
        number(size_mm.y()) + " x " + number(size_mm.z()) + " mm if its numbers are mm, in voxels of " +
        number(raw.geometry.spacing.x() * kPerMillimetre) + " mm, bone from " + number(inside / 2);
    return raw;
}

}  // namespace bonemill
