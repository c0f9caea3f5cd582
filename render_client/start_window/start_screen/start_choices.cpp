// The columns at both sides of the cards.
#include <imgui.h>

#include <algorithm>
#include <utility>
#include <vector>

#include "common/base/user_error.h"
#include "render_client/language/language.h"
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
    return hand.kind == "mouse" ? tr("Mouse") : hand.kind + ": " + hand.text;
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
        heading(tr("The hand"));
        buildHands();
        heading(tr("For whom"));
        buildCompany();
    }
    heading(tr("More"));
    if (has_scenes && button(tr("New case from a scan"))) desk_.makeCase();
    if (button(tr("Handbook"))) desk_.openHandbook();
    if (languages().size() > 1) buildLanguages();
}

// Whoever cannot read the language that is spoken finds the others by their own names.
void StartScreen::buildLanguages() {
    heading("Language / Sprache / Spr\u00e5k");
    for (const Language& language : languages()) {
        if (!choice(language.name, language.code == spokenLanguage())) continue;
        try {
            chooseLanguage(language.code);
        } catch (const UserError& error) {
            problem_ = error.what();
        }
    }
}

void StartScreen::buildHands() {
    StartChoice& wish = desk_.choice();
    const auto& doctor = desk_.doctor();
    const FoundHand* const best = doctor ? bestOf(*doctor) : nullptr;
    if (choice(tr("The best that is there"), wish.device.empty())) wish.device.clear();
    say(!doctor ? tr("looking ...") : best ? tr("now: {1}", {nameOf(*best)}) : tr("now: the mouse"));
    if (doctor)
        for (const FoundHand& hand : doctor->hands)
            if (!hand.word.empty() && choice(nameOf(hand), wish.device == hand.word)) wish.device = hand.word;
    if (choice(tr("Scripted: it shows how"), wish.device == "simulated")) wish.device = "simulated";
}

void StartScreen::buildCompany() {
    StartChoice& wish = desk_.choice();
    const std::vector<std::string>& interfaces = desk_.list().interfaces;
    if (choice(tr("Me alone"), !wish.is_class)) wish.is_class = false;
    if (choice(tr("Host a class"), wish.is_class)) wish.is_class = true;
    if (!wish.is_class) return;
    say(tr("Other PCs may watch. The way to them:"));
    if (wish.interface.empty() && !interfaces.empty()) wish.interface = interfaces.front();
    for (const std::string& name : interfaces)
        if (choice(name, wish.interface == name)) wish.interface = name;
    if (interfaces.empty()) say(tr("this PC has no network"), kOpen);
    isTyped("##class", tr("name of the class"), class_);
    wish.class_name = class_.data();
}

void StartScreen::buildPast() {
    heading(tr("Last sessions"));
    const auto& attempts = desk_.attempts();
    const auto& recordings = desk_.list().recordings;
    if (attempts.empty() && recordings.empty()) say(tr("none yet"));
    for (size_t n = 0; n < std::min(attempts.size(), kMostAttempts); ++n) {
        const PastAttempt& attempt = attempts[n];
        const std::string id = std::to_string(n + 1);
        ImGui::TextUnformatted((attempt.scene + ", " + attempt.trainee).c_str());
        say(attempt.start + ", " + attempt.score);
        if (!attempt.recording.empty()) {
            if (button(tr("Replay"), id)) desk_.replay(attempt.stem + ".json");
            ImGui::SameLine();
        }
        if (button(tr("Report"), id)) desk_.openReport(attempt);
    }
    size_t shown = 0;
    for (const Recording& recording : recordings) {
        const bool is_told = std::ranges::any_of(
            attempts, [&](const PastAttempt& attempt) { return attempt.recording == recording.file; });
        if (is_told || shown == kMostRecordings) continue;
        const std::string id = "recording " + std::to_string(++shown);
        if (button(tr("Replay"), id)) desk_.replay(recording.file);
        ImGui::SameLine();
        say(tr("{1}, without an attempt", {recording.when}));
    }
}

void StartScreen::buildOthers() {
    heading(tr("Watch"));
    for (const RunningSession& session : desk_.list().running) {
        say(tr("session {1} on this PC: {2} since {3}", {session.number, session.scene, session.since}));
        if (button(tr("Watch"), session.number)) desk_.watchOwn(session);
        ImGui::SameLine();
        if (button(tr("End"), session.number)) desk_.endOwn(session);
    }
    for (const FoundSession& session : desk_.found()) {
        say(tr("{1} since {2} on {3}", {session.scene, session.since, session.host}));
        if (button(tr("Watch"), session.host + " " + session.number)) desk_.watch(session);
    }
    if (isTyped("##host", tr("a PC's name or address, then Enter"), host_)) desk_.watchHost(host_.data());
}

void StartScreen::buildThisPc() {
    heading(tr("This PC"));
    if (!desk_.doctor()) {
        say(tr("looking ..."));
        return;
    }
    for (const auto& [part, title] : {std::pair{"Programs", trMark("Programs")},
                                      {"Real time", trMark("Real time")},
                                      {"Network", trMark("Network")},
                                      {"Display", trMark("Graphics")}})
        buildPart(part, tr(title));
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
    const char* const state = open.empty() ? tr("good")
                              : is_missing ? tr("something is missing")
                                           : tr("could be better");
    ImGui::PushStyleColor(ImGuiCol_Text, open.empty() ? kGood : kOpen);
    const bool is_open =
        ImGui::TreeNodeEx(part, open.empty() ? ImGuiTreeNodeFlags_Leaf : 0, "%s: %s", title, state);
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
    const bool is_open = ImGui::TreeNodeEx(
        "hand", is_good ? ImGuiTreeNodeFlags_Leaf : 0, "%s: %s", tr("Hand"),
        is_good ? (best ? nameOf(*best).c_str() : trIn("hand", "none")) : tr("one is not ready"));
    ImGui::PopStyleColor();
    notePlace(places_, tr("Hand"));
    if (!is_open) return;
    for (const FoundHand& hand : facts.hands) {
        if (!waits(hand)) continue;
        say(hand.kind + ": " + hand.text);
        buildCommand(hand.command);
    }
    ImGui::TreePop();
}

void StartScreen::buildCommand(const std::string& command) {
    if (button(tr("Copy"), command)) ImGui::SetClipboardText(command.c_str());
    ImGui::SameLine();
    say(command, ImGui::GetStyle().Colors[ImGuiCol_Text]);
}

}  // namespace bonemill
