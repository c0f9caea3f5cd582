#include "render_client/look/hud/palette.h"

#include <iterator>

namespace bonemill {
namespace {

constexpr Palette kUsual{
    .tones = {{{0.95, 0.96, 0.97}, {0.45, 0.88, 0.55}, {1.0, 0.76, 0.30}, {1.0, 0.42, 0.38}}},
    .named = {{{0.95, 0.85, 0.20}, {0.10, 0.45, 0.85}, {0.84, 0.17, 0.12}, {0.82, 0.64, 0.96}}},
    .structures = {{{0.90, 0.62, 0.00},
                    {0.34, 0.71, 0.91},
                    {0.00, 0.62, 0.45},
                    {0.80, 0.47, 0.65},
                    {0.84, 0.37, 0.00},
                    {0.00, 0.45, 0.70}}},
    .distance = {{{0.95, 0.10, 0.08}, {1.0, 0.85, 0.10}, {0.20, 0.80, 0.35}}},
    .zones = {{kZoneColours[0].colour, kZoneColours[1].colour, kZoneColours[2].colour, kZoneColours[3].colour,
               kZoneColours[4].colour, kOtherZone}},
    .differences = kDifferenceColours};

constexpr Palette kColourBlind{
    .tones = {{{0.95, 0.96, 0.97}, {0.30, 0.65, 0.95}, {0.98, 0.74, 0.05}, {0.90, 0.32, 0.22}}},
    .named = {{{0.98, 1.0, 0.10}, {0.07, 0.19, 0.91}, {0.71, 0.01, 0.0}, {1.0, 0.72, 0.74}}},
    .structures = {{{0.95, 0.55, 0.10},
                    {0.16, 0.82, 1.0},
                    {0.29, 0.58, 0.36},
                    {0.53, 0.41, 0.53},
                    {0.40, 0.04, 0.44},
                    {0.19, 0.21, 0.18}}},
    .distance = {{{0.78, 0.18, 0.02}, {1.0, 0.88, 0.25}, {0.25, 0.60, 1.0}}},
    .zones = {{{0.45, 0.79, 0.97},
               {0.85, 0.85, 0.60},
               {1.0, 0.62, 0.06},
               {0.70, 0.12, 0.0},
               {0.21, 0.0, 0.11},
               {0.0, 0.28, 0.65}}},
    .differences = {{{0.0, 0.33, 0.62}, {1.0, 0.63, 0.06}, {0.62, 0.95, 0.86}}}};

const Palette* in_use = &kUsual;

// Puts in the colour of the same place in `to`, where it is one of `from`.
template <size_t kCount>
void exchange(const std::array<Srgb, kCount>& from, const std::array<Srgb, kCount>& to,
              scene::Color& colour) {
    const Srgb given{colour.red(), colour.green(), colour.blue()};
    for (size_t n = 0; n < kCount; ++n) {
        if (from[n] != given) continue;
        colour.set_red(to[n][0]);
        colour.set_green(to[n][1]);
        colour.set_blue(to[n][2]);
        return;
    }
}

}  // namespace

const Palette& usualPalette() {
    return kUsual;
}

const Palette& colourBlindPalette() {
    return kColourBlind;
}

void usePalette(bool is_for_colour_blind) {
    in_use = is_for_colour_blind ? &kColourBlind : &kUsual;
}

const Palette& palette() {
    return *in_use;
}

scene::Color shownColour(const scene::Color& colour) {
    scene::Color shown = colour;
    if (in_use == &kUsual) return shown;
    exchange(kUsual.zones, in_use->zones, shown);
    exchange(kUsual.differences, in_use->differences, shown);
    return shown;
}

}  // namespace bonemill
