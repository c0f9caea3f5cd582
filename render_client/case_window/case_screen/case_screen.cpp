#include "render_client/case_window/case_screen/case_screen.h"

#include <imgui.h>

#include <algorithm>

#include "render_client/language/language.h"

namespace bonemill {
namespace {

constexpr float kStepsWidth = 400, kMessagesHeight = 128;  // pixels at scale 1

std::vector<std::filesystem::path> toolSetsIn(const std::filesystem::path& folder) {
    std::vector<std::filesystem::path> sets;
    std::error_code error;
    for (std::filesystem::directory_iterator file(folder, error), end; !error && file != end;
         file.increment(error))
        if (file->path().extension() == ".textproto") sets.push_back(file->path());
    std::ranges::sort(sets);
    return sets;
}

ImVec4 colourOf(DeskLine::Kind kind) {
    switch (kind) {
        case DeskLine::Kind::kError:
            return {1.00f, 0.42f, 0.36f, 1};
        case DeskLine::Kind::kWarning:
            return {1.00f, 0.80f, 0.35f, 1};
        case DeskLine::Kind::kPlain:
            break;
    }
    return {0.85f, 0.87f, 0.90f, 1};
}

}  // namespace

void BrowseBox::open(const std::string& title, const std::string& near, bool takes_folders) {
    namespace fs = std::filesystem;
    std::error_code error;
    fs::path folder = near.empty() ? fs::current_path(error) : fs::path(near);
    if (!fs::is_directory(folder, error)) folder = folder.parent_path();
    if (!fs::is_directory(folder, error)) folder = fs::current_path(error);
    title_ = title;
    takes_folders_ = takes_folders;
    is_asked_for_ = true;
    view_ = lookInto(folder);
}

std::optional<std::string> BrowseBox::build(ControlPlaces& places, float scale) {
    const std::string id = title_ + "###browse";
    if (is_asked_for_) ImGui::OpenPopup(id.c_str());
    is_asked_for_ = false;
    std::optional<std::string> chosen;
    ImGui::SetNextWindowSize(ImVec2(640 * scale, 460 * scale), ImGuiCond_Always);
    const ImVec2 picture = ImGui::GetIO().DisplaySize;
    ImGui::SetNextWindowPos(ImVec2(picture.x / 2, picture.y / 2), ImGuiCond_Always, ImVec2(0.5f, 0.5f));
    if (!ImGui::BeginPopupModal(id.c_str(), nullptr, ImGuiWindowFlags_NoResize | ImGuiWindowFlags_NoMove))
        return chosen;
    ImGui::TextWrapped("%s", view_.path.c_str());
    if (!view_.problem.empty())
        ImGui::TextWrapped("%s", tr("It cannot be looked into: {1}", {view_.problem}).c_str());
    const float footer = 2.4f * ImGui::GetFrameHeightWithSpacing();
    if (ImGui::BeginChild("entries", ImVec2(0, -footer), true)) chosen = buildEntries(places);
    ImGui::EndChild();
    const char* const others = view_.other_files > 0 && takes_folders_
                                   ? trMark("{1} other files here: slices of a series have often no ending")
                                   : trMark("{1} other files here");
    ImGui::TextDisabled("%s", tr(others, {std::to_string(view_.other_files)}).c_str());
    if (takes_folders_) {
        if (ImGui::Button(tr("Open this folder"))) chosen = view_.path.string();
        notePlace(places, tr("Open this folder"));
        ImGui::SameLine();
    }
    if (ImGui::Button(tr("Cancel"))) ImGui::CloseCurrentPopup();
    notePlace(places, tr("Cancel"));
    if (chosen) ImGui::CloseCurrentPopup();
    ImGui::EndPopup();
    return chosen;
}

std::optional<std::string> BrowseBox::buildEntries(ControlPlaces& places) {
    std::optional<std::string> chosen;
    std::filesystem::path next;
    const auto row = [&](const std::string& text) {
        const bool is_clicked = ImGui::Selectable(text.c_str(), false, ImGuiSelectableFlags_DontClosePopups);
        notePlace(places, text);
        return is_clicked;
    };
    if (view_.path.has_relative_path() && row(tr("..  (one folder up)"))) next = view_.path.parent_path();
    for (const std::string& name : view_.folders)
        if (row(name + "/")) next = view_.path / name;
    for (const std::string& name : view_.scans)
        if (row(name)) chosen = (view_.path / name).string();
    if (!next.empty()) view_ = lookInto(next);
    return chosen;
}

CaseScreen::CaseScreen(CaseDesk& desk, const std::filesystem::path& tools_folder)
    : desk_(desk),
      tool_sets_(toolSetsIn(tools_folder)),
      typed_path_(desk.path()),
      typed_labels_(desk.labelPath()) {
    for (size_t axis = 0; axis < panes_.size(); ++axis) panes_[axis].axis = axis;
}

void CaseScreen::setPicture(int width, int height, float scale) {
    width_ = width;
    height_ = height;
    stage_.setPicture(width, height, scale);
}

// Each event gets a frame: none of two clicks within one picture is lost.
void CaseScreen::handle(const WindowEvent& event) {
    stage_.feed(event);
    frame(0);
}

void CaseScreen::openDropped(const std::string& path) {
    typed_path_ = path;
    desk_.open(path);
}

void CaseScreen::layOut(double seconds) {
    frame(seconds);
}

std::optional<PixelPoint> CaseScreen::find(const std::string& label) const {
    const auto place = places_.find(label);
    return place == places_.end() ? std::nullopt : std::optional(place->second);
}

void CaseScreen::frame(double seconds) {
    stage_.begin(seconds);
    places_.clear();
    lookAtNew();
    const float scale = stage_.scale();
    ImGui::SetNextWindowPos(ImVec2(0, 0));
    ImGui::SetNextWindowSize(ImVec2(float(width_), float(height_)));
    ImGui::PushStyleVar(ImGuiStyleVar_WindowRounding, 0);
    ImGui::Begin("make-case", nullptr,
                 ImGuiWindowFlags_NoDecoration | ImGuiWindowFlags_NoMove | ImGuiWindowFlags_NoSavedSettings |
                     ImGuiWindowFlags_NoBringToFrontOnFocus);
    ImGui::PopStyleVar();
    const float steps = std::min(kStepsWidth * scale, 0.45f * float(width_));
    const ImVec2 room = ImGui::GetContentRegionAvail();
    const float gap = ImGui::GetStyle().ItemSpacing.x, messages = kMessagesHeight * scale;
    if (ImGui::BeginChild("steps", ImVec2(steps, room.y))) buildSteps();
    ImGui::EndChild();
    ImGui::SameLine();
    ImGui::BeginGroup();
    buildPanes(ImVec2(room.x - steps - gap, room.y - messages - gap));
    buildMessages(messages);
    ImGui::EndGroup();
    if (const auto chosen = browse_.build(places_, scale)) {
        (browses_for_labels_ ? typed_labels_ : typed_path_) = *chosen;
        browses_for_labels_ ? desk_.openLabels(*chosen) : desk_.open(*chosen);
    }
    ImGui::End();
    stage_.end();
}

void CaseScreen::buildMessages(float height) {
    if (ImGui::BeginChild("messages", ImVec2(0, height - ImGui::GetFrameHeightWithSpacing()), true)) {
        ImGui::TextDisabled(
            "%s", tr("Slices: a click moves the cross, the wheel goes through them, with Ctrl it zooms. "
                     "Bone: drag, wheel, double click."));
        if (!desk_.busyWith().empty()) {
            const int dots = int(ImGui::GetTime() * 3) % 4;
            ImGui::TextColored(ImVec4(0.45f, 0.8f, 1, 1), "%s %.*s", desk_.busyWith().c_str(), dots, "...");
        }
        for (const DeskLine& line : desk_.lines()) say(line.text, colourOf(line.kind));
        if (desk_.lines().size() != lines_seen_) ImGui::SetScrollHereY(1);
        lines_seen_ = desk_.lines().size();
    }
    ImGui::EndChild();
    const std::string command = desk_.commandLine();
    if (button(tr("Copy"))) ImGui::SetClipboardText(command.c_str());
    ImGui::SameLine();
    std::string shown = command;
    ImGui::SetNextItemWidth(-1);
    ImGui::InputText("##command", shown.data(), shown.size() + 1, ImGuiInputTextFlags_ReadOnly);
    if (ImGui::IsItemHovered()) ImGui::SetTooltip("%s", tr("The command line that makes the same case"));
}

}  // namespace bonemill
