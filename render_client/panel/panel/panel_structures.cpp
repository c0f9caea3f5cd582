// Here is the panel's part about protected structures.
#include <imgui.h>

#include <algorithm>

#include "render_client/look/hud/effect_lines.h"
#include "render_client/look/structures/structure_colours.h"
#include "render_client/panel/panel/panel_content.h"

namespace bonemill {

bool PanelContent::hasStructures() const {
    return session_.info &&
           std::ranges::any_of(session_.info->materials(), [](const auto& m) { return m.is_protected(); });
}

// The first place of the modes is free: there the key counts on.
void PanelContent::buildStructures() {
    for (int i = 0; i < session_.info->materials_size(); ++i) {
        if (!session_.info->materials(i).is_protected()) continue;
        const auto structure = size_t(i) + 1;
        const std::string name = structureName(uint32_t(structure), session_.info);
        const StructureMode mode = settings_.structures[structure];
        const Eigen::Vector3f colour = structureColour(*session_.info, uint32_t(structure));
        const bool is_on = mode != StructureMode::kOff, is_through = mode == StructureMode::kThroughBone;
        ImGui::PushID(int(structure));
        ImGui::ColorButton("##colour", ImVec4(colour.x(), colour.y(), colour.z(), 1),
                           ImGuiColorEditFlags_NoTooltip | ImGuiColorEditFlags_NoPicker);
        ImGui::SameLine();
        if (box(name, is_on, "Is seen or not"))
            controls_.showStructure(structure, is_on ? StructureMode::kOff : StructureMode::kThroughBone);
        ImGui::SameLine(ImGui::GetContentRegionMax().x - 7.5f * ImGui::GetFontSize());
        ImGui::BeginDisabled(!is_on);
        if (box("through bone", is_through, "Is seen behind bone, too, and not only where it is exposed"))
            controls_.showStructure(structure,
                                    is_through ? StructureMode::kExposedOnly : StructureMode::kThroughBone);
        ImGui::EndDisabled();
        ImGui::PopID();
    }
    button("All", Action::kStructures, "All are seen through bone, or where they are exposed, or not at all");
    ImGui::SameLine();
    box("Thickness", Action::kThickness, settings_.show_thickness,
        "Bone has the colour of its distance to the next structure");
    if (box("Distance line", settings_.show_clearance,
            "From the burr to the nearest structure, when that is near"))
        controls_.showClearance(!settings_.show_clearance);
}

}  // namespace bonemill
