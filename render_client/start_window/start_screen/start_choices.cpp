// The columns at both sides of the cards.
#include <imgui.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "render_client/start_window/start_screen/start_colours.h"
#include "render_client/start_window/start_screen/start_screen.h"

namespace bonemill {
namespace {

constexpr size_t kMostAttempts = 5, kMostRecordings = 3;

const FoundHand* bestOf(const DoctorFacts& facts) {
    const auto best = std::ranges::find_if(
        facts.hands, [](const FoundHand& hand) { return hand.is_ready && !hand.word.empty(); });
    return best == facts.hands.end() ? nullptr : &*best;
}

std::string nameOf(const FoundHand& hand) {
    return hand.kind == "mouse" ? "Mouse" : hand.kind + ": " + hand.text;
}

}  // namespace

void StartScreen::heading(const char* text) {
    ImGui::Dummy(ImVec2(0, ImGui::GetStyle().ItemSpacing.y));
    ImGui::TextColored(kHeading, "%s", text);
}

void StartScreen::say(const std::string& text) {
    say(text, kAside);
}

void StartScreen::say(const std::string& text, const ImVec4& colour) {
    ImGui::PushTextWrapPos();
    ImGui::TextColored(colour, "%s", text.c_str());
    ImGui::PopTextWrapPos();
}

bool StartScreen::button(const std::string& label, const std::string& id) {
    const bool is_pressed = ImGui::Button((label + "##" + id).c_str());
    notePlace(places_, id.empty() ? label : label + " " + id);
    return is_pressed;
}

bool StartScreen::choice(const std::string& label, bool is_chosen) {
    const bool is_pressed = ImGui::RadioButton(label.c_str(), is_chosen);
    notePlace(places_, label);
    return is_pressed;
}

// Returns true when it was entered.
template <size_t Size>
bool StartScreen::isTyped(const char* label, const char* hint, std::array<char, Size>& text) {
    ImGui::SetNextItemWidth(-1);
    const bool is_entered =
        ImGui::InputTextWithHint(label, hint, text.data(), text.size(), ImGuiInputTextFlags_EnterReturnsTrue);
    notePlace(places_, label);
    return is_entered;
}

void StartScreen::buildChoices() {
    const bool has_scenes = !desk_.list().scenes.empty();  // a PC that only watches has none
    if (has_scenes) {
        heading("The hand");
        buildHands();
        heading("For whom");
        buildCompany();
    }
    heading("More");
    if (has_scenes && button("New case from a scan")) desk_.makeCase();
    if (button("Handbook")) desk_.openHandbook();
}

void StartScreen::buildHands() {
    StartChoice& wish = desk_.choice();
    const auto& doctor = desk_.doctor();
    const FoundHand* const best = doctor ? bestOf(*doctor) : nullptr;
    if (choice("The best that is there", wish.device.empty())) wish.device.clear();
    say(!doctor ? "looking ..." : best ? "now: " + nameOf(*best) : "now: the mouse");
    if (doctor)
        for (const FoundHand& hand : doctor->hands)
            if (!hand.word.empty() && choice(nameOf(hand), wish.device == hand.word)) wish.device = hand.word;
    if (choice("Scripted: it shows how", wish.device == "simulated")) wish.device = "simulated";
}

void StartScreen::buildCompany() {
    StartChoice& wish = desk_.choice();
    const std::vector<std::string>& interfaces = desk_.list().interfaces;
    if (choice("Me alone", !wish.is_class)) wish.is_class = false;
    if (choice("Host a class", wish.is_class)) wish.is_class = true;
    if (!wish.is_class) return;
    say("Other PCs may watch. The way to them:");
    if (wish.interface.empty() && !interfaces.empty()) wish.interface = interfaces.front();
    for (const std::string& name : interfaces)
        if (choice(name, wish.interface == name)) wish.interface = name;
    if (interfaces.empty()) say("this PC has no network", kOpen);
    isTyped("##class", "name of the class", class_);
    wish.class_name = class_.data();
}

void StartScreen::buildPast() {
    heading("Last sessions");
    const auto& attempts = desk_.attempts();
    const auto& recordings = desk_.list().recordings;
    if (attempts.empty() && recordings.empty()) say("none yet");
    for (size_t n = 0; n < std::min(attempts.size(), kMostAttempts); ++n) {
        const PastAttempt& attempt = attempts[n];
        const std::string id = std::to_string(n + 1);
        ImGui::TextUnformatted((attempt.scene + ", " + attempt.trainee).c_str());
        say(attempt.start + ", " + attempt.score);
        if (!attempt.recording.empty()) {
            if (button("Replay", id)) desk_.replay(attempt.stem + ".json");
            ImGui::SameLine();
        }
        if (button("Report", id)) desk_.openReport(attempt);
    }
    size_t shown = 0;
    for (const Recording& recording : recordings) {
        const bool is_told = std::ranges::any_of(
            attempts, [&](const PastAttempt& attempt) { return attempt.recording == recording.file; });
        if (is_told || shown == kMostRecordings) continue;
        const std::string id = "recording " + std::to_string(++shown);
        if (button("Replay", id)) desk_.replay(recording.file);
        ImGui::SameLine();
        say(recording.when + ", without an attempt");
    }
}

void StartScreen::buildOthers() {
    heading("Watch");
    for (const RunningSession& session : desk_.list().running) {
        say("session " + session.number + " on this PC: " + session.scene + " since " + session.since);
        if (button("Watch", session.number)) desk_.watchOwn(session);
        ImGui::SameLine();
        if (button("End", session.number)) desk_.endOwn(session);
    }
    for (const FoundSession& session : desk_.found()) {
        say(session.scene + " since " + session.since + " on " + session.host);
        if (button("Watch", session.host + " " + session.number)) desk_.watch(session);
    }
    if (isTyped("##host", "a PC's name or address, then Enter", host_)) desk_.watchHost(host_.data());
}

void StartScreen::buildThisPc() {
    heading("This PC");
    if (!desk_.doctor()) {
        say("looking ...");
        return;
    }
    for (const auto& [part, title] : {std::pair{"Programs", "Programs"},
                                      {"Real time", "Real time"},
                                      {"Network", "Network"},
                                      {"Display", "Graphics"}})
        buildPart(part, title);
    buildHandsState();
}

// Green, or amber with what is missing or could be better first, which a click tells of.
void StartScreen::buildPart(const char* part, const char* title) {
    std::vector<const Finding*> open;
    bool is_missing = false;
    for (const Finding& finding : desk_.doctor()->findings) {
        if (finding.part != part || finding.is_ok) continue;
        open.push_back(&finding);
        is_missing = is_missing || finding.is_needed;
    }
    const std::string state = open.empty() ? "good" : is_missing ? "something is missing" : "could be better";
    ImGui::PushStyleColor(ImGuiCol_Text, open.empty() ? kGood : kOpen);
    const bool is_open =
        ImGui::TreeNodeEx(part, open.empty() ? ImGuiTreeNodeFlags_Leaf : 0, "%s: %s", title, state.c_str());
    ImGui::PopStyleColor();
    notePlace(places_, title);
    if (!is_open) return;
    for (const Finding* const finding : open) {
        say(finding->text);
        for (const std::string& command : finding->commands) buildCommand(command);
    }
    ImGui::TreePop();
}

// Hands that are plugged in, and need something to be typed.
void StartScreen::buildHandsState() {
    const DoctorFacts& facts = *desk_.doctor();
    const auto waits = [](const FoundHand& hand) { return !hand.is_ready && !hand.command.empty(); };
    const bool is_good = std::ranges::none_of(facts.hands, waits);
    const FoundHand* const best = bestOf(facts);
    ImGui::PushStyleColor(ImGuiCol_Text, is_good ? kGood : kOpen);
    const bool is_open =
        ImGui::TreeNodeEx("hand", is_good ? ImGuiTreeNodeFlags_Leaf : 0, "Hand: %s",
                          is_good ? (best ? nameOf(*best).c_str() : "none") : "one is not ready");
    ImGui::PopStyleColor();
    notePlace(places_, "Hand");
    if (!is_open) return;
    for (const FoundHand& hand : facts.hands) {
        if (!waits(hand)) continue;
        say(hand.kind + ": " + hand.text);
        buildCommand(hand.command);
    }
    ImGui::TreePop();
}

void StartScreen::buildCommand(const std::string& command) {
    if (button("Copy", command)) ImGui::SetClipboardText(command.c_str());
    ImGui::SameLine();
    say(command, ImGui::GetStyle().Colors[ImGuiCol_Text]);
}

}  // namespace bonemill
