// The left of the screen: the five steps from a scan to a case.
#include <imgui.h>

#include <algorithm>
#include <cmath>
#include <cstring>
#include <optional>

#include "common/base/units.h"
#include "common/text/printed_text.h"
#include "render_client/case_window/case_desk/case_desk.h"
#include "render_client/case_window/case_screen/case_screen.h"
#include "render_client/language/language.h"
#include "render_client/look/slices/slice_image.h"

namespace bonemill {
namespace {

// Counts from 1 to the most frequent value's, as parts of the plot's height. A scan's air would hide all else
// on a linear scale.
float heightOf(double count, double most) {
    return count < 1 || most <= 1 ? 0 : float(std::log1p(count) / std::log1p(most));
}

// The scan's values as a plot, on which the iso-value is moved. Returns the value that the mouse has moved
// the line to. What is white above the grey window is drawn white.
std::optional<double> plotHistogram(const Histogram& histogram, const std::optional<double>& iso,
                                    const std::optional<double>& runner_up, const GreyWindow& window,
                                    float height, ControlPlaces& places) {
    const ImVec2 low = ImGui::GetCursorScreenPos();
    const ImVec2 size(ImGui::GetContentRegionAvail().x, height);
    ImGui::InvisibleButton("histogram", size);
    notePlace(places, "histogram");
    ImDrawList& draw = *ImGui::GetWindowDrawList();
    const ImVec2 high(low.x + size.x, low.y + size.y);
    draw.AddRectFilled(low, high, IM_COL32(12, 16, 20, 255), 3);
    const double range = histogram.width * double(histogram.count.size());
    if (range <= 0) return std::nullopt;
    const double most = *std::ranges::max_element(histogram.count);
    const float step = size.x / float(histogram.count.size());
    for (size_t bin = 0; bin < histogram.count.size(); ++bin) {
        const auto grey = int(70 + 185 * greyOf(window, histogram.centre(bin)));
        const float top = high.y - 0.94f * size.y * heightOf(histogram.count[bin], most);
        draw.AddRectFilled(ImVec2(low.x + step * float(bin), top),
                           ImVec2(low.x + step * float(bin + 1), high.y), IM_COL32(grey, grey, grey, 255));
    }
    const auto line = [&](double value, ImU32 colour, float thickness) {
        const float x = low.x + size.x * float((value - histogram.low) / range);
        if (x >= low.x && x <= high.x) draw.AddLine(ImVec2(x, low.y), ImVec2(x, high.y), colour, thickness);
    };
    if (runner_up) line(*runner_up, IM_COL32(255, 176, 32, 110), 1);
    if (iso) line(*iso, IM_COL32(255, 176, 32, 255), 2);
    if (!ImGui::IsItemActive()) return std::nullopt;
    return histogram.low + range * double((ImGui::GetIO().MousePos.x - low.x) / size.x);
}

constexpr size_t kLongestText = 4096;
constexpr float kPlotHeight = 84;  // pixels at scale 1

// Returns how much of a line these two buttons at its end take, `usual` (pixels) in English.
float roomForButtons(const char* first, const char* second, float usual) {
    const ImGuiStyle& style = ImGui::GetStyle();
    const float texts = ImGui::CalcTextSize(first).x + ImGui::CalcTextSize(second).x;
    return std::max(usual, texts + 4 * style.FramePadding.x + 2 * style.ItemSpacing.x);
}

bool isStepOpen(const char* title) {
    ImGui::Dummy(ImVec2(0, ImGui::GetStyle().ItemSpacing.y / 2));
    return ImGui::CollapsingHeader(title, ImGuiTreeNodeFlags_DefaultOpen);
}

const char* doubtText(IsoDoubt doubt) {
    switch (doubt) {
        case IsoDoubt::kLittle:
            return tr("quite sure");
        case IsoDoubt::kSome:
            return tr("some doubt: look at the line");
        case IsoDoubt::kLarge:
            break;
    }
    return tr("large doubt: look at the line and move it");
}

// Whole values stay whole.
double roundedIso(double value, const RawVolume& scan, const Histogram& histogram) {
    const double step = scan.values.range().are_integers ? 1 : histogram.width / 8;
    return std::round(value / step) * step;
}

}  // namespace

bool CaseScreen::button(const char* label, bool is_enabled) {
    ImGui::BeginDisabled(!is_enabled);
    const bool is_pressed = ImGui::Button(label);
    ImGui::EndDisabled();
    notePlace(places_, label);
    return is_pressed && is_enabled;
}

bool CaseScreen::choice(const char* label, bool is_chosen) {
    const bool is_pressed = ImGui::RadioButton(label, is_chosen);
    notePlace(places_, label);
    return is_pressed && !is_chosen;
}

// Returns true when it was entered; so much of the line stays free at the right.
bool CaseScreen::isTyped(const char* label, const char* hint, std::string& text, float free_width) {
    char typed[kLongestText] = {};
    std::strncpy(typed, text.c_str(), sizeof typed - 1);
    ImGui::SetNextItemWidth(free_width > 0 ? -free_width : -1);
    const bool is_entered =
        ImGui::InputTextWithHint(label, hint, typed, sizeof typed, ImGuiInputTextFlags_EnterReturnsTrue);
    notePlace(places_, label);
    text = typed;
    return is_entered;
}

bool CaseScreen::slider(const char* label, float& value, float low, float high, const char* format,
                        int flags) {
    ImGui::SetNextItemWidth(-110 * stage_.scale());
    const bool is_moved = ImGui::SliderFloat(label, &value, low, high, format, flags);
    notePlace(places_, label);
    return is_moved;
}

void CaseScreen::say(const std::string& text) {
    say(text, ImGui::GetStyle().Colors[ImGuiCol_TextDisabled]);
}

void CaseScreen::say(const std::string& text, const ImVec4& colour) {
    ImGui::PushStyleColor(ImGuiCol_Text, colour);
    ImGui::TextWrapped("%s", text.c_str());
    ImGui::PopStyleColor();
}

void CaseScreen::buildSteps() {
    if (isStepOpen(tr("1  Scan"))) buildScan();
    if (desk_.scan()) {
        if (isStepOpen(tr("2  Bone"))) buildBone();
        if (isStepOpen(tr("3  Place"))) buildPlace();
        if (isStepOpen(tr("4  Structures"))) buildStructures();
    }
    if (isStepOpen(desk_.scan() ? tr("5  Case") : tr("Case"))) buildCase();
}

void CaseScreen::buildScan() {
    const float buttons = roomForButtons(tr("Open"), tr("Browse"), 124 * stage_.scale());
    const bool is_entered = isTyped("##scan", tr("folder or file of a scan"), typed_path_, buttons);
    ImGui::SameLine();
    if ((button(tr("Open"), !typed_path_.empty()) || is_entered) && !typed_path_.empty())
        desk_.open(typed_path_);
    ImGui::SameLine();
    if (button(tr("Browse"))) {
        browses_for_labels_ = false;
        browse_.open(tr("Where is the scan?"), typed_path_, true);
    }
    if (desk_.series().size() > 1) buildSeries();
    if (const RawVolume* const scan = desk_.scan()) {
        const VolumeGeometry& grid = scan->geometry;
        const Eigen::Vector3d mm = grid.spacing * kPerMillimetre;
        say(tr("{1} voxels of {2} mm", {printed("%d x %d x %d", grid.dims.x(), grid.dims.y(), grid.dims.z()),
                                        printed("%.3g x %.3g x %.3g", mm.x(), mm.y(), mm.z())}));
    }
}

void CaseScreen::buildSeries() {
    constexpr int kColumns = 4;
    const float height =
        std::min(float(desk_.series().size()) + 1.6f, 7.f) * ImGui::GetTextLineHeightWithSpacing();
    constexpr ImGuiTableFlags kFlags = ImGuiTableFlags_ScrollY | ImGuiTableFlags_ScrollX |
                                       ImGuiTableFlags_RowBg | ImGuiTableFlags_SizingFixedFit;
    if (!ImGui::BeginTable("##series", kColumns, kFlags, ImVec2(0, height))) return;
    ImGui::TableSetupScrollFreeze(0, 1);
    for (const char* const head : {trMark("series"), trMark("kernel"), trMark("slices"), trMark("voxel mm")})
        ImGui::TableSetupColumn(tr(head));
    ImGui::TableHeadersRow();
    for (size_t n = 0; n < desk_.series().size(); ++n) {
        const SeriesRow& row = desk_.series()[n];
        ImGui::TableNextRow();
        ImGui::TableNextColumn();
        const std::string name = row.modality + " " + (row.description == "-" ? row.uid : row.description) +
                                 (row.acquisition == "-" ? "" : " " + row.acquisition) +
                                 (row.is_recommended ? tr("  (best for bone)") : "");
        const std::string label = "series " + std::to_string(n + 1);
        ImGui::PushID(int(n));
        if (ImGui::Selectable(name.c_str(), desk_.chosenSeries() == n, ImGuiSelectableFlags_SpanAllColumns))
            desk_.chooseSeries(n);
        ImGui::PopID();
        notePlace(places_, label);
        if (ImGui::IsItemHovered())
            ImGui::SetTooltip("%s\n%s\n%s", row.uid.c_str(),
                              tr("{1}, contrast {2}", {row.size, row.contrast}).c_str(), row.remark.c_str());
        for (const std::string& cell : {row.kernel, row.slices, row.voxel_mm}) {
            ImGui::TableNextColumn();
            ImGui::TextUnformatted(cell.c_str());
        }
    }
    ImGui::EndTable();
}

void CaseScreen::buildBone() {
    buildIso();
    buildWindow();
    buildPieces();
}

void CaseScreen::buildIso() {
    const Histogram& histogram = desk_.histogram();
    const std::optional<double> iso = desk_.iso();
    const auto& proposed = desk_.proposed();
    const auto runner_up = proposed ? proposed->runner_up : std::nullopt;
    const auto moved =
        plotHistogram(histogram, iso, runner_up, desk_.window, kPlotHeight * stage_.scale(), places_);
    const bool is_line_held = ImGui::IsItemActive();
    const ValueRange& range = desk_.scan()->values.range();
    const double high =
        std::min(range.high, histogram.low + histogram.width * double(histogram.count.size()));
    const auto take = [&](double value) {
        const double least = std::max(range.low, histogram.low);
        desk_.setIso(roundedIso(std::clamp(value, least, high), *desk_.scan(), histogram));
    };
    if (moved) take(*moved);
    auto value = float(iso.value_or((range.low + high) / 2));
    if (slider(tr("iso-value"), value, float(std::max(range.low, histogram.low)), float(high),
               range.are_integers ? "%.0f" : "%.4g"))
        take(double(value));
    desk_.hold(is_line_held || ImGui::IsItemActive());
    if (!proposed) return;
    say(tr("Proposed: {1}, {2} ({3}).",
           {printed("%.4g", proposed->value), doubtText(proposed->doubt), proposed->why}) +
        (runner_up ? tr(" It could be {1}, too.", {printed("%.4g", *runner_up)}) : ""));
    if (desk_.request().iso && button(tr("Take the proposal"))) desk_.setIso(std::nullopt);
    if (runner_up && desk_.request().iso != runner_up) {
        if (desk_.request().iso) ImGui::SameLine();
        if (button(tr("Take the other"))) desk_.setIso(*runner_up);
    }
}

void CaseScreen::buildWindow() {
    const Histogram& histogram = desk_.histogram();
    const double low = histogram.low,
                 high = low + std::max(histogram.width * double(histogram.count.size()), 1e-6);
    auto level = float(desk_.window.level), width = float(desk_.window.width);
    if (slider(tr("grey level"), level, float(low), float(high), "%.4g")) desk_.window.level = double(level);
    if (slider(tr("grey width"), width, float((high - low) / 256), float(2 * (high - low)), "%.4g",
               ImGuiSliderFlags_Logarithmic))
        desk_.window.width = double(width);
}

void CaseScreen::buildPieces() {
    const CaseBone* const bone = desk_.bone();
    if (!bone) return;
    const float rows = std::min(float(bone->pieces.size()), 5.5f);
    ImGui::TextUnformatted(tr("Pieces of bone (ticked: kept)"));
    if (ImGui::BeginChild("pieces", ImVec2(0, rows * ImGui::GetFrameHeightWithSpacing()))) {
        const std::vector<uint32_t> dropped = desk_.request().drop_pieces;
        for (size_t n = 0; n < bone->pieces.size(); ++n) {
            const CasePiece& piece = bone->pieces[n];
            bool is_kept = std::ranges::find(dropped, n + 1) == dropped.end();
            const std::string label = "piece " + std::to_string(n + 1);
            if (ImGui::Checkbox(
                    printed("%zu   %.3g cm\xc2\xb3", n + 1, piece.volume * kPerCubicCentimetre).c_str(),
                    &is_kept))
                desk_.keepPiece(n, is_kept);
            notePlace(places_, label);
            ImGui::SameLine();
            ImGui::PushID(int(n));
            if (ImGui::SmallButton(tr("show"))) desk_.moveCross(piece.middle);
            ImGui::PopID();
        }
    }
    ImGui::EndChild();
    if (bone->noise_pieces > 0)
        say(tr("{1} smaller ones are taken for noise.", {std::to_string(bone->noise_pieces)}));
}

void CaseScreen::buildPlace() {
    if (choice(tr("All of the bone is milled"), !desk_.isOfPart())) desk_.millPart(false);
    if (choice(tr("A part of it, with fine voxels"), desk_.isOfPart())) desk_.millPart(true);
    if (desk_.isOfPart()) {
        auto size = float(desk_.sizeMm());
        if (slider(tr("edge mm"), size, 2, 200, "%.0f", ImGuiSliderFlags_Logarithmic))
            desk_.setSizeMm(std::clamp(std::round(double(size)), 2.0, 500.0));
        if (button(tr("Place it at the cross"))) desk_.placeAt(desk_.marks().cross_W);
        say(tr("The green box is what is milled: drag its middle in the slices."));
    }
    say(tr("The hand comes along the red arrow: drag its round end in the slices."));
    if (desk_.isHandChosen() && button(tr("Let it come from outside"))) desk_.bringHandFromOutside();
    if (!desk_.planProblem().empty()) say(desk_.planProblem(), ImVec4(1.00f, 0.80f, 0.35f, 1));
}

void CaseScreen::buildStructures() {
    const float buttons = roomForButtons(tr("Open map"), tr("Browse"), 148 * stage_.scale());
    const bool is_entered = isTyped("##labels", tr("label map, if there is one"), typed_labels_, buttons);
    ImGui::SameLine();
    if ((button(tr("Open map"), !typed_labels_.empty()) || is_entered) && !typed_labels_.empty())
        desk_.openLabels(typed_labels_);
    ImGui::SameLine();
    if (button((tr("Browse") + std::string("##labels")).c_str())) {
        browses_for_labels_ = true;
        browse_.open(tr("Where is the label map?"), typed_labels_.empty() ? typed_path_ : typed_labels_,
                     false);
    }
    if (desk_.structures().empty()) return;
    const float rows = std::min(float(desk_.structures().size()), 6.5f);
    if (ImGui::BeginChild("structures", ImVec2(0, rows * ImGui::GetFrameHeightWithSpacing())))
        for (size_t row = 0; row < desk_.structures().size(); ++row) buildStructure(row);
    ImGui::EndChild();
}

void CaseScreen::buildStructure(size_t row) {
    const char* const kUses[] = {trIn("use", "ignored"), trIn("use", "shown"), trIn("use", "protected"),
                                 trIn("use", "target")};
    StructureRow& structure = desk_.structures()[row];
    ImGui::PushID(int(row));
    const auto tint = structureTint(row);
    ImGui::ColorButton("##tint", ImVec4(tint[0] / 255.f, tint[1] / 255.f, tint[2] / 255.f, 1),
                       ImGuiColorEditFlags_NoTooltip);
    ImGui::SameLine();
    ImGui::SetNextItemWidth(96 * stage_.scale());
    int use = int(structure.use);
    if (ImGui::Combo("##use", &use, kUses, int(std::size(kUses)))) structure.use = StructureUse(use);
    notePlace(places_, "use of " + structure.name);
    ImGui::SameLine();
    if (structure.number) {
        ImGui::Text("%u", *structure.number);
        ImGui::SameLine();
        isTyped("##name", tr("name"), structure.name, 0);
    } else {
        ImGui::TextUnformatted(structure.name.c_str());
    }
    ImGui::PopID();
}

void CaseScreen::buildTools() {
    const std::filesystem::path chosen = desk_.tools();
    const std::string shown = chosen.empty() ? tr("the default burr") : chosen.stem().string();
    ImGui::SetNextItemWidth(-110 * stage_.scale());
    const bool is_open = ImGui::BeginCombo(tr("burrs"), shown.c_str());
    notePlace(places_, tr("burrs"));
    if (!is_open) return;
    if (ImGui::Selectable(tr("the default burr"), chosen.empty())) desk_.tools().clear();
    for (const std::filesystem::path& set : tool_sets_) {
        if (ImGui::Selectable(set.stem().c_str(), chosen == set)) desk_.tools() = set.string();
        notePlace(places_, set.stem().string());
    }
    ImGui::EndCombo();
}

void CaseScreen::buildCase() {
    const float labels = 110 * stage_.scale();
    buildTools();
    isTyped(tr("title"), tr("what people read in lists"), desk_.title(), labels);
    isTyped(tr("new folder"), tr("for the case"), desk_.out(), labels);
    const std::string why_not = desk_.whyNotYet();
    ImGui::PushStyleColor(ImGuiCol_Button, ImVec4(0.13f, 0.48f, 0.26f, 1));
    ImGui::PushStyleColor(ImGuiCol_ButtonHovered, ImVec4(0.18f, 0.60f, 0.33f, 1));
    if (button(tr("Make the case"), desk_.takesMake())) desk_.make();
    ImGui::PopStyleColor(2);
    if (desk_.waitsToMake())
        say(tr("Now: {1}; then the case is made.", {desk_.busyWith()}));
    else if (!why_not.empty())
        say(why_not);
    if (!desk_.madeScene().empty()) {
        say(tr("Made: {1}", {desk_.madeScene()}), ImVec4(0.45f, 0.9f, 0.55f, 1));
        if (!offers_milling_)
            say(tr("Mill it: bonemill start {1}", {desk_.madeScene()}));
        else if (button(tr("Mill it")))
            milling_ = desk_.madeScene();
    }
}

}  // namespace bonemill
