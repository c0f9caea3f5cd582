#include "render_client/look/hud/hud_layout.h"

#include <algorithm>
#include <cmath>
#include <cstdio>
#include <string>
#include <string_view>

#include "common/base/units.h"
#include "render_client/language/language.h"
#include "render_client/look/hud/figure_text.h"

namespace bonemill {
namespace {

constexpr float kFiguresWidth = 12.5f, kWatchersWidth = 20,
                kWidestBanner = 48;  // of the text within, in units of its height

// These distances are shared by all lists.
struct Spacing {
    explicit Spacing(float em)
        : margin(em * 1.1f), padding(em * 0.9f), line(em * 1.5f), gap(em * 1.4f), rounding(em * 0.6f) {}
    float margin, padding, line, gap, rounding;
};

constexpr float kLockWidth = 0.62f;  // em

// A padlock of boxes, for the font has none; an open one has its shackle pulled out on the right.
void layOutLock(HudCanvas& canvas, float left, float base, bool is_open) {
    const float em = canvas.em(), width = em * kLockWidth, body = em * 0.42f, bar = em * 0.1f;
    const HudColour& colour = colourOf(is_open ? HudTone::kWarning : HudTone::kGood);
    const float top = base - body, leg = em * (is_open ? 0.42f : 0.3f);
    canvas.box(left, top, width, body, em * 0.08f, colour);
    canvas.box(left + bar, top - leg, bar, leg, 0, colour);
    canvas.box(left + bar, top - leg, width - 2 * bar, bar, 0, colour);
    const float right_leg = is_open ? em * 0.2f : leg;
    canvas.box(left + width - 2 * bar, top - leg, bar, right_leg, 0, colour);
}

// Lays out title and state. Returns the base line of the state.
float layOutHead(HudCanvas& canvas, const Hud& hud, float inner) {
    const float em = canvas.em();
    const Spacing space(em);
    const float left = space.margin + space.padding, title = space.margin + space.padding * 0.7f + em;
    canvas.text(left, title, canvas.fitted(hud.title, FontStyle::kBold, inner), FontStyle::kBold,
                kHudTitleColour);
    const float state = title + space.line, dot = em * 0.5f, indent = em * 0.9f;
    if (hud.lock != HudLock::kNone)
        layOutLock(canvas, left + inner - em * kLockWidth, state, hud.lock == HudLock::kOpen);
    canvas.box(left, state - em * 0.55f, dot, dot, dot / 2, colourOf(hud.state_tone));
    const float room = inner - indent - (hud.lock == HudLock::kNone ? 0 : em * (kLockWidth + 0.5f));
    canvas.text(left + indent, state, canvas.fitted(hud.state, FontStyle::kPlain, room), FontStyle::kPlain,
                kHudLabelColour);
    return state;
}

// Labels begin at the left, values end at the right; the first row stands below `base`. A value that is too
// wide is cut short.
void layOutRows(HudCanvas& canvas, const std::vector<HudRow>& rows, float left, float right, float base) {
    const Spacing space(canvas.em());
    for (const HudRow& row : rows) {
        base += space.line;
        canvas.text(left, base, row.label, FontStyle::kPlain, kHudLabelColour);
        const float label =
            row.label.empty() ? 0 : canvas.width(row.label, FontStyle::kPlain) + space.gap / 2;
        const std::string value = canvas.fitted(row.value, FontStyle::kBold, right - left - label);
        canvas.text(right - canvas.width(value, FontStyle::kBold), base, value, FontStyle::kBold,
                    colourOf(row.tone));
    }
}

HudColour faded(HudColour colour, float opacity) {
    colour[3] *= opacity;
    return colour;
}

// The banner stands in the middle above `bottom`, in more than one line where it has to. Returns where it
// begins.
float layOutBanner(HudCanvas& canvas, const HudNotice& notice, FontStyle style, float bottom,
                   float picture_width) {
    constexpr float kUsualSign = 0.6f;  // width, in units of the height
    const float em = canvas.em(), padding = Spacing(em).padding, line = em * 1.4f;
    const float widest = std::min(picture_width - 4 * em, em * kWidestBanner);
    const auto lines = wrappedText(notice.text, size_t(std::max(widest / (em * kUsualSign), 8.0f)));
    float width = 0;
    for (const std::string& text : lines)
        width = std::max(width, std::min(canvas.width(text, style), widest));
    const float height = line * float(lines.size()) + em * 0.6f, top = bottom - height;
    const float left = std::round((picture_width - width) / 2);
    canvas.box(left - padding, top, width + 2 * padding, height, Spacing(em).rounding,
               faded(kHudPanelColour, notice.opacity));
    float base = top + em * 1.35f;
    for (const std::string& text : lines) {
        canvas.text(left, base, canvas.fitted(text, style, widest), style,
                    faded(colourOf(notice.tone), notice.opacity));
        base += line;
    }
    return top;
}

}  // namespace

ScaleBar makeScaleBar(double metres_per_pixel, double max_pixels) {
    const double longest = metres_per_pixel * max_pixels;
    if (!(longest > 0) || !std::isfinite(longest)) return {};
    const double decade = std::pow(10.0, std::floor(std::log10(longest) + 1e-9));
    const double length = decade * (longest >= 5 * decade ? 5 : longest >= 2 * decade ? 2 : 1);
    const double length_mm = length * kPerMillimetre;
    char text[32];
    std::snprintf(text, sizeof text, "%g mm", length_mm);
    return {length, text};
}

HudBox layOutFigures(HudCanvas& canvas, const Hud& hud) {
    // A long title makes it wider, so that one reads which bone it is.
    constexpr float kWidestTitle = 1.8f;  // times as wide as without
    const float em = canvas.em(), usual = em * kFiguresWidth;
    const float inner = std::clamp(canvas.width(hud.title, FontStyle::kBold), usual, kWidestTitle * usual);
    const Spacing space(em);
    const float head = space.line * 2 + em * 0.35f;
    const float body = hud.rows.empty() ? 0 : space.line * float(hud.rows.size()) + em * 0.5f;
    const HudBox box{space.margin, space.margin, space.margin + inner + 2 * space.padding,
                     space.margin + head + body + 1.4f * space.padding};
    canvas.box(box.left, box.top, box.right - box.left, box.bottom - box.top, space.rounding,
               kHudPanelColour);
    const float state = layOutHead(canvas, hud, inner);
    if (hud.rows.empty()) return box;
    const float left = box.left + space.padding;
    canvas.box(left, state + em * 0.65f, inner, 1, 0, kHudLineColour);
    layOutRows(canvas, hud.rows, left, left + inner, state + em * 0.6f);
    return box;
}

HudBox layOutDetails(HudCanvas& canvas, const std::vector<HudRow>& details, const HudBox& figures) {
    const Spacing space(canvas.em());
    const HudBox box{
        figures.left, figures.bottom + canvas.em() * 0.5f, figures.right,
        figures.bottom + canvas.em() * 0.5f + space.line * float(details.size()) + space.padding};
    canvas.box(box.left, box.top, box.right - box.left, box.bottom - box.top, space.rounding,
               kHudPanelColour);
    layOutRows(canvas, details, box.left + space.padding, box.right - space.padding,
               box.top + space.padding * 0.2f);
    return {figures.left, figures.top, figures.right, box.bottom};
}

void layOutModes(HudCanvas& canvas, const std::vector<std::string>& modes, const HudBox& figures) {
    const Spacing space(canvas.em());
    float top = std::max(figures.bottom + canvas.em() * 0.5f, space.margin);
    for (const std::string& mode : modes) {
        const float width = canvas.width(mode, FontStyle::kBold) + 2 * space.padding;
        canvas.box(space.margin, top, width, space.line + space.padding * 0.6f, space.rounding,
                   kHudPanelColour);
        canvas.text(space.margin + space.padding, top + space.line, mode, FontStyle::kBold,
                    colourOf(HudTone::kWarning));
        top += space.line + space.padding;
    }
}

void layOutWatchers(HudCanvas& canvas, const std::vector<HudRow>& watchers, const HudBox& figures,
                    const PictureSize& picture) {
    const float em = canvas.em(), picture_width = float(picture.width), inner = em * kWatchersWidth;
    const Spacing space(em);
    const bool fits_beside = picture_width - 2 * space.margin - inner - 2 * space.padding > figures.right;
    const float left =
        fits_beside ? picture_width - space.margin - space.padding - inner : space.margin + space.padding;
    const float right = left + inner, top = fits_beside ? space.margin : figures.bottom + em * 0.6f;
    canvas.box(left - space.padding, top, inner + 2 * space.padding,
               space.line * float(watchers.size() + 1) + space.padding, space.rounding, kHudPanelColour);
    float base = top + space.padding * 0.7f + em;
    canvas.text(left, base, tr("Watching"), FontStyle::kBold, kHudTitleColour);
    for (const HudRow& row : watchers) {
        base += space.line;
        const std::string value = canvas.fitted(row.value, FontStyle::kPlain, inner * 0.75f);
        const float value_width = canvas.width(value, FontStyle::kPlain);
        canvas.text(left, base, canvas.fitted(row.label, FontStyle::kPlain, inner - value_width - space.gap),
                    FontStyle::kPlain, kHudTitleColour);
        canvas.text(right - value_width, base, value, FontStyle::kPlain,
                    row.tone == HudTone::kPlain ? kHudLabelColour : colourOf(row.tone));
    }
}

void layOutScaleBar(HudCanvas& canvas, const ScaleBar& bar, double metres_per_pixel,
                    const PictureSize& picture) {
    if (bar.length <= 0) return;
    const float em = canvas.em(), pixels = float(bar.length / metres_per_pixel);
    const float right = float(picture.width) - em * 1.6f, base = float(picture.height) - em * 1.6f;
    const float thick = std::max(2.0f, em / 8), label_width = canvas.width(bar.label, FontStyle::kPlain);
    canvas.box(right - pixels, base, pixels, thick, 0, kHudScaleColour);
    canvas.box(right - pixels, base - em * 0.35f, thick, em * 0.35f, 0, kHudScaleColour);
    canvas.box(right - thick, base - em * 0.35f, thick, em * 0.35f, 0, kHudScaleColour);
    canvas.text(right - (pixels + label_width) / 2, base - em * 0.6f, bar.label, FontStyle::kPlain,
                kHudScaleColour);
}

void layOutLegend(HudCanvas& canvas, const HudLegend& legend, const PictureSize& picture) {
    constexpr int kSteps = 24;  // between two colours
    const float em = canvas.em(), wide = em * 13, gap = em * 0.5f;
    const float left = float(picture.width) - em * 2.1f - wide, top = float(picture.height) - em * 6.4f;
    canvas.box(left - gap, top - em * 1.5f, wide + 2 * gap, em * 3.9f, em * 0.4f, kHudPanelColour);
    canvas.text(left, top - em * 0.45f, canvas.fitted(legend.title, FontStyle::kBold, wide), FontStyle::kBold,
                kHudTitleColour);
    const size_t spans = legend.colours.size() - 1;
    const float step = wide / float(kSteps * spans);
    for (size_t n = 0; n < kSteps * spans; ++n) {
        const size_t low = n / kSteps;
        const float share = float(n % kSteps) / kSteps;
        HudColour colour{0, 0, 0, 1};
        for (size_t i = 0; i < 3; ++i)
            colour[i] =
                legend.colours[low][i] + share * (legend.colours[low + 1][i] - legend.colours[low][i]);
        canvas.box(left + step * float(n), top, wide - step * float(n), em * 0.7f, 0, colour);
    }
    const float base = top + em * 1.8f;
    canvas.text(left, base, legend.low, FontStyle::kPlain, kHudScaleColour);
    canvas.text(left + wide - canvas.width(legend.high, FontStyle::kPlain), base, legend.high,
                FontStyle::kPlain, kHudScaleColour);
}

void layOutPage(HudCanvas& canvas, const HudPage& page, const PictureSize& picture) {
    const float em = canvas.em(), widest = float(picture.width) - 4 * em;
    const Spacing space(em);
    float text = canvas.width(page.title, FontStyle::kBold);
    for (const std::string& line : page.lines) text = std::max(text, canvas.width(line, FontStyle::kPlain));
    text = std::min(text, widest);
    const size_t lines = 2 + page.rows.size() + page.lines.size();
    const float width = text + 2 * space.padding, height = space.line * float(lines) + space.padding;
    const float left = std::round((float(picture.width) - width) / 2),
                top = std::round((float(picture.height) - height) / 2);
    canvas.box(left, top, width, height, space.rounding, kHudPanelColour);
    const float x = left + space.padding;
    float base = top + space.padding * 0.4f + space.line;
    canvas.text(x, base, page.title, FontStyle::kBold, colourOf(HudTone::kWarning));
    for (const HudRow& row : page.rows) {
        base += space.line;
        canvas.text(x, base, row.label, FontStyle::kPlain, kHudLabelColour);
        canvas.text(x + em * 6, base, row.value, FontStyle::kBold, colourOf(row.tone));
    }
    base += space.line * 0.5f;
    for (const std::string& line : page.lines) {
        base += space.line;
        canvas.text(x, base, canvas.fitted(line, FontStyle::kPlain, text), FontStyle::kPlain,
                    kHudLabelColour);
    }
}

void layOutHint(HudCanvas& canvas, const HudHint& hint, const HudBox& figures, const PictureSize& picture) {
    const float em = canvas.em();
    const Spacing space(em);
    float labels = 0, values = 0;
    for (const HudRow& row : hint.rows) {
        labels = std::max(labels, canvas.width(row.label, FontStyle::kBold));
        values = std::max(values, canvas.width(row.value, FontStyle::kPlain));
    }
    const float height = space.line * float(hint.rows.size()) + space.padding;
    const float top = float(picture.height) - space.margin - height;
    const float edge = top > figures.bottom ? space.margin : figures.right + em * 0.6f;
    const float left = edge + space.padding;
    canvas.box(edge, top, labels + space.gap + values + 2 * space.padding, height, space.rounding,
               faded(kHudPanelColour, hint.opacity));
    float base = top + space.padding * 0.2f;
    for (const HudRow& row : hint.rows) {
        base += space.line;
        canvas.text(left, base, row.label, FontStyle::kBold, faded(kHudTitleColour, hint.opacity));
        canvas.text(left + labels + space.gap, base, row.value, FontStyle::kPlain,
                    faded(kHudLabelColour, hint.opacity));
    }
}

void layOutNotice(HudCanvas& canvas, const HudNotice& notice, const PictureSize& picture) {
    layOutBanner(canvas, notice, FontStyle::kBold, float(picture.height) - canvas.em() * 1.1f,
                 float(picture.width));
}

void layOutAlert(HudCanvas& canvas, const HudNotice& alert, const PictureSize& picture) {
    const float em = canvas.em(), width = float(picture.width), height = float(picture.height);
    const float thick = std::max(3.0f, em * 0.2f);
    HudColour colour = colourOf(alert.tone);
    colour[3] = 0.85f;
    canvas.box(0, 0, width, thick, 0, colour);
    canvas.box(0, height - thick, width, thick, 0, colour);
    canvas.box(0, thick, thick, height - 2 * thick, 0, colour);
    canvas.box(width - thick, thick, thick, height - 2 * thick, 0, colour);
    layOutBanner(canvas, alert, FontStyle::kBold, height - em * 3.9f, width);
}

void layOutMessages(HudCanvas& canvas, const std::vector<HudNotice>& messages, const PictureSize& picture) {
    const float em = canvas.em();
    float bottom = float(picture.height) - em * 7.6f;
    for (auto message = messages.rbegin(); message != messages.rend(); ++message)
        bottom = layOutBanner(canvas, *message, FontStyle::kPlain, bottom, float(picture.width)) - em * 0.4f;
}

void layOutLabel(HudCanvas& canvas, const HudLabel& label) {
    const float em = canvas.em(), text_width = canvas.width(label.text, FontStyle::kBold);
    const float padding = em * 0.45f, left = std::round(label.x) + em * 1.7f;
    const float top = std::round(label.y) - em * 0.75f;
    canvas.box(left - padding, top, text_width + 2 * padding, em * 1.5f, em * 0.4f, kHudPanelColour);
    canvas.text(left, top + em * 1.08f, label.text, FontStyle::kBold,
                label.is_of_pointer ? kHudPointerNameColour : kHudTitleColour);
}

}  // namespace bonemill
