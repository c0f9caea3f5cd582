// The figures in every language: none is cut short, and the help page has room for all keys' names.
#include <gtest/gtest.h>

#include <algorithm>

#include "common/device_messages/device_messages.h"
#include "render_client/look/hud/conditions.h"
#include "render_client/look/hud/hud_canvas.h"
#include "render_client/look/hud/hud_layout.h"
#include "render_client/look/hud/hud_lines.h"
#include "tests/support/spoken.h"

namespace bonemill {
namespace {

using topics::EffectState;

topics::Status busyStatus() {
    topics::Status status;
    status.set_preset("balanced");
    status.set_ticks(1000), status.set_rate_hz(999.8);
    status.set_tick_p50_us(92), status.set_tick_p99_us(187.4);
    status.set_removed_mm3(1234.5);
    status.set_has_accuracy_error(true);
    status.set_force_error_percent(12.3), status.set_force_direction_error_deg(4.56);
    topics::Device& device = *status.mutable_device();
    device.set_name("ARES"), device.set_state(uint32_t(SafetyState::kEngaged));
    device.set_coupling_share(0.55), device.set_rotation_share(0.05);
    topics::TaskState& task = *status.mutable_task();
    task.set_time_left_s(99), task.set_score(0.8);
    for (const auto role : {scene::Task::TARGET, scene::Task::LEEWAY_SIDES, scene::Task::LEEWAY_BOTTOM,
                            scene::Task::CONTAINER_SIDES, scene::Task::CONTAINER_BOTTOM}) {
        topics::TaskState::Zone& zone = *task.add_zones();
        zone.set_role(role), zone.set_removed_mm3(123.4), zone.set_bone_mm3(500);
    }
    task.add_gates()->set_state(topics::TaskState::Gate::BROKEN);
    return status;
}

topics::ToolState busyTool() {
    topics::ToolState tool;
    for (const double v : {3.0, 0.0, 4.0}) tool.add_force_n(v);
    for (const double v : {0.0, 0.012, 0.0}) tool.add_torque_nm(v);
    tool.set_contacts(117), tool.set_buttons(1);
    tool.set_device_state(uint32_t(SafetyState::kEngaged));
    EffectState& effects = *tool.mutable_effects();
    effects.set_protected_distance_m(-1e-3), effects.set_protected_id(1);
    effects.set_damaged_mm3(12.34), effects.set_necrotic_mm3(12.34), effects.set_temperature_c(47.3);
    effects.set_spin_speed(4000), effects.set_axis_torque_nm(0.0123), effects.set_cutting_power_w(12.3);
    return tool;
}

HudInput busyInput(bool has_details) {
    HudInput input;
    input.info.emplace();
    input.info->set_title("Tooth");
    for (const char* const name : {"6 mm", "3 mm"}) input.info->add_tool_names(name);
    input.info->add_materials()->set_name("nerve");
    input.status = busyStatus();
    input.tool = busyTool();
    input.connection = Connection::kLive;
    input.show_details = has_details;
    input.frame_rate_hz = 60;
    return input;
}

// Returns how often the sign that stands for what is left out is drawn.
long countEllipses(const HudCanvas& canvas) {
    return std::ranges::count_if(canvas.vertices(), [&](const HudCanvas::Vertex& vertex) {
        return std::ranges::any_of(std::array{FontStyle::kPlain, FontStyle::kBold}, [&](FontStyle style) {
            const Glyph& dots = canvas.font().glyph(0x2026, style);
            return vertex.radius < 0 && vertex.u == dots.u0 && vertex.v == dots.v0;
        });
    });
}

// The rows that are cut short, by their number from the top.
std::vector<bool> cutRows(const Hud& hud) {
    static const FontAtlas font(16);
    std::vector<bool> cut;
    for (const auto& rows : {hud.rows, hud.details, {{hud.state, ""}}})
        for (const HudRow& row : rows) {
            HudCanvas canvas(font);
            const bool is_state = row.value.empty();
            layOutFigures(canvas, {.title = hud.title,
                                   .state = is_state ? row.label : "",
                                   .rows = is_state ? std::vector<HudRow>() : std::vector{row}});
            cut.push_back(countEllipses(canvas) > 0);
        }
    return cut;
}

std::string textOf(const Hud& hud, size_t number) {
    std::vector<HudRow> rows = hud.rows;
    rows.insert(rows.end(), hud.details.begin(), hud.details.end());
    return number < rows.size() ? rows[number].label + ": " + rows[number].value : hud.state;
}

// English itself has rows with large numbers that are cut.
void expectNoMoreIsCut(const HudInput& input) {
    const std::vector<bool> cut_in_english = cutRows(makeHud(input));
    EXPECT_LT(std::ranges::count(cut_in_english, true), 4);
    for (const Language& language : languages()) {
        const test::Spoken spoken(language.code);
        const Hud hud = makeHud(input);
        const std::vector<bool> cut = cutRows(hud);
        ASSERT_EQ(cut.size(), cut_in_english.size());
        for (size_t n = 0; n < cut.size(); ++n)
            EXPECT_TRUE(!cut[n] || cut_in_english[n]) << language.name << ": " << textOf(hud, n);
    }
}

TEST(HudLanguage, NoFigureIsCutShort) {
    for (const bool has_details : {false, true}) {
        HudInput input = busyInput(has_details);
        expectNoMoreIsCut(input);
        input.events = EffectState::SPINDLE_STALLED;
        expectNoMoreIsCut(input);
        input.events = 0;
        input.status->mutable_task()->set_is_result(true);
        input.tool->set_waits_for_release(true);
        input.fault_count = 3;
        expectNoMoreIsCut(input);
        input.status->clear_task();
        input.tool->mutable_effects()->clear_protected_distance_m();
        input.tool->set_waits_for_release(false);
        for (const uint32_t buttons : {0, 2}) {
            input.tool->set_buttons(buttons);
            expectNoMoreIsCut(input);
        }
        for (uint32_t state = 0; state < kSafetyStateCount; ++state) {
            input.tool->set_device_state(state);
            expectNoMoreIsCut(input);
        }
    }
}

TEST(HudLanguage, EveryStateHasRoom) {
    HudInput input = busyInput(false);
    for (const Connection connection : {Connection::kNoServer, Connection::kReceiving, Connection::kLive,
                                        Connection::kServerLost, Connection::kServerEnded}) {
        input.connection = connection;
        expectNoMoreIsCut(input);
    }
    input.connection = Connection::kLive;
    topics::Replay& replay = *input.status->mutable_replay();
    expectNoMoreIsCut(input);
    replay.mutable_comparison()->set_is_on_its_way(true);
    replay.set_is_playing(true), replay.set_speed(0.5);
    expectNoMoreIsCut(input);
    replay.set_is_seeking(true);
    replay.mutable_comparison()->set_problem("none");
    expectNoMoreIsCut(input);
}

TEST(HudLanguage, AlertsAndFaultsAreTold) {
    const test::Spoken spoken("de");
    HudInput input = busyInput(false);
    input.events = EffectState::PROTECTED_TOUCHED | EffectState::TOO_HOT;
    input.structure = 1;
    EXPECT_EQ(alertOf(input)->text, "Ber\u00fchrt: nerve, Knochen zu hei\u00df");
    EXPECT_EQ(faultWords("stalled").at(0).text,
              "Die Kraft war etwas falsch und berichtigt sich selbst. Sie k\u00f6nnen weitermachen.");
    EXPECT_EQ(faultWords("stalled").at(0).id, "stalled");
}

}  // namespace
}  // namespace bonemill
