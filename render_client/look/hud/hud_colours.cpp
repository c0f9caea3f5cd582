#include "render_client/look/hud/hud_colours.h"

namespace bonemill {

HudColour colourOf(HudTone tone) {
    switch (tone) {
        case HudTone::kGood:
            return {0.45f, 0.88f, 0.55f, 1};
        case HudTone::kWarning:
            return {1.0f, 0.76f, 0.30f, 1};
        case HudTone::kAlarm:
            return {1.0f, 0.42f, 0.38f, 1};
        case HudTone::kPlain:
            break;
    }
    return {0.95f, 0.96f, 0.97f, 1};
}

}  // namespace bonemill
