// Draws the head-up display, the scale bar and the help page over the finished picture.
//
// Thread: the one of the context. Pixels count from the upper left corner.
#pragma once

#include <map>
#include <memory>
#include <vector>

#include "render_client/gl/gl_object.h"
#include "render_client/gl/program.h"
#include "render_client/hud/hud.h"
#include "render_client/paint/font_atlas.h"

namespace bonemill {

class HudPainter {
  public:
    explicit HudPainter(const GlApi& gl);

    // Into the bound framebuffer. ui_scale 1 suits a picture 800 pixels high.
    void paint(const Hud& hud, const ScaleBar& scale_bar, double metres_per_pixel, int width, int height,
               float ui_scale);

    // The alert alone, over a picture without figures.
    void paintAlert(const HudNotice& alert, int width, int height, float ui_scale);

    // Names beside points of the picture.
    void paintLabels(const std::vector<HudLabel>& labels, int width, int height, float ui_scale);

  private:
    struct Vertex {
        float x, y, u, v;
        float r, g, b, a;
        float half_width, half_height, radius;
    };
    using Colour = std::array<float, 4>;

    void box(float x, float y, float width, float height, float radius, const Colour& colour);
    void quad(const std::array<float, 4>& rectangle, const std::array<float, 4>& uv, const Colour& colour,
              const std::array<float, 3>& shape);
    // Returns the pen's x after the text; y is the base line.
    float text(float x, float y, std::string_view utf8, FontStyle style, const Colour& colour);
    void begin(float ui_scale);
    void useFont(float em);
    struct Corner {
        float right, bottom;
    };
    Corner layOutPanel(const Hud& hud);  // its lower right corner
    void layOutWatchers(const std::vector<HudRow>& watchers, const Corner& panel, int width);
    void layOutLabel(const HudLabel& label);
    void layOutScaleBar(const ScaleBar& bar, double metres_per_pixel, int width, int height);
    // In as many columns as the picture's height needs, in smaller text where they are too wide.
    struct HelpColumn {
        size_t first, end;     // rows
        float keys, meanings;  // pixels, widths
    };
    std::vector<HelpColumn> helpColumns(const std::vector<HudRow>& rows, size_t per_column) const;
    size_t helpRowsPerColumn(size_t rows, float em, int height) const;
    float helpWidth(const std::vector<HelpColumn>& columns) const;
    float helpTextHeight(const std::vector<HudRow>& rows, int width, int height) const;
    void layOutHelp(const std::vector<HudRow>& rows, int width, int height);
    void layOutNotice(const HudNotice& notice, int width, int height);
    void layOutAlert(const HudNotice& alert, int width, int height);
    void layOutBanner(const HudNotice& notice, float bottom, int width);
    void flush(int width, int height);
    static Colour colourOf(HudTone tone);

    const GlApi& gl_;
    Program program_;
    GlVertexArray layout_;
    GlBuffer buffer_;
    std::map<float, std::unique_ptr<FontAtlas>> fonts_;  // by height, pixels
    const FontAtlas* font_ = nullptr;                    // the one in use
    std::vector<Vertex> vertices_;
    float em_ = 14;  // pixels: height of the font, unit of the layout
};

}  // namespace bonemill
