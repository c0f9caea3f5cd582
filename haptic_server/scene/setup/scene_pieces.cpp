#include "haptic_server/scene/setup/scene_pieces.h"

#include <algorithm>

#include "haptic_server/scene/setup/refuse_field.h"

namespace bonemill {
namespace {

constexpr size_t kMaxRemarked = 4, kMaxListed = 100;

std::vector<bool> droppedOf(const LoadedScene& loaded, const BonePieces& pieces, const IndexBox& region,
                            int scan_voxels) {
    const scene::Volume& scene = loaded.scene.volume();
    const size_t count = pieces.list().size();
    std::vector<bool> is_dropped(count), touches(count, true);
    if (scene.keep_pieces() == scene::Volume::TOUCHING_REGION) {
        if (region.isEmpty())
            refuseField(loaded, "volume.keep_pieces", ": TOUCHING_REGION needs a volume.region");
        touches = pieces.touching(region);
    }
    for (size_t n = 0; n < count; ++n)
        is_dropped[n] = pieces.list()[n].voxels * uint64_t(scan_voxels) < scene.smallest_piece_voxels() ||
                        !touches[n] || (scene.keep_pieces() == scene::Volume::LARGEST_PIECE && n > 0);
    for (int n = 0; n < scene.drop_piece_size(); ++n) {
        if (scene.drop_piece(n) > count)
            refuseField(loaded, "volume.drop_piece[" + std::to_string(n) + "]",
                        ": there are only " + std::to_string(count) + " pieces");
        is_dropped[scene.drop_piece(n) - 1] = true;
    }
    return is_dropped;
}

// Those whose is_listed is true: the largest, and how many more.
std::string list(const BonePieces& pieces, const std::vector<bool>& is_dropped, bool is_listed,
                 const VolumeGeometry& geometry, const char* separator, size_t most) {
    std::string text;
    size_t listed = 0, more = 0;
    uint64_t voxels = 0;
    for (size_t n = 0; n < is_dropped.size(); ++n) {
        if (is_dropped[n] != is_listed) continue;
        if (listed == most) {
            ++more;
            voxels += pieces.list()[n].voxels;
            continue;
        }
        text += (listed++ > 0 ? separator : "") + textOf(pieces.list()[n], n + 1, geometry);
    }
    if (more > 0)
        text += separator + std::to_string(more) + " more of " + std::to_string(voxels) + " voxels in all";
    return text;
}

}  // namespace

bool choosesPieces(const scene::Scene& scene) {
    const scene::Volume& volume = scene.volume();
    return volume.smallest_piece_voxels() > 1 || volume.keep_pieces() != scene::Volume::ALL_PIECES ||
           volume.drop_piece_size() > 0;
}

void dropPieces(const LoadedScene& loaded, VoxelVolume& volume, const IndexBox& region,
                std::vector<std::string>& remarks, const DroppedVoxels& of_dropped) {
    if (!choosesPieces(loaded.scene)) return;
    const BonePieces pieces(volume);
    const std::vector<bool> is_dropped = droppedOf(loaded, pieces, region, of_dropped.scan_voxels);
    if (!std::ranges::count(is_dropped, false))
        refuseField(loaded, "volume",
                    pieces.list().empty() ? ": no voxel reaches the iso-value"
                                          : ": all pieces of bone are dropped; the largest is " +
                                                textOf(pieces.list()[0], 1, volume.geometry()));
    const std::string dropped = list(pieces, is_dropped, true, volume.geometry(), "; ", kMaxRemarked);
    remarks.push_back("kept " + list(pieces, is_dropped, false, volume.geometry(), "; ", kMaxRemarked) +
                      (dropped.empty() ? "" : "; dropped " + dropped));
    pieces.drop(volume, is_dropped, of_dropped.see);
}

std::string listPieces(const VoxelVolume& volume) {
    const BonePieces pieces(volume);
    return list(pieces, std::vector<bool>(pieces.list().size()), false, volume.geometry(), "\n  ",
                kMaxListed);
}

}  // namespace bonemill
