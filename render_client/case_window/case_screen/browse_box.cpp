#include "render_client/case_window/case_screen/browse_box.h"

#include <imgui.h>

namespace bonemill {

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
    if (!view_.problem.empty()) ImGui::TextWrapped("It cannot be looked into: %s", view_.problem.c_str());
    const float footer = 2.4f * ImGui::GetFrameHeightWithSpacing();
    if (ImGui::BeginChild("entries", ImVec2(0, -footer), true)) chosen = buildEntries(places);
    ImGui::EndChild();
    ImGui::TextDisabled(
        "%zu other files here%s", view_.other_files,
        view_.other_files > 0 && takes_folders_ ? ": slices of a series have often no ending" : "");
    if (takes_folders_) {
        if (ImGui::Button("Open this folder")) chosen = view_.path.string();
        notePlace(places, "Open this folder");
        ImGui::SameLine();
    }
    if (ImGui::Button("Cancel")) ImGui::CloseCurrentPopup();
    notePlace(places, "Cancel");
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
    if (view_.path.has_relative_path() && row("..  (one folder up)")) next = view_.path.parent_path();
    for (const std::string& name : view_.folders)
        if (row(name + "/")) next = view_.path / name;
    for (const std::string& name : view_.scans)
        if (row(name)) chosen = (view_.path / name).string();
    if (!next.empty()) view_ = lookInto(next);
    return chosen;
}

}  // namespace bonemill
