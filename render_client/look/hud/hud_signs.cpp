#include "render_client/look/hud/hud_signs.h"

#include <algorithm>
#include <cmath>
#include <string_view>

namespace bonemill {
namespace {

constexpr float kPadding = 1.4f, kLine = 1.5f, kGap = 1.2f;  // in units of the text's height
constexpr float kSmallestText = 7;                           // pixels: what can just be read

// Titles have no value; a line between two groups has neither.
using Lines = std::vector<HudRow>;

struct Column {
    Lines lines;
    float keys = 0, meanings = 0;  // pixels, widths
};

// A group begins a new column where its rest would not fit, unless it fits into none.
std::vector<Lines> splitLines(const std::vector<HelpGroup>& groups, size_t most) {
    std::vector<Lines> columns(1);
    for (const HelpGroup& group : groups) {
        const bool has_gap = !columns.back().empty();
        const size_t needed = columns.back().size() + has_gap + 1 + group.rows.size();
        if (has_gap && needed > most) {
            columns.emplace_back();
        } else if (has_gap) {
            columns.back().push_back({});
        }
        columns.back().push_back({group.title, ""});
        for (const HudRow& row : group.rows) {
            if (columns.back().size() >= most) columns.emplace_back();
            columns.back().push_back(row);
        }
    }
    return columns;
}

size_t longestOf(const std::vector<Lines>& columns) {
    size_t longest = 0;
    for (const Lines& lines : columns) longest = std::max(longest, lines.size());
    return longest;
}

// The columns are as equal as their number allows.
std::vector<Lines> balancedLines(const std::vector<HelpGroup>& groups, float em, int picture_height) {
    const float room = std::max(float(picture_height) - 2 * em * kPadding - em, em * kLine);
    auto columns = splitLines(groups, std::max(size_t(room / (em * kLine)), size_t(2)));
    for (size_t most = longestOf(columns); most-- > 2;) {
        auto lower = splitLines(groups, most);
        if (lower.size() > columns.size()) break;
        columns = std::move(lower);
    }
    return columns;
}

std::vector<Column> columnsOf(const FontAtlas& font, std::vector<Lines> lines) {
    std::vector<Column> columns;
    for (Lines& of_column : lines) {
        Column& column = columns.emplace_back();
        for (const HudRow& row : of_column) {
            column.keys = std::max(column.keys, font.width(row.label, FontStyle::kBold));
            column.meanings = std::max(column.meanings, font.width(row.value, FontStyle::kPlain));
        }
        column.lines = std::move(of_column);
    }
    return columns;
}

float pageWidth(const std::vector<Column>& columns, float em) {
    float width = em * (2 * kPadding - kGap);
    for (const Column& column : columns) width += column.keys + column.meanings + 2 * em * kGap;
    return width;
}

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

constexpr float kArm = 2.9f;          // from the middle to a letter's, in units of the text's height
constexpr float kReach = 3.6f;        // and to the marker's rim
constexpr float kAboveCorner = 5.2f;  // from the marker's lower end to the picture's: room for the scale bar
constexpr float kFromEdge = 1.2f;
constexpr float kMinPicture = 30;  // text heights, in both directions
constexpr float kThickArm = 0.2f, kThinArm = 0.11f;
constexpr float kFaintest = 0.35f;    // opacity of what points away from the eye
constexpr float kNearestPair = 1.0f;  // a letter this near to one before it is not written

// Lines and letters have a dark rim, so that they are seen before bright bone too.
constexpr HudColour kRimColour{0.03f, 0.045f, 0.06f, 0.8f};
constexpr float kRim = 1;  // pixel
constexpr HudColour kAxisColours[] = {
    {1.0f, 0.55f, 0.50f, 1}, {0.55f, 0.90f, 0.55f, 1}, {0.58f, 0.76f, 1.0f, 1}};

// W is LPS: x to the patient's left, y to the back (posterior), z to the head (superior).
constexpr std::string_view kPatientsPositive = "LPS", kPatientsNegative = "RAI", kVolumes = "xyz";

HudColour colourOf(const OrientationEnd& end) {
    HudColour colour = kAxisColours[end.axis];
    colour[3] = kFaintest + (1 - kFaintest) * (end.nearness + 1) / 2;
    return colour;
}

void addLetter(HudCanvas& canvas, char letter, float x, float y, const HudColour& colour) {
    const std::string_view text(&letter, 1);
    const float left = x - canvas.width(text, FontStyle::kBold) / 2, base = y + 0.36f * canvas.em();
    canvas.text(left + kRim, base + kRim, text, FontStyle::kBold, kRimColour);
    canvas.text(left - kRim, base - kRim, text, FontStyle::kBold, kRimColour);
    canvas.text(left, base, text, FontStyle::kBold, colour);
}

}  // namespace

std::vector<HelpGroup> helpThatFits(const FontAtlas& font, std::vector<HelpGroup> groups,
                                    const PictureSize& picture) {
    const auto fits = [&] {
        const auto columns = columnsOf(font, balancedLines(groups, kSmallestText, picture.height));
        return pageWidth(columns, font.pixelHeight()) * kSmallestText / font.pixelHeight() <=
               float(picture.width) - kSmallestText;
    };
    while (groups.size() > 1 && !fits()) groups.pop_back();
    return groups;
}

// Widths grow with the height of the text; that is near enough.
float helpTextHeight(const FontAtlas& font, const std::vector<HelpGroup>& groups,
                     const PictureSize& picture) {
    const float usual = font.pixelHeight();
    float em = usual;
    while (em > kSmallestText) {
        const auto columns = columnsOf(font, balancedLines(groups, em, picture.height));
        if (pageWidth(columns, usual) * em / usual <= float(picture.width) - em) break;
        em = std::max(em - 1, kSmallestText);
    }
    return em;
}

void layOutHelp(HudCanvas& canvas, const std::vector<HelpGroup>& groups, const PictureSize& picture) {
    const float em = canvas.em(), padding = em * kPadding, line = em * kLine, gap = em * kGap;
    const auto lines = balancedLines(groups, em, picture.height);
    const std::vector<Column> columns = columnsOf(canvas.font(), lines);
    const float width = pageWidth(columns, em),
                height = line * float(longestOf(lines)) + 2 * padding - em * 0.5f;
    const float left = std::round((float(picture.width) - width) / 2),
                top = std::round((float(picture.height) - height) / 2);
    HudColour backing = kHudPanelColour;
    backing[3] = 0.86f;
    canvas.box(left, top, width, height, em * 0.6f, backing);
    float x = left + padding;
    for (const Column& column : columns) {
        float base = top + padding + em * 0.85f;
        for (const HudRow& row : column.lines) {
            const bool is_title = row.value.empty();
            canvas.text(x, base, row.label, FontStyle::kBold, is_title ? kHudHeadingColour : kHudTitleColour);
            canvas.text(x + column.keys + gap, base, row.value, FontStyle::kPlain, kHudLabelColour);
            base += line;
        }
        x += column.keys + column.meanings + 2 * gap;
    }
}

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

std::vector<OrientationEnd> orientationEnds(const OrientationAxes& axes) {
    std::vector<OrientationEnd> ends;
    for (int axis = 0; axis < 3; ++axis) {
        const Eigen::Vector3f along = axes.R_CA.col(axis);
        const auto n = size_t(axis);
        ends.push_back(
            {axes.are_patients ? kPatientsPositive[n] : kVolumes[n], axis, true, along.head<2>(), along.z()});
        if (axes.are_patients)
            ends.push_back({kPatientsNegative[n], axis, false, -along.head<2>(), -along.z()});
    }
    std::ranges::stable_sort(ends, {}, &OrientationEnd::nearness);
    return ends;
}

void layOutOrientation(HudCanvas& canvas, const OrientationAxes& axes, const PictureSize& picture) {
    const float em = canvas.em();
    const auto width = float(picture.width), height = float(picture.height);
    if (std::min(width, height) < kMinPicture * em) return;
    const Eigen::Vector2f middle(width - (kFromEdge + kReach) * em, height - (kAboveCorner + kReach) * em);
    const std::vector<OrientationEnd> ends = orientationEnds(axes);
    const auto placeOf = [&](const OrientationEnd& end) -> Eigen::Vector2f {
        return middle + kArm * em * Eigen::Vector2f(end.towards.x(), -end.towards.y());
    };
    for (size_t n = 0; n < ends.size(); ++n) {
        const OrientationEnd& end = ends[n];
        const Eigen::Vector2f place = placeOf(end);
        const float letter_part = std::max(1 - 0.75f / (kArm * std::max(end.towards.norm(), 0.01f)), 0.0f);
        const Eigen::Vector2f tip = middle + letter_part * (place - middle);
        const float thickness = (end.is_positive ? kThickArm : kThinArm) * em;
        canvas.line(middle, tip, thickness + 2 * kRim, kRimColour);
        canvas.line(middle, tip, thickness, colourOf(end));
        const bool is_covered =
            std::any_of(ends.begin() + ptrdiff_t(n) + 1, ends.end(),
                        [&](const auto& near) { return (placeOf(near) - place).norm() < kNearestPair * em; });
        if (!is_covered) addLetter(canvas, end.letter, place.x(), place.y(), colourOf(end));
    }
}

}  // namespace bonemill
