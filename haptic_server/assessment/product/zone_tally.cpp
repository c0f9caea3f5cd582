#include "haptic_server/assessment/product/zone_tally.h"

#include <array>

#include "common/base/units.h"

namespace bonemill {
namespace {

constexpr int kVersion = 1;

struct RoleName {
    ZoneRole role;
    const char *id, *label;
};
constexpr std::array kRoleNames{
    RoleName{ZoneRole::kTarget, "target", "Target"},
    RoleName{ZoneRole::kLeewaySides, "leeway_sides", "Leeway at the sides"},
    RoleName{ZoneRole::kLeewayBottom, "leeway_bottom", "Leeway at the bottom"},
    RoleName{ZoneRole::kContainerSides, "container_sides", "Beyond the leeway, sides"},
    RoleName{ZoneRole::kContainerBottom, "container_bottom", "Beyond the leeway, bottom"}};

// One row of both volumes at a time.
class RowReader {
  public:
    explicit RowReader(const VoxelVolume& volume)
        : volume_(volume), row_(size_t(volume.dims().x()) + VoxelVolume::kReadSlack) {}
    const Density* read(int j, int k) {
        volume_.readRow({0, j, k}, volume_.dims().x(), row_.data());
        return row_.data();
    }

  private:
    const VoxelVolume& volume_;
    std::vector<Density> row_;
};

double shareGone(Density before, Density now) {
    return now >= before ? 0 : double(before - now) / double(before);
}

class ZoneFigureWriter {
  public:
    ZoneFigureWriter(double voxel_mm3, Figures& figures) : voxel_mm3_(voxel_mm3), figures_(figures) {}

    void write(const std::string& kind, const std::string& of, const std::string& name,
               const ZoneCount& count) {
        const auto add = [&](const char* what, const std::string& label, double value, const char* unit) {
            figures_.push_back({kind + what + of, kVersion, label, value, unit});
        };
        add(".removed_volume", name + ": removed", double(count.removed) * voxel_mm3_, "mm3");
        add(".density_removed_volume", name + ": removed, by density", count.density_gone * voxel_mm3_,
            "mm3");
        if (count.bone == 0) return;
        const double percent = 100 / double(count.bone);
        add(".removed", name + ": removed", percent * double(count.removed), "percent");
        add(".density_removed", name + ": removed, by density", percent * count.density_gone, "percent");
        add(".left_volume", name + ": left", double(count.bone - count.removed) * voxel_mm3_, "mm3");
    }

  private:
    double voxel_mm3_;
    Figures& figures_;
};

void add(ZoneCount& sum, const ZoneCount& count) {
    sum.bone += count.bone;
    sum.removed += count.removed;
    sum.density_gone += count.density_gone;
}

void addOverlap(const ProductCounts& counts, Figures& figures) {
    const double removed = double(counts.removed()), ideal = double(counts.ideal),
                 both = double(counts.ideal_removed);
    const auto add = [&](const char* id, const char* label, double part, double whole) {
        if (whole > 0) figures.push_back({std::string("overlap.") + id, kVersion, label, part / whole, ""});
    };
    add("dice", "Likeness to the ideal (Dice)", 2 * both, removed + ideal);
    add("jaccard", "Likeness to the ideal (Jaccard)", both, removed + ideal - both);
    add("precision", "Of what was removed, what should be (precision)", both, removed);
    add("recall", "Of what should be removed, what was (recall)", both, ideal);
}

}  // namespace

int64_t ProductCounts::removed() const noexcept {
    int64_t sum = 0;
    for (const ZoneCount& zone : zones) sum += zone.removed;
    return sum;
}

ProductCounts countProduct(const VoxelVolume& scanned, const VoxelVolume& now, const JudgedTask& task) {
    ProductCounts counts;
    counts.zones.resize(task.zones.size() + 1);
    const Eigen::Vector3i& dims = scanned.dims();
    const Density iso = scanned.iso();
    RowReader before_rows(scanned), now_rows(now);
    for (int k = 0; k < dims.z(); ++k)
        for (int j = 0; j < dims.y(); ++j) {
            const Density* before = before_rows.read(j, k);
            const Density* after = now_rows.read(j, k);
            for (int i = 0; i < dims.x(); ++i) {
                if (before[i] < iso) continue;
                const Eigen::Vector3i voxel(i, j, k);
                ZoneCount& zone = counts.zones[task.map->at(voxel)];
                const bool is_removed = after[i] < iso, is_ideal = task.isIdeal(voxel);
                ++zone.bone;
                zone.removed += is_removed;
                zone.density_gone += shareGone(before[i], after[i]);
                counts.ideal += is_ideal;
                counts.ideal_removed += is_ideal && is_removed;
                if (is_removed || is_ideal) counts.changed.include(voxel);
            }
        }
    return counts;
}

void addZoneFigures(const ProductCounts& counts, const JudgedTask& task, double voxel_volume,
                    Figures& figures) {
    const double voxel_mm3 = voxel_volume * kPerCubicMillimetre;
    ZoneFigureWriter writer(voxel_mm3, figures);
    for (size_t n = 0; n < task.zones.size(); ++n)
        writer.write("zone", ":" + task.zones[n].name, task.zones[n].name, counts.zones[n + 1]);
    for (const RoleName& role : kRoleNames) {
        ZoneCount sum;
        bool is_there = false;
        for (size_t n = 0; n < task.zones.size(); ++n) {
            if (task.zones[n].role != role.role) continue;
            add(sum, counts.zones[n + 1]);
            is_there = true;
        }
        if (is_there) writer.write(role.id, "", role.label, sum);
    }
    figures.push_back({"outside.removed_volume", kVersion, "Outside of all zones: removed",
                       double(counts.zones[0].removed) * voxel_mm3, "mm3"});
    figures.push_back(
        {"product.removed_volume", kVersion, "Removed in all", double(counts.removed()) * voxel_mm3, "mm3"});
    addOverlap(counts, figures);
}

}  // namespace bonemill
