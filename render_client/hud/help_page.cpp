#include "render_client/hud/help_page.h"

#include <algorithm>
#include <cmath>

namespace bonemill {
namespace {

constexpr float kPadding = 1.4f, kLine = 1.7f, kGap = 2;  // in units of the text's height
constexpr float kSmallestText = 7;                        // pixels: what can just be read

struct Column {
    size_t first, end;     // rows
    float keys, meanings;  // pixels, widths
};

size_t rowsPerColumn(size_t rows, float em, int picture_height) {
    const float room = std::max(float(picture_height) - 2 * em * kPadding - em, em * kLine);
    const auto columns = size_t(std::ceil(em * kLine * float(rows) / room));
    return (rows + columns - 1) / columns;
}

std::vector<Column> columnsOf(const FontAtlas& font, const std::vector<HudRow>& rows, size_t per_column) {
    std::vector<Column> columns;
    for (size_t first = 0; first < rows.size(); first += per_column) {
        Column column{first, std::min(first + per_column, rows.size()), 0, 0};
        for (size_t i = first; i < column.end; ++i) {
            column.keys = std::max(column.keys, font.width(rows[i].label, FontStyle::kBold));
            column.meanings = std::max(column.meanings, font.width(rows[i].value, FontStyle::kPlain));
        }
        columns.push_back(column);
    }
    return columns;
}

float pageWidth(const std::vector<Column>& columns, float em) {
    float width = em * (2 * kPadding - kGap);
    for (const Column& column : columns) width += column.keys + column.meanings + 2 * em * kGap;
    return width;
}

}  // namespace

// Widths grow with the height of the text; that is near enough.
float helpTextHeight(const FontAtlas& font, const std::vector<HudRow>& rows, const PictureSize& picture) {
    const float usual = font.pixelHeight();
    float em = usual;
    while (em > kSmallestText) {
        const auto columns = columnsOf(font, rows, rowsPerColumn(rows.size(), em, picture.height));
        if (pageWidth(columns, usual) * em / usual <= float(picture.width) - em) break;
        em = std::max(em - 1, kSmallestText);
    }
    return em;
}

void layOutHelp(HudCanvas& canvas, const std::vector<HudRow>& rows, const PictureSize& picture) {
    const float em = canvas.em(), padding = em * kPadding, line = em * kLine, gap = em * kGap;
    const size_t per_column = rowsPerColumn(rows.size(), em, picture.height);
    const std::vector<Column> columns = columnsOf(canvas.font(), rows, per_column);
    const float width = pageWidth(columns, em), height = line * float(per_column) + 2 * padding - em * 0.5f;
    const float left = std::round((float(picture.width) - width) / 2),
                top = std::round((float(picture.height) - height) / 2);
    HudColour backing = kHudPanelColour;
    backing[3] = 0.86f;
    canvas.box(left, top, width, height, em * 0.6f, backing);
    float x = left + padding;
    for (const Column& column : columns) {
        float base = top + padding + em * 0.85f;
        for (size_t i = column.first; i < column.end; ++i, base += line) {
            canvas.text(x, base, rows[i].label, FontStyle::kBold, kHudTitleColour);
            canvas.text(x + column.keys + gap, base, rows[i].value, FontStyle::kPlain, kHudLabelColour);
        }
        x += column.keys + column.meanings + 2 * gap;
    }
}

}  // namespace bonemill
