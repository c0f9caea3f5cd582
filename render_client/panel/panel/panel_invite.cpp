// Here is the panel's part that lets people from elsewhere in: a link, and its QR code.
#include <imgui.h>

#include <algorithm>
#include <cmath>

#include "render_client/language/language.h"
#include "render_client/panel/panel/panel_content.h"

namespace bonemill {

void PanelContent::buildInvite() {
    ImGui::PushItemWidth(ImGui::GetContentRegionAvail().x * 0.55f);
    ImGui::InputTextWithHint("##guest", tr("Whose link"), invite_draft_.name.data(),
                             invite_draft_.name.size());
    note("##guest", tr("The name that others read; the link is for one person"));
    ImGui::PopItemWidth();
    ImGui::SameLine();
    ImGui::PushItemWidth(-1);
    const auto shown = [](void*, int role, const char** text) {
        *text = tr(kInvitedRoles[size_t(role)]);
        return true;
    };
    ImGui::Combo("##role", &invite_draft_.role, shown, nullptr, int(kInvitedRoles.size()));
    note("##role", tr("observer: looks; operator: also may take the hand; instructor: also points and ends "
                      "the session"));
    ImGui::PopItemWidth();
    const std::string name = invite_draft_.name.data();
    ImGui::BeginDisabled(name.find_first_not_of(' ') == std::string::npos);
    if (button(
            tr("Invite"),
            tr("Makes a link with which they join in a browser; guests can come while the session runs"))) {
        wishes_.invite = name;
        wishes_.invite_as = kInvitedRoles[size_t(invite_draft_.role)];
    }
    ImGui::EndDisabled();
    if (!session_.invitation.name.empty()) buildInvitation();
}

void PanelContent::buildInvitation() {
    const Invitation& invitation = session_.invitation;
    if (!invitation.problem.empty()) return sayWrapped(invitation.problem, HudTone::kWarning);
    if (invitation.link.empty())
        return say(tr("making a link for {1} ...", {invitation.name}), HudTone::kPlain);
    ImGui::SameLine();
    if (button(tr("Copy the link"), tr("Into the clipboard"))) wishes_.copy = invitation.link;
    sayWrapped(tr("For {1}: {2}", {invitation.name, invitation.link}), HudTone::kGood);
    if (invite_draft_.link != invitation.link) {
        invite_draft_.link = invitation.link;
        invite_draft_.code = qrCodeOf(invitation.link);
    }
    drawCode();
}

// Cameras want it dark on light, whatever the panel's colours are.
void PanelContent::drawCode() {
    const QrCode& code = invite_draft_.code;
    if (code.width == 0) return;
    const int squares = code.width + 2 * QrCode::kQuietSquares;
    const float square =
        std::floor(std::min(ImGui::GetContentRegionAvail().x, 260 * scale_) / float(squares));
    const ImVec2 corner = ImGui::GetCursorScreenPos();
    ImDrawList& list = *ImGui::GetWindowDrawList();
    const float edge = square * float(squares);
    list.AddRectFilled(corner, ImVec2(corner.x + edge, corner.y + edge), IM_COL32_WHITE);
    for (int n = 0; n < code.width * code.width; ++n) {
        if (!code.is_dark[size_t(n)]) continue;
        const int column = QrCode::kQuietSquares + n % code.width,
                  row = QrCode::kQuietSquares + n / code.width;
        const ImVec2 low(corner.x + square * float(column), corner.y + square * float(row));
        list.AddRectFilled(low, ImVec2(low.x + square, low.y + square), IM_COL32_BLACK);
    }
    ImGui::Dummy(ImVec2(edge, edge));
}

}  // namespace bonemill
