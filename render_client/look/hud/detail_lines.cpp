#include "render_client/look/hud/detail_lines.h"

#include <iterator>
#include <utility>

#include "common/base/units.h"
#include "render_client/look/hud/device_lines.h"
#include "render_client/look/hud/effect_lines.h"
#include "render_client/look/hud/figure_text.h"

namespace bonemill {
namespace {

constexpr size_t kMaxAccuracyLines = 2;

void append(std::vector<HudRow> more, std::vector<HudRow>& rows) {
    rows.insert(rows.end(), std::make_move_iterator(more.begin()), std::make_move_iterator(more.end()));
}

void addLoopRows(const topics::Status& status, std::vector<HudRow>& rows) {
    const bool has_ticked = status.ticks() > 0;
    rows.push_back({"Loop", has_ticked ? figureText(status.rate_hz(), 1, " Hz") : kNoNumber});
    rows.push_back({"Tick p50 / p99", has_ticked ? readableText(status.tick_p50_us(), "") + " / " +
                                                       readableText(status.tick_p99_us(), " \u00b5s")
                                                 : kNoNumber});
}

void addAccuracyRows(const topics::Status& status, std::vector<HudRow>& rows) {
    // A preset is one word; all knobs take more than one line.
    std::vector<std::string> lines = wrappedText(status.preset(), kLongestRow);
    if (lines.size() > kMaxAccuracyLines) {
        lines.resize(kMaxAccuracyLines);
        lines.back() += "\u2026";
    }
    std::string label = "Accuracy";
    for (const std::string& line : lines) rows.push_back({std::exchange(label, ""), line});
    rows.push_back({"Force error", status.has_accuracy_error()
                                       ? readableText(status.force_error_percent(), " %") + ", " +
                                             readableText(status.force_direction_error_deg(), "\u00b0")
                                       : "not measured"});
}

void addContactRows(const topics::ToolState& tool, std::vector<HudRow>& rows) {
    const auto& torque = tool.torque_nm();
    rows.push_back({"Torque", lengthText({torque.data(), size_t(torque.size())}, kPerMilli, " N\u00b7mm")});
    rows.push_back({"Contacts", std::to_string(tool.contacts())});
}

HudRow faultRow(size_t count) {
    if (count == 0) return {"Faults", "none", HudTone::kGood};
    return {"Faults", std::to_string(count) + ", see the panel", HudTone::kWarning};
}

}  // namespace

std::vector<HudRow> detailRows(const HudInput& input) {
    std::vector<HudRow> rows;
    if (input.status) {
        addLoopRows(*input.status, rows);
        addAccuracyRows(*input.status, rows);
    }
    if (input.tool) {
        addContactRows(*input.tool, rows);
        append(effectDetailRows(input.tool->effects()), rows);
    }
    if (input.status && input.status->has_device())
        append(deviceRows(input.status->device(), input.tool ? &*input.tool : nullptr), rows);
    rows.push_back(faultRow(input.fault_count));
    rows.push_back({"Watching", std::to_string(input.watchers.size())});
    if (input.frame_rate_hz > 0) rows.push_back({"Pictures", figureText(input.frame_rate_hz, 0, " Hz")});
    return rows;
}

}  // namespace bonemill
