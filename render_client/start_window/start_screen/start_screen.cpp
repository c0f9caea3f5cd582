#include "render_client/start_window/start_screen/start_screen.h"

#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <tuple>
#include <vector>

#include "render_client/language/language.h"
#include "render_client/start_window/start_screen/start_colours.h"

namespace bonemill {
namespace {

// Pixels at scale 1.
constexpr float kLeftWidth = 230, kRightWidth = 310, kCardHeight = 112, kLeastCardWidth = 300;
constexpr ImGuiWindowFlags kColumn = ImGuiWindowFlags_NavFlattened;

std::string minutesOf(const SceneCard& card) {
    return card.expected_minutes > 0 ? tr("{1} min", {std::to_string(std::lround(card.expected_minutes))})
                                     : "";
}

// What comes before milling, or stands in its way; empty: nothing.
std::string needsOf(const SceneCard& card) {
    if (!card.problem.empty()) return card.problem;
    if (!card.lacks.empty()) return tr("needs {1}", {card.lacks});
    std::string names;
    for (const std::string& name : card.made_first) names += (names.empty() ? "" : ", ") + name;
    return names.empty() ? "" : tr("makes its phantom first: some seconds");
}

bool canStart(const SceneCard& card) {
    return card.problem.empty() && card.lacks.empty();
}

// What takes less time comes first; what cannot be started comes last.
std::vector<const SceneCard*> inOrder(const std::vector<SceneCard>& cards) {
    std::vector<const SceneCard*> order;
    for (const SceneCard& card : cards) order.push_back(&card);
    std::ranges::stable_sort(order, {}, [](const SceneCard* card) {
        return std::tuple(card->is_own, !canStart(*card), card->expected_minutes);
    });
    return order;
}

// So much of the text as fits, with an ellipsis where that is not all.
std::string fitted(const std::string& text, float width, float height) {
    const auto fits = [&](const std::string& part) {
        return ImGui::CalcTextSize(part.c_str(), nullptr, false, width).y <= height + 1;
    };
    if (fits(text)) return text;
    std::string part = text;
    while (!part.empty() && !fits(part + " \u2026")) {
        const size_t blank = part.rfind(' ');
        part.resize(blank == std::string::npos ? 0 : blank);
    }
    return part + " \u2026";
}

}  // namespace

StartScreen::StartScreen(StartDesk& desk) : desk_(desk) {
    stage_.goByKeys();
}

void StartScreen::setPicture(int width, int height, float scale) {
    width_ = width;
    height_ = height;
    stage_.setPicture(width, height, scale);
}

// Each event gets a frame: none of two clicks within one picture is lost.
void StartScreen::handle(const WindowEvent& event) {
    stage_.feed(event);
    frame(0);
}

void StartScreen::layOut(double seconds) {
    frame(seconds);
}

std::optional<PixelPoint> StartScreen::find(const std::string& label) const {
    const auto place = places_.find(label);
    return place == places_.end() ? std::nullopt : std::optional(place->second);
}

void StartScreen::frame(double seconds) {
    stage_.begin(seconds);
    places_.clear();
    ImGui::SetNextWindowPos(ImVec2(0, 0));
    ImGui::SetNextWindowSize(ImVec2(float(width_), float(height_)));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
    // Each begins with the keyboard at its own first control.
    ImGui::Begin(desk_.isBusy()    ? "waiting"
                 : desk_.hasList() ? "start"
                                   : "looking",
                 nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoBringToFrontOnFocus);
    ImGui::PopStyleVar();
    if (desk_.isBusy())
        buildWaiting();
    else if (desk_.hasList())
        buildAll();
    else
        say(tr("Looking for scenes ..."));
    ImGui::End();
    stage_.end();
}

void StartScreen::buildAll() {
    const float scale = stage_.scale(), gap = ImGui::GetStyle().ItemSpacing.x;
    const ImVec2 room = ImGui::GetContentRegionAvail();
    const float foot = 2 * ImGui::GetTextLineHeightWithSpacing(), height = room.y - foot;
    const float left = std::min(kLeftWidth * scale, 0.25f * room.x),
                right = std::min(kRightWidth * scale, 0.3f * room.x);
    if (ImGui::BeginChild("choices", ImVec2(left, height), false, kColumn)) buildChoices();
    ImGui::EndChild();
    ImGui::SameLine();
    if (ImGui::BeginChild("cards", ImVec2(room.x - left - right - 2 * gap, height), false, kColumn))
        buildCards();
    ImGui::EndChild();
    ImGui::SameLine();
    if (ImGui::BeginChild("past", ImVec2(right, height), false, kColumn)) {
        buildPast();
        buildOthers();
        buildThisPc();
    }
    ImGui::EndChild();
    buildFoot();
}

void StartScreen::buildCards() {
    const float scale = stage_.scale(), gap = ImGui::GetStyle().ItemSpacing.x;
    if (desk_.list().scenes.empty())
        say(tr("This PC only watches: the package bonemill brings scenes to mill."));
    const float room = ImGui::GetContentRegionAvail().x;
    const int columns = std::max(1, int((room + gap) / (kLeastCardWidth * scale + gap)));
    const ImVec2 size((room - float(columns - 1) * gap) / float(columns), kCardHeight * scale);
    int column = 0;
    bool was_own = false;
    const auto cards = inOrder(desk_.list().scenes);
    for (const SceneCard* const card : cards) {
        if (card->is_own && !was_own) heading(tr("Your own cases")), column = 0;
        was_own = card->is_own;
        if (column % columns != 0) ImGui::SameLine();
        ++column;
        buildCard(*card, size);
        if (card == cards.front()) ImGui::SetItemDefaultFocus();
    }
}

void StartScreen::buildCard(const SceneCard& card, const ImVec2& size) {
    const ImVec2 low = ImGui::GetCursorScreenPos();
    const bool is_clicked = ImGui::InvisibleButton(card.file.c_str(), size);
    notePlace(places_, card.name);
    const bool is_lit = ImGui::IsItemHovered() || ImGui::IsItemFocused();
    if (ImGui::IsItemVisible()) drawCard(card, low, size, is_lit);
    if (ImGui::IsItemHovered()) {
        ImGui::BeginTooltip();
        ImGui::PushTextWrapPos(ImGui::GetFontSize() * 28);
        ImGui::TextUnformatted(card.title.c_str());
        ImGui::TextUnformatted(card.task.c_str());
        if (const std::string needs = needsOf(card); !needs.empty()) say(needs);
        say(commandLineOf(startWords(card, desk_.choice(), {})));
        ImGui::PopTextWrapPos();
        ImGui::EndTooltip();
    }
    if (is_clicked) desk_.start(card);
}

void StartScreen::drawCard(const SceneCard& card, const ImVec2& low, const ImVec2& size, bool is_lit) {
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const float pad = 6 * stage_.scale(), line = ImGui::GetTextLineHeight();
    const ImVec2 high(low.x + size.x, low.y + size.y);
    draw.AddRectFilled(low, high, is_lit ? IM_COL32(44, 62, 84, 255) : IM_COL32(26, 33, 41, 255), pad);
    if (is_lit) draw.AddRect(low, high, IM_COL32(120, 180, 255, 255), pad, 0, 1.5f * stage_.scale());
    const float tall = size.y - 2 * pad, wide = tall * 4 / 3;
    const ImVec2 from(low.x + pad, low.y + pad), to(from.x + wide, from.y + tall);
    const ImU32 tint = canStart(card) ? IM_COL32_WHITE : IM_COL32(255, 255, 255, 90);
    if (const CardPicture& picture = pictures_.of(card.picture); picture.number > 0)
        draw.AddImage(ImTextureID(intptr_t(picture.number)), from, to, ImVec2(0, 0), ImVec2(1, 1), tint);
    else
        draw.AddRectFilled(from, to, IM_COL32(52, 60, 70, 255), pad);
    const float x = to.x + 1.5f * pad, width = high.x - pad - x;
    const auto write = [&](float y, const std::string& text, float height, ImU32 colour) {
        draw.AddText(ImGui::GetFont(), ImGui::GetFontSize(), ImVec2(x, y), colour,
                     fitted(text, width, height).c_str(), nullptr, width);
    };
    write(from.y, card.title, line, canStart(card) ? IM_COL32_WHITE : IM_COL32(170, 175, 180, 255));
    write(from.y + 1.25f * line, card.task, 4 * line, IM_COL32(190, 200, 210, 255));
    const std::string needs = needsOf(card), minutes = minutesOf(card);
    write(to.y - line, needs.empty() ? minutes : minutes + (minutes.empty() ? "" : ", ") + needs, line,
          needs.empty() ? IM_COL32(140, 200, 255, 255) : IM_COL32(255, 204, 90, 255));
}

// What went wrong, or what can be done here.
void StartScreen::buildFoot() {
    const std::string& problem = desk_.problem().empty() ? problem_ : desk_.problem();
    if (problem.empty()) {
        say(tr(
            "A click starts a scene, and so do arrows and Enter. The same in a terminal: bonemill --help"));
        return;
    }
    ImGui::PushTextWrapPos();
    ImGui::TextColored(kFailed, "%s", problem.c_str());
    ImGui::PopTextWrapPos();
    notePlace(places_, "problem");
}

void StartScreen::buildWaiting() {
    const int dots = int(ImGui::GetTime() * 3) % 4;
    ImGui::SetCursorPosY(0.4f * float(height_));
    ImGui::PushTextWrapPos();
    ImGui::Text("%s %.*s", desk_.commandLine().c_str(), dots, "...");
    ImGui::TextColored(kAside, "%s", desk_.lastWords().c_str());
    ImGui::PopTextWrapPos();
    if (button(tr("End it"))) desk_.askToEnd();
}

}  // namespace bonemill
