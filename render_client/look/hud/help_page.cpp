#include "render_client/look/hud/help_page.h"

#include <algorithm>
#include <cmath>

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

}  // namespace bonemill
