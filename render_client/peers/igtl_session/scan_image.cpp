#include "render_client/peers/igtl_session/scan_image.h"

#include <algorithm>
#include <cmath>
#include <limits>
#include <numeric>

#include "common/igtl_wire/igtl_messages.h"
#include "render_client/peers/igtl_session/bone_pieces.h"
#include "render_client/peers/igtl_session/patient_axes.h"

namespace bonemill::igtl {
namespace {

uint64_t voxelsOf(const topics::DensityGrid& grid) {
    return uint64_t(grid.voxels(0)) * grid.voxels(1) * grid.voxels(2);
}

int16_t valueOf(uint16_t density, const DensityGrid& grid) {
    using Limits = std::numeric_limits<int16_t>;
    const double value = grid.value_at_0 + (grid.value_at_65535 - grid.value_at_0) * density / 65535.0;
    return int16_t(std::clamp(std::round(value), double(Limits::min()), double(Limits::max())));
}

void copy(const DensityBrick& brick, const Eigen::Vector3i& first, const DensityGrid& grid,
          std::vector<int16_t>& voxels) {
    const std::vector<uint16_t>& densities = brick.present.empty() ? brick.scanned : brick.present;
    const Eigen::Vector3i end = (first.array() + grid.brick_edge).min(grid.voxels.array());
    for (int k = first.z(); k < end.z(); ++k)
        for (int j = first.y(); j < end.y(); ++j)
            for (int i = first.x(); i < end.x(); ++i) {
                const Eigen::Vector3i in = Eigen::Vector3i(i, j, k) - first;
                const auto from = size_t((in.z() * grid.brick_edge + in.y()) * grid.brick_edge + in.x());
                const size_t to =
                    (size_t(k) * size_t(grid.voxels.y()) + size_t(j)) * size_t(grid.voxels.x()) + size_t(i);
                voxels[to] = valueOf(densities[from], grid);
            }
}

std::vector<int16_t> voxelsOf(const DensityStore& store) {
    const DensityGrid& grid = *store.grid();
    std::vector<int16_t> voxels(size_t(grid.voxels.cast<int64_t>().prod()));
    for (const uint32_t brick : store.wanted())
        copy(*store.find(brick), firstVoxelOf(grid, brick), grid, voxels);
    return voxels;
}

ImagePlace placeOf(const DensityGrid& grid, const Pose& X_WV) {
    const Eigen::Isometry3d ras_of_V = rasOf(X_WV);
    return {grid.voxels, ras_of_V.linear() * (grid.spacing_m * kPerMillimetre).asDiagonal(),
            ras_of_V * (grid.origin_m * kPerMillimetre)};
}

}  // namespace

std::string ScanImage::ask(const SceneSubscriber& subscriber, Clock::time_point now) {
    const auto& info = subscriber.sceneInfo();
    if (!info || !subscriber.hasServer()) return "there is no session";
    if (!info->has_densities() || !isUsableGrid(info->densities())) return "the session shows no scan";
    if (voxelsOf(info->densities()) > kMostVoxels)
        return "the scan has more than " + std::to_string(kMostVoxels >> 20) + " Mi voxels";
    if (onTheirWay() >= kMostOnTheirWay)
        return std::to_string(kMostOnTheirWay) + " peers have not read theirs yet; ask again later";
    if (!is_asked_) asked_ = now;
    is_asked_ = true;
    return "";
}

Blob ScanImage::follow(SceneSubscriber& subscriber, Clock::time_point now) {
    subscriber.followDensities(store_);
    if (!is_asked_) return nullptr;
    if (now - asked_ > kPatience) {
        end();
        return nullptr;
    }
    if (!store_.grid() || !subscriber.sceneInfo()) return nullptr;
    if (store_.wanted().empty()) {
        std::vector<uint32_t> all(size_t(brickCount(*store_.grid())));
        std::iota(all.begin(), all.end(), 0u);
        store_.want(std::move(all));
    }
    if (!store_.hasAllWanted()) return nullptr;
    const topics::SceneInfo& info = *subscriber.sceneInfo();
    const ImagePlace place = placeOf(*store_.grid(), poseOf(info.p_wv_m(), info.q_wv()));
    const int64_t stamp_ns = subscriber.toolState() ? subscriber.toolState()->stamp_ns() : 0;
    Blob frame =
        std::make_shared<const std::string>(imageFrame("bonemill_volume", stamp_ns, place, voxelsOf(store_)));
    std::erase_if(made_, [](const auto& earlier) { return earlier.expired(); });
    made_.push_back(frame);
    end();
    return frame;
}

size_t ScanImage::onTheirWay() const {
    return size_t(std::ranges::count_if(made_, [](const auto& frame) { return !frame.expired(); }));
}

void ScanImage::end() {
    is_asked_ = false;
    store_.want({});
    store_.clear();
}

}  // namespace bonemill::igtl
