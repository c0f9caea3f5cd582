#include "render_client/panel/imgui/imgui_stage.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstddef>
#include <utility>

#include "render_client/look/hud/hud_canvas.h"

namespace bonemill {
namespace {

constexpr char kVertexShader[] = R"(
layout(location = 0) in vec2 position;
layout(location = 1) in vec2 uv;
layout(location = 2) in vec4 colour;
uniform vec2 size;
out vec2 font_uv;
out vec4 tint;
void main() {
    font_uv = uv;
    tint = colour;
    gl_Position = vec4(2.0 * position.x / size.x - 1.0, 1.0 - 2.0 * position.y / size.y, 0.0, 1.0);
}
)";

constexpr char kFragmentShader[] = R"(
in vec2 font_uv;
in vec4 tint;
uniform sampler2D font;
uniform bool is_picture;
out vec4 colour;
void main() {
    vec4 texel = texture(font, font_uv);
    colour = is_picture ? tint * texel : vec4(tint.rgb, tint.a * texel.r);
}
)";

constexpr float kFontPixels = 14;        // at scale 1
constexpr double kShortestFrame = 1e-4;  // s; ImGui wants time to pass
constexpr float kFarAway = -1e6f;        // where no mouse is
constexpr ImWchar kSigns[] = {0x20, 0xff, 0x2013, 0x2013, 0x2026, 0x2026, 0};

constexpr struct {
    ImGuiKey_ imgui;
    Key key;
} kEditingKeys[] = {
    {ImGuiKey_Tab, Key::kTab},     {ImGuiKey_LeftArrow, Key::kLeft}, {ImGuiKey_RightArrow, Key::kRight},
    {ImGuiKey_UpArrow, Key::kUp},  {ImGuiKey_DownArrow, Key::kDown}, {ImGuiKey_Home, Key::kHome},
    {ImGuiKey_End, Key::kEnd},     {ImGuiKey_Delete, Key::kDelete},  {ImGuiKey_Backspace, Key::kBackspace},
    {ImGuiKey_Enter, Key::kEnter}, {ImGuiKey_Escape, Key::kEscape},  {ImGuiKey_A, keyOf('A')},
    {ImGuiKey_C, keyOf('C')},      {ImGuiKey_V, keyOf('V')},         {ImGuiKey_X, keyOf('X')},
    {ImGuiKey_Y, keyOf('Y')},      {ImGuiKey_Z, keyOf('Z')},
};

void holdModifiers(const Modifiers& held) {
    ImGui::GetIO().KeyShift = held.shift;
    ImGui::GetIO().KeyCtrl = held.control;
}

void moveMouse(const PixelPoint& to) {
    ImGui::GetIO().MousePos = ImVec2(float(to.x), float(to.y));
}

ImGuiStyle makeStyle(float scale) {
    ImGuiStyle style;
    ImGui::StyleColorsDark(&style);
    style.WindowRounding = 6;
    style.FrameRounding = 3;
    style.WindowBorderSize = 0;
    style.Colors[ImGuiCol_WindowBg] = ImVec4(0.03f, 0.045f, 0.06f, 0.9f);
    style.ScaleAllSizes(scale);
    return style;
}

}  // namespace

ImGuiPainter::ImGuiPainter(const GlApi& gl)
    : gl_(gl),
      program_(gl, "panel", kVertexShader, kFragmentShader),
      layout_(gl),
      vertices_(gl),
      indices_(gl),
      font_(gl) {
    gl_.BindVertexArray(layout_.name());
    gl_.BindBuffer(GL_ARRAY_BUFFER, vertices_.name());
    gl_.BindBuffer(GL_ELEMENT_ARRAY_BUFFER, indices_.name());
    gl_.setFloats(0, 2, sizeof(ImDrawVert), offsetof(ImDrawVert, pos));
    gl_.setFloats(1, 2, sizeof(ImDrawVert), offsetof(ImDrawVert, uv));
    gl_.VertexAttribPointer(2, 4, GL_UNSIGNED_BYTE, GL_TRUE, sizeof(ImDrawVert),
                            reinterpret_cast<const void*>(offsetof(ImDrawVert, col)));
    gl_.EnableVertexAttribArray(2);
    gl_.BindVertexArray(0);
}

void ImGuiPainter::uploadFont(const ImGuiStage::FontPixels& font) {
    gl_.BindTexture(GL_TEXTURE_2D, font_.name());
    if (font.version == font_version_) return;
    font_version_ = font.version;
    gl_.PixelStorei(GL_UNPACK_ALIGNMENT, 1);
    gl_.TexImage2D(GL_TEXTURE_2D, 0, GL_R8, font.width, font.height, 0, GL_RED, GL_UNSIGNED_BYTE,
                   font.pixels);
    gl_.setSampling(GL_TEXTURE_2D, GL_LINEAR);
}

void ImGuiPainter::prepare(int width, int height) {
    gl_.Viewport(0, 0, width, height);
    gl_.Disable(GL_DEPTH_TEST);
    gl_.Disable(GL_CULL_FACE);
    gl_.Enable(GL_BLEND);
    gl_.Enable(GL_SCISSOR_TEST);
    gl_.BlendFunc(GL_SRC_ALPHA, GL_ONE_MINUS_SRC_ALPHA);
    program_.use();
    program_.set("size", Eigen::Vector2f(float(width), float(height)));
    program_.set("font", 0);
    gl_.BindVertexArray(layout_.name());
    gl_.BindBuffer(GL_ARRAY_BUFFER, vertices_.name());
}

void ImGuiPainter::paint(const ImDrawData& drawing, const ImGuiStage::FontPixels& font,
                         const ImGuiTextures& textures, int width, int height) {
    gl_.ActiveTexture(GL_TEXTURE0);
    uploadFont(font);
    prepare(width, height);
    for (int i = 0; i < drawing.CmdListsCount; ++i) {
        const ImDrawList& list = *drawing.CmdLists[i];
        gl_.BufferData(GL_ARRAY_BUFFER, list.VtxBuffer.size_in_bytes(), list.VtxBuffer.Data, GL_STREAM_DRAW);
        gl_.BufferData(GL_ELEMENT_ARRAY_BUFFER, list.IdxBuffer.size_in_bytes(), list.IdxBuffer.Data,
                       GL_STREAM_DRAW);
        for (const ImDrawCmd& command : list.CmdBuffer) {
            const ImVec4& clip = command.ClipRect;
            const float left = std::max(clip.x, 0.f), right = std::min(clip.z, float(width));
            const float top = std::max(clip.y, 0.f), bottom = std::min(clip.w, float(height));
            if (right <= left || bottom <= top) continue;
            gl_.Scissor(GLint(left), GLint(float(height) - bottom), GLsizei(right - left),
                        GLsizei(bottom - top));
            const auto picture = textures.find(int(intptr_t(command.GetTexID())));
            program_.set("is_picture", int(picture != textures.end()));
            gl_.BindTexture(GL_TEXTURE_2D, picture != textures.end() ? picture->second : font_.name());
            static_assert(sizeof(ImDrawIdx) == 2);
            gl_.DrawElements(GL_TRIANGLES, GLsizei(command.ElemCount), GL_UNSIGNED_SHORT,
                             reinterpret_cast<const void*>(size_t(command.IdxOffset) * sizeof(ImDrawIdx)));
        }
    }
    gl_.BindVertexArray(0);
    gl_.Disable(GL_SCISSOR_TEST);
    gl_.Disable(GL_BLEND);
    gl_.check("drawing the control panel");
}

void ImGuiStage::Destroy::operator()(ImGuiContext* context) const {
    ImGui::DestroyContext(context);
}

ImGuiStage::ImGuiStage() : context_(ImGui::CreateContext()) {
    makeCurrent();
    ImGuiIO& io = ImGui::GetIO();
    io.IniFilename = nullptr;  // nothing is left on the disk
    io.ConfigInputTextCursorBlink = false;
    io.MousePos = ImVec2(kFarAway, kFarAway);
    for (const auto& editing : kEditingKeys) io.KeyMap[editing.imgui] = int(editing.key);
    setScale(1);
}

ImGuiStage::~ImGuiStage() = default;

void ImGuiStage::makeCurrent() const {
    ImGui::SetCurrentContext(context_.get());
}

void ImGuiStage::setScale(float scale) {
    if (scale == scale_) return;
    const std::string font = fontFile(FontStyle::kPlain);
    scale_ = scale;
    makeCurrent();
    ImFontAtlas& fonts = *ImGui::GetIO().Fonts;
    fonts.Clear();
    fonts.AddFontFromFileTTF(font.c_str(), std::round(kFontPixels * scale), nullptr, kSigns);
    fonts.Build();
    ImGui::GetStyle() = makeStyle(scale);
    ++font_version_;
}

void ImGuiStage::setPicture(int width, int height, float scale) {
    setScale(scale);
    makeCurrent();
    ImGui::GetIO().DisplaySize = ImVec2(float(width), float(height));
}

ImGuiStage::FontPixels ImGuiStage::fontPixels() const {
    makeCurrent();
    unsigned char* pixels = nullptr;
    FontPixels font{nullptr, 0, 0, font_version_};
    ImGui::GetIO().Fonts->GetTexDataAsAlpha8(&pixels, &font.width, &font.height);
    font.pixels = pixels;
    return font;
}

void ImGuiStage::feed(const WindowEvent& event) {
    makeCurrent();
    ImGuiIO& io = ImGui::GetIO();
    if (const auto* key = std::get_if<KeyEvent>(&event)) {
        holdModifiers(key->held);
        io.KeysDown[size_t(key->key)] = key->is_down;
    } else if (const auto* text = std::get_if<TextEvent>(&event)) {
        io.AddInputCharacter(text->sign);
    } else if (const auto* button = std::get_if<MouseButtonEvent>(&event)) {
        holdModifiers(button->held);
        moveMouse(button->at);
        io.MouseDown[size_t(button->button)] = button->is_down;
    } else if (const auto* move = std::get_if<MouseMoveEvent>(&event)) {
        moveMouse(move->to);
    } else if (const auto* scroll = std::get_if<ScrollEvent>(&event)) {
        io.MouseWheel += float(scroll->steps);
    }
}

void ImGuiStage::useClipboard(std::function<std::string()> read,
                              std::function<void(const std::string&)> write) {
    clipboard_ = std::make_unique<Clipboard>(Clipboard{std::move(read), std::move(write), {}});
    makeCurrent();
    ImGuiIO& io = ImGui::GetIO();
    io.ClipboardUserData = clipboard_.get();
    io.GetClipboardTextFn = [](void* data) {
        Clipboard& clipboard = *static_cast<Clipboard*>(data);
        clipboard.text = clipboard.read();
        return clipboard.text.c_str();
    };
    io.SetClipboardTextFn = [](void* data, const char* text) { static_cast<Clipboard*>(data)->write(text); };
}

// What ImGui takes for the space bar presses a control.
void ImGuiStage::goByKeys() {
    makeCurrent();
    ImGui::GetIO().ConfigFlags |= ImGuiConfigFlags_NavEnableKeyboard;
    ImGui::GetIO().KeyMap[ImGuiKey_Space] = int(Key::kEnter);
}

void ImGuiStage::dropInput() {
    makeCurrent();
    ImGui::GetIO().MouseWheel = 0;
    ImGui::GetIO().ClearInputCharacters();
}

void ImGuiStage::begin(double seconds) {
    makeCurrent();
    ImGui::GetIO().DeltaTime = float(std::max(seconds, kShortestFrame));
    ImGui::NewFrame();
}

void ImGuiStage::end() {
    ImGui::Render();
}

const ImDrawData* ImGuiStage::drawData() const {
    makeCurrent();
    return ImGui::GetDrawData();
}

}  // namespace bonemill
