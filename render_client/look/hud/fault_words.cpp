#include "render_client/look/hud/fault_words.h"

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
    {"overrun", "The computer was too slow for a moment: a tick took longer than its period.",
     HudTone::kWarning},
    {"stale_device",
     "The hand was not heard of for a moment: the device sent nothing, and the force went to zero.",
     HudTone::kAlarm},
    {"bad_device_pose", "The hand was not heard of for a moment: the device sent a pose that is none.",
     HudTone::kAlarm},
    {"solve", "The force faded for a moment: no balance of forces was found.", HudTone::kAlarm},
    {"motion_clamped", "The tool moved no faster than its limit.", HudTone::kPlain},
    {"force_clamped", "The force was kept within the hand's limit.", HudTone::kPlain},
    {"shell_overflow", "Some milled surface is not felt: there is no room for its contact points.",
     HudTone::kWarning},
    {"contact_overflow",
     "The computer was too slow for a moment: more contact points were near the tool than there was time "
     "for.",
     HudTone::kWarning},
    {"milling_cut_short", "Milling came a moment late: there was more to mill than a tick has time for.",
     HudTone::kPlain},
    {"coarser_shell", "A little less detail is felt: a tick has no time for more contact points.",
     HudTone::kPlain},
    {"volume_full", "There is no memory for more milled bone: some was not milled.", HudTone::kAlarm},
    {"stalled", "Nothing to worry about: forces were out of balance for a tick.", HudTone::kPlain},
    {"implausible_device", "The device said what cannot be: it was refused.", HudTone::kAlarm},
    {"early_samples", "The device is faster than the loop: a tick was held back.", HudTone::kPlain},
    {"fewer_samples", "A little less detail is felt: there was no time to sample the contact more finely.",
     HudTone::kPlain},
    {"not_recorded", "Not all of the session is recorded: the server's disk is full or slow.",
     HudTone::kAlarm},
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
