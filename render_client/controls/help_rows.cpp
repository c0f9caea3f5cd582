#include "render_client/controls/help_rows.h"

#include <string>

#include "render_client/controls/key_table.h"

namespace bonemill {
namespace {

// This is what ViewerControls makes of the mouse.
const HudRow kMouse[] = {{"Left drag", "orbit"},
                         {"Right drag, Shift+left drag", "pan"},
                         {"Wheel", "zoom"},
                         {"Double click", "orbit around that point"},
                         {"Ctrl+left drag", "point (instructor)"}};

template <class Bindings>
void addKeys(const Bindings& bindings, std::vector<HudRow>& rows) {
    std::string last;
    for (const auto& binding : bindings) {
        const std::string meaning = meaningOf(binding);
        if (meaning == last) {
            rows.back().label += " " + std::string(binding.label);
        } else {
            rows.push_back({std::string(binding.label), meaning});
        }
        last = meaning;
    }
}

}  // namespace

std::vector<HudRow> helpRows() {
    std::vector<HudRow> rows(std::begin(kMouse), std::end(kMouse));
    addKeys(keyTable(), rows);
    addKeys(signTable(), rows);
    return rows;
}

}  // namespace bonemill
