#include "render_client/panel/imgui/imgui_stage.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <utility>

#include "render_client/look/hud/font_files.h"

namespace bonemill {
namespace {

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
