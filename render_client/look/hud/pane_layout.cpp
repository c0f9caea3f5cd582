#include "render_client/look/hud/pane_layout.h"

#include <cmath>

namespace bonemill {
namespace {

constexpr HudColour kPaneTextColour{0.93f, 0.95f, 0.97f, 1}, kPaneShadeColour{0, 0, 0, 0.55f};

// Where the text stands: from its left edge, around its middle, up to its right edge.
enum class Align { kFrom, kAround, kUpTo };

void write(HudCanvas& canvas, const std::string& wish, float x, float base, Align align, FontStyle style,
           const HudColour& colour, float most) {
    if (wish.empty()) return;
    const std::string text = canvas.fitted(wish, style, most);
    const float em = canvas.em(), width = canvas.width(text, style);
    const float left = std::round(align == Align::kFrom     ? x
                                  : align == Align::kAround ? x - width / 2
                                                            : x - width);
    canvas.box(left - em * 0.2f, base - em * 0.9f, width + em * 0.4f, em * 1.15f, em * 0.2f,
               kPaneShadeColour);
    canvas.text(left, base, text, style, colour);
}

}  // namespace

void layOutPane(HudCanvas& canvas, const HudPane& pane) {
    const float em = canvas.em(), margin = em * 0.45f, half = pane.width / 2 - em * 1.5f;
    const float left = pane.x + margin, right = pane.x + pane.width - margin;
    const float middle_x = pane.x + pane.width / 2, middle_y = pane.y + pane.height / 2 + em * 0.35f;
    const float first = pane.y + margin + em * 0.8f, last = pane.y + pane.height - margin - em * 0.1f;
    write(canvas, pane.title, left, first, Align::kFrom, FontStyle::kBold, kHudTitleColour, half);
    write(canvas, pane.top, middle_x, first, Align::kAround, FontStyle::kBold, kHudHeadingColour, half);
    write(canvas, pane.bottom, middle_x, last, Align::kAround, FontStyle::kBold, kHudHeadingColour, half);
    write(canvas, pane.left, left, middle_y, Align::kFrom, FontStyle::kBold, kHudHeadingColour, half);
    write(canvas, pane.right, right, middle_y, Align::kUpTo, FontStyle::kBold, kHudHeadingColour, half);
    write(canvas, pane.window, left, last, Align::kFrom, FontStyle::kPlain, kPaneTextColour, half);
    write(canvas, pane.place, right, last, Align::kUpTo, FontStyle::kPlain,
          pane.is_scrolled ? colourOf(HudTone::kWarning) : kPaneTextColour, half);
    write(canvas, pane.problem, middle_x, middle_y + 1.6f * em, Align::kAround, FontStyle::kPlain,
          kPaneTextColour, pane.width - 2 * margin);
}

}  // namespace bonemill
