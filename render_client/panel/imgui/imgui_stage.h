// Dear ImGui in our windows: its context, and how it is drawn. It belongs to the render thread.
#pragma once

#include <functional>
#include <map>
#include <memory>
#include <string>

#include "render_client/hand/controls/window_event.h"
#include "render_client/look/gl/gl_api.h"

struct ImDrawData;
struct ImGuiContext;

namespace bonemill {

// A context of Dear ImGui with our font and look, fed with the events of a window.
//
// It needs no OpenGL; ImGuiPainter draws what it has. Positions are pixels from the picture's upper left
// corner.
class ImGuiStage {
  public:
    // Throws UserError (font).
    ImGuiStage();
    ImGuiStage(const ImGuiStage&) = delete;
    ImGuiStage& operator=(const ImGuiStage&) = delete;
    ~ImGuiStage();

    // Every call of ImGui is for this one from now on.
    void makeCurrent() const;
    // Takes the size (pixels) of the picture to come, and how much larger than usual its text is.
    void setPicture(int width, int height, float scale);
    void feed(const WindowEvent& event);
    // What is copied and pasted goes through these; without them it stays within this context.
    void useClipboard(std::function<std::string()> read, std::function<void(const std::string&)> write);
    // From now on arrows go from control to control, and Enter presses them.
    void goByKeys();
    // Forgets what was scrolled and typed and no widget asked for.
    void dropInput();
    // The controls are built between these two. `seconds` have gone by since the last ones.
    void begin(double seconds);
    void end();

    float scale() const { return scale_; }
    // Returns what to draw; it is valid until the next begin().
    const ImDrawData* drawData() const;
    // The font's pixels have 8 bits each; the number changes with them.
    struct FontPixels {
        const unsigned char* pixels;
        int width;
        int height;
        int version;
    };
    FontPixels fontPixels() const;

  private:
    struct Destroy {
        void operator()(ImGuiContext* context) const;
    };
    void setScale(float scale);

    struct Clipboard {
        std::function<std::string()> read;
        std::function<void(const std::string&)> write;
        std::string text;  // that was read last
    };
    std::unique_ptr<ImGuiContext, Destroy> context_;
    std::unique_ptr<Clipboard> clipboard_;
    float scale_ = 0;
    int font_version_ = 0;
};

// Where a drawing names one of these numbers it shows this texture; any other number is the font.
using ImGuiTextures = std::map<int, GLuint>;

// Draws what Dear ImGui has laid out over a finished picture, in any OpenGL 3.3 core context.
//
// It belongs to the thread of the context, which must be current for every call. Leaves blending and scissors
// off.
class ImGuiPainter {
  public:
    // Throws GlError.
    explicit ImGuiPainter(const GlApi& gl);

    // Draws into the bound framebuffer of this size (pixels).
    void paint(const ImDrawData& drawing, const ImGuiStage::FontPixels& font, const ImGuiTextures& textures,
               int width, int height);

  private:
    void uploadFont(const ImGuiStage::FontPixels& font);
    void prepare(int width, int height);

    const GlApi& gl_;
    Program program_;
    GlVertexArray layout_;
    GlBuffer vertices_;
    GlBuffer indices_;
    GlTexture font_;
    int font_version_ = 0;  // of the pixels in the texture; 0: none
};

}  // namespace bonemill
