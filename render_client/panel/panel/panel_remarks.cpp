// Here is the panel's part about what people write and draw.
#include <imgui.h>

#include <algorithm>
#include <functional>

#include "render_client/look/hud/figure_text.h"
#include "render_client/look/hud/session_text.h"
#include "render_client/panel/panel/panel_content.h"

namespace bonemill {
namespace {

constexpr size_t kMaxListed = 40;

ImVec4 strokeColour(uint32_t colour) {
    const auto part = [colour](int shift) { return float(colour >> shift & 0xff) / 255; };
    return {part(16), part(8), part(0), 1};
}

std::vector<const topics::Remark*> newestFirst(const std::map<uint32_t, topics::Remark>& remarks) {
    std::vector<const topics::Remark*> listed;
    for (const auto& [place, remark] : remarks) listed.push_back(&remark);
    std::ranges::sort(listed, std::greater{}, [](const topics::Remark* remark) { return remark->number(); });
    return listed;
}

}  // namespace

void PanelContent::buildRemarks() {
    ImGui::BeginDisabled(!whyNotCommand(session_).empty());
    buildNote();
    box("Draw", Action::kDraw, controls_.isDrawing(), "Left drags draw on the bone, for everyone to see");
    ImGui::EndDisabled();
    ImGui::SameLine();
    box("Show", Action::kRemarks, settings_.show_remarks, "Notes and strokes on the bone");
    if (!session_.remarks || session_.remarks->empty()) return;
    const std::vector<const topics::Remark*> listed = newestFirst(*session_.remarks);
    for (size_t n = 0; n < std::min(listed.size(), kMaxListed); ++n) buildRemark(*listed[n]);
    if (listed.size() > kMaxListed)
        sayQuietly("and " + std::to_string(listed.size() - kMaxListed) + " older ones");
    ImGui::BeginDisabled(!whyNotCommand(session_).empty());
    topics::Command all;
    all.set_erase_remark(0);
    if (button("Erase all", "Takes all notes and strokes away, for everybody")) send(all);
    ImGui::EndDisabled();
}

void PanelContent::buildNote() {
    if (remark_draft_.wants_keyboard) ImGui::SetKeyboardFocusHere();
    remark_draft_.wants_keyboard = false;
    ImGui::PushItemWidth(-1);
    const bool is_entered = ImGui::InputTextWithHint(
        "##note", withKey("Note for everyone", Action::kNote).c_str(), remark_draft_.note.data(),
        remark_draft_.note.size(), ImGuiInputTextFlags_EnterReturnsTrue);
    note("##note", "Enter shows it to everyone, with the session's clock");
    ImGui::PopItemWidth();
    if (remark_draft_.place &&
        box("at the place on the bone", true, "Where the mouse was; otherwise nowhere"))
        remark_draft_.place.reset();
    if (is_entered) sendNote();
}

void PanelContent::sendNote() {
    const std::string typed = remark_draft_.note.data();
    if (typed.find_first_not_of(' ') != std::string::npos) {
        topics::Command command;
        topics::Remark& remark = *command.mutable_add_remark();
        remark.set_note(typed);
        if (remark_draft_.place)
            for (const double value : *remark_draft_.place) remark.add_points_m(float(value));
        send(command);
    }
    remark_draft_ = {.place = {}, .leaves_keyboard = true};
}

void PanelContent::buildRemark(const topics::Remark& remark) {
    const std::string number = std::to_string(remark.number());
    ImGui::BeginDisabled(!whyNotCommand(session_).empty());
    if (button("Erase " + number, "Takes it away, for everybody")) {
        topics::Command command;
        command.set_erase_remark(remark.number());
        send(command);
    }
    ImGui::EndDisabled();
    ImGui::SameLine();
    const std::string author = remark.author().empty() ? roleName(remark.role()) : remark.author();
    ImGui::PushTextWrapPos();
    if (remark.note().empty()) {
        ImGui::ColorButton(("##colour" + number).c_str(), strokeColour(remark.color()),
                           ImGuiColorEditFlags_NoTooltip | ImGuiColorEditFlags_NoPicker,
                           ImVec2(ImGui::GetFontSize(), ImGui::GetFontSize()));
        ImGui::SameLine();
    }
    sayQuietly(clockText(remark.session_s()) + " " + author);
    if (!remark.note().empty()) say(remark.note(), HudTone::kPlain);
    ImGui::PopTextWrapPos();
}

}  // namespace bonemill
