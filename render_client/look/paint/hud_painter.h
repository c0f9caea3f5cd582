// Draws what the head-up display says over the finished picture.
//
// It belongs to the thread of the context.
#pragma once

#include <map>
#include <vector>

#include "render_client/look/gl/gl_api.h"
#include "render_client/look/hud/hud_layout.h"
#include "render_client/look/hud/hud_signs.h"

namespace bonemill {

class HudPainter {
  public:
    explicit HudPainter(const GlApi& gl);

    // Draws figures, lists, scale bar and help page into the bound framebuffer. ui_scale 1 suits a
    // picture 800 pixels high.
    void paint(const Hud& hud, const ScaleBar& scale_bar, double metres_per_pixel, const PictureSize& picture,
               float ui_scale);

    // Draws the alert alone, over a picture without figures.
    void paintAlert(const HudNotice& alert, const PictureSize& picture, float ui_scale);

    // Draws names beside points of the picture.
    void paintLabels(const std::vector<HudLabel>& labels, const PictureSize& picture, float ui_scale);

    // Writes on the panes with slices through the scan.
    void paintPanes(const std::vector<HudPane>& panes, const PictureSize& picture, float ui_scale);

  private:
    struct Font {
        Font(const GlApi& gl, float pixel_height);
        FontAtlas atlas;
        GlTexture texture;
    };
    const FontAtlas& usualFont(float ui_scale);
    const Font& fontOf(float pixel_height);
    void draw(const HudCanvas& canvas, const PictureSize& picture);

    const GlApi& gl_;
    Program program_;
    GlVertexArray layout_;
    GlBuffer buffer_;
    std::map<float, Font> fonts_;  // by height, pixels
};

}  // namespace bonemill
