#include "render_client/look/render_scene/remark_view.h"

#include <algorithm>
#include <functional>

#include "common/dds/remark_bounds.h"
#include "render_client/look/structures/structure_colours.h"

namespace bonemill {
namespace {

constexpr size_t kLongestLabel = 40;  // bytes
constexpr uint32_t kNoteColour = 0xf2f2f2;

std::string labelOf(const topics::Remark& note) {
    const std::string start = cutToBytes(note.note(), kLongestLabel);
    return start.size() < note.note().size() ? start + "\u2026" : start;
}

}  // namespace

Eigen::Vector3f strokeColour(uint32_t colour) {
    const auto part = [colour](int shift) { return float(colour >> shift & 0xff) / 255; };
    return linearColour({part(16), part(8), part(0)});
}

void RemarkView::set(const std::map<uint32_t, topics::Remark>& remarks) {
    strokes_.clear();
    labels_.clear();
    std::vector<const topics::Remark*> newest_first;
    for (const auto& [place, remark] : remarks)
        if (remark.points_m_size() >= 3) newest_first.push_back(&remark);
    std::ranges::sort(newest_first, std::greater{}, [](const topics::Remark* r) { return r->number(); });
    for (const topics::Remark* const remark : newest_first) {
        Stroke& stroke = strokes_.emplace_back();
        stroke.colour = strokeColour(remark->note().empty() ? remark->color() : kNoteColour);
        for (int n = 0; n + 2 < remark->points_m_size(); n += 3)
            stroke.points_W.emplace_back(remark->points_m(n), remark->points_m(n + 1),
                                         remark->points_m(n + 2));
        if (!remark->note().empty() && labels_.size() < kMaxLabels)
            labels_.push_back({stroke.points_W[0].cast<double>(), labelOf(*remark)});
    }
    std::ranges::reverse(strokes_);  // newer ones lie over older ones
}

}  // namespace bonemill
