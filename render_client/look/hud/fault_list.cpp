#include "render_client/look/hud/fault_list.h"

#include <algorithm>

namespace bonemill {

FaultList::Kept* FaultList::find(const std::string& id) {
    const auto kept = std::ranges::find(kept_, id, [](const Kept& k) { return k.condition.id; });
    return kept == kept_.end() ? nullptr : &*kept;
}

void FaultList::begin(Kept& kept, double session_s, Clock::time_point now) {
    if (kept.entry.count++ == 0) kept.entry.first_s = session_s;
    kept.began = now;
}

// What has only happened is over at once; it begins anew when it begins to last.
void FaultList::observe(const std::vector<Condition>& conditions, double session_s, Clock::time_point now) {
    for (Kept& kept : kept_) kept.is_present = false;
    for (const Condition& condition : conditions) {
        Kept* kept = find(condition.id);
        if (!kept && kept_.size() >= kMaxKept) continue;
        if (!kept) kept = &kept_.emplace_back();
        const bool is_new = kept->entry.count == 0 || (condition.lasts && !kept->entry.lasts);
        kept->condition = condition;
        kept->is_present = true;
        if (is_new) begin(*kept, session_s, now);
        if (is_new || condition.lasts) {
            kept->entry.text = condition.text;
            kept->entry.tone = condition.tone;
            kept->entry.last_s = session_s;
            kept->ended = now;
        }
        kept->entry.lasts = condition.lasts;
    }
    for (Kept& kept : kept_)
        if (!kept.is_present) kept.entry.lasts = false;
}

bool FaultList::isSaid(const Kept& kept) {
    return !kept.condition.is_fault || kept.entry.tone != HudTone::kPlain;
}

float FaultList::opacity(const Kept& kept, Clock::time_point now) {
    if (kept.entry.lasts) return 1;
    const Clock::time_point end = std::max(kept.ended, kept.began + kShown);
    const std::chrono::duration<float> left = end + kFade - now, fade = kFade;
    return std::clamp(left / fade, 0.0f, 1.0f);
}

std::vector<HudNotice> FaultList::said(Clock::time_point now) const {
    std::vector<const Kept*> visible;
    for (const Kept& kept : kept_)
        if (isSaid(kept) && opacity(kept, now) > 0) visible.push_back(&kept);
    std::ranges::stable_sort(visible, [](const Kept* a, const Kept* b) {
        return std::pair(a->entry.lasts, a->entry.tone) > std::pair(b->entry.lasts, b->entry.tone);
    });
    std::vector<HudNotice> said;
    const bool are_all = visible.size() <= kMaxShown;
    const size_t in_full = are_all ? visible.size() : kMaxShown - 1;
    for (size_t i = 0; i < in_full; ++i)
        said.push_back({visible[i]->entry.text, visible[i]->entry.tone, opacity(*visible[i], now)});
    if (are_all) return said;
    float most = 0;
    for (size_t i = in_full; i < visible.size(); ++i) most = std::max(most, opacity(*visible[i], now));
    said.push_back({"and " + std::to_string(visible.size() - in_full) + " more, listed in the panel",
                    HudTone::kWarning, most});
    return said;
}

std::vector<FaultEntry> FaultList::faults() const {
    std::vector<FaultEntry> faults;
    for (const Kept& kept : kept_)
        if (kept.condition.is_fault) faults.push_back(kept.entry);
    return faults;
}

}  // namespace bonemill
