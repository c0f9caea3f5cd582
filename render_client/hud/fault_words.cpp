#include "render_client/hud/fault_words.h"

#include <algorithm>
#include <iterator>
#include <sstream>

namespace bonemill {
namespace {

constexpr struct {
    const char* name;
    const char* text;
    HudTone tone;
} kWords[] = {
    {"overrun", "A tick took longer than its period: the PC is too slow for this scene, or too busy.",
     HudTone::kWarning},
    {"stale_device", "The device sent nothing for a while: the force went to zero.", HudTone::kAlarm},
    {"bad_device_pose", "The device sent a pose that is none: the last good one was kept.", HudTone::kAlarm},
    {"solve", "No balance of forces was found: the force faded.", HudTone::kAlarm},
    {"motion_clamped", "The tool moved no faster than its limit.", HudTone::kPlain},
    {"force_clamped", "The force was kept within the hand's limit.", HudTone::kPlain},
    {"shell_overflow", "Some milled surface is not felt: there is no room for its contact points.",
     HudTone::kWarning},
    {"contact_overflow", "More contact points were near the tool than there was time for.",
     HudTone::kWarning},
    {"milling_cut_short", "There was more to mill than a tick has time for: the rest came later.",
     HudTone::kPlain},
    {"coarser_shell", "The contact has fewer points than asked for: a tick has no time for more.",
     HudTone::kPlain},
    {"volume_full", "There is no memory for more milled bone: some was not milled.", HudTone::kAlarm},
    {"stalled", "Forces were out of balance for a tick.", HudTone::kPlain},
    {"implausible_device", "The device said what cannot be: it was refused.", HudTone::kAlarm},
    {"early_samples", "The device is faster than the loop: a tick was held back.", HudTone::kPlain},
    {"fewer_samples", "The contact is sampled less finely than asked for: there was no time.",
     HudTone::kPlain},
};

FaultWords wordsOf(const std::string& name) {
    const auto known = std::ranges::find_if(kWords, [&](const auto& words) { return words.name == name; });
    if (known != std::end(kWords)) return {name, known->text, known->tone};
    return {name, "The server reports: " + name + ".", HudTone::kWarning};
}

}  // namespace

std::vector<FaultWords> faultWords(const std::string& names) {
    std::vector<FaultWords> faults;
    std::istringstream words(names);
    for (std::string name; words >> name;) {
        while (name.ends_with(',')) name.pop_back();
        if (name.empty() || std::ranges::find(faults, name, &FaultWords::name) != faults.end()) continue;
        faults.push_back(wordsOf(name));
    }
    return faults;
}

}  // namespace bonemill
