#include "common/config/scene_file.h"

#include <gtest/gtest.h>
#include <unistd.h>

#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>

#include "common/base/user_error.h"
#include "common/config/field_unit.h"
#include "common/config/scene_table.h"
#include "common/config/scene_tools.h"
#include "tests/support/places.h"

namespace bonemill {
namespace {

namespace fs = std::filesystem;

class SceneFile : public ::testing::Test {
  protected:
    void SetUp() override {
        folder_ = fs::temp_directory_path() / ("bonemill_scene_" + std::to_string(getpid()));
        fs::create_directories(folder_);
    }
    void TearDown() override { fs::remove_all(folder_); }

    fs::path write(const std::string& text) const {
        const fs::path file = folder_ / "s.textproto";
        std::ofstream(file, std::ios::binary) << text;
        return file;
    }
    // The message comes without the folder, which differs from run to run.
    std::string refusal(const std::string& text) const { return refusalOf(write(text)); }
    std::string refusalOf(const fs::path& file) const {
        try {
            loadScene(file);
        } catch (const UserError& error) {
            const std::string message = error.what();
            const std::string prefix = folder_.string() + "/";
            return message.starts_with(prefix) ? message.substr(prefix.size()) : message;
        }
        return "accepted";
    }
    fs::path folder_;
};

TEST_F(SceneFile, loadsFieldsAndKeepsDefaults) {
    const LoadedScene loaded =
        loadScene(write("name: 'a' volume { path: 'v.nrrd' iso_value: 600 }\n"
                        "device { p_WD_mm { x: 1 y: -2.5 } }"));
    EXPECT_EQ(loaded.scene.name(), "a");
    EXPECT_EQ(loaded.scene.volume().iso_value(), 600.0);
    EXPECT_EQ(loaded.scene.device().p_wd_mm().y(), -2.5);
    EXPECT_EQ(loaded.scene.coupling().max_speed_mm_per_s(), 500.0);
    EXPECT_FALSE(loaded.scene.volume().has_window_low());
}

TEST_F(SceneFile, relativePathsStartAtTheSceneFile) {
    const LoadedScene loaded = loadScene(write("volume { path: 'v.nrrd' }"));
    EXPECT_EQ(resolvePath(loaded, "sub/../v.nrrd"), folder_ / "v.nrrd");
    EXPECT_EQ(resolvePath(loaded, "/data/v.nrrd"), "/data/v.nrrd");
}

TEST_F(SceneFile, refusesWhatIsNotAReadableFile) {
    EXPECT_EQ(refusalOf(folder_ / "none.textproto"), "none.textproto: scene file not found");
    EXPECT_EQ(refusalOf(folder_ / "none" / "s.textproto"), "none/s.textproto: scene file not found");
    EXPECT_EQ(refusalOf(folder_), folder_.string() + ": is not a file; a scene is a .textproto file");
    EXPECT_EQ(refusal(std::string(5 << 20, ' ')),
              "s.textproto: is 5242880 bytes; a scene has at most 4194304");
}

TEST_F(SceneFile, misspeltFieldNamesTheNearestOne) {
    EXPECT_EQ(
        refusal("volume { path: 'v' }\n\ncoupling {\n  max_sped_mm_per_s: 3\n}"),
        "s.textproto:4: unknown field `max_sped_mm_per_s` in Coupling; did you mean `max_speed_mm_per_s`?");
    EXPECT_EQ(refusal("volume { iso: 3 }").substr(0, 52),
              "s.textproto:1: unknown field `iso` in Volume; known ");
    EXPECT_EQ(refusal("coupling { static_dampin: 3 }"),
              "s.textproto:1: unknown field `static_dampin` in Coupling; did you mean `static_damping`?");
    EXPECT_EQ(refusal("device { link_length: 3 }"),
              "s.textproto:1: unknown field `link_length` in Device; did you mean `link_length_mm`?");
}

TEST_F(SceneFile, badSyntaxNamesTheLine) {
    EXPECT_EQ(refusal("name: 'a'\nvolume {\n").substr(0, 14), "s.textproto:3:");
    EXPECT_EQ(refusal("name: 'a'\nname: 'b'").substr(0, 14), "s.textproto:2:");
    EXPECT_EQ(refusal("accuracy {\nswitchable: ture }").substr(0, 14), "s.textproto:2:");
    EXPECT_EQ(refusal("accuracy { shell_factor: -1 }").substr(0, 14), "s.textproto:1:");
    EXPECT_EQ(refusal(std::string("\x7f"
                                  "ELF\0\1\2",
                                  7))
                  .substr(0, 14),
              "s.textproto:1:");
}

TEST_F(SceneFile, valueOutsideItsRangeNamesFieldValueRangeAndUnit) {
    EXPECT_EQ(refusal("volume { path: 'v' }\ncoupling {\n  max_speed_mm_per_s: -3\n}"),
              "s.textproto:3: field `coupling.max_speed_mm_per_s` = -3 is outside 1 .. 1000000 (mm/s)");
    EXPECT_EQ(refusal("volume { path: 'v' }\ntool { burr_radius_mm: -1 }"),
              "s.textproto:2: field `tool[0].burr_radius_mm` = -1 is outside 0.01 .. 50 (mm)");
    EXPECT_EQ(refusal("volume { path: 'v' }\ntool { shape { sphere { radius_mm: 1 } }\nshape { sphere "
                      "{\nradius_mm: 0 } } }"),
              "s.textproto:4: field `tool[0].shape[1].sphere.radius_mm` = 0 is outside 0.01 .. 100 (mm)");
    EXPECT_EQ(refusal("volume { path: 'v' leaf_voxels: 40 }"),
              "s.textproto:1: field `volume.leaf_voxels` = 40 is outside 4 .. 31 (voxels)");
    EXPECT_EQ(refusal("device { p_WD_mm { z: 1e7 } }"),
              "s.textproto:1: field `device.p_WD_mm.z` = 1e+07 is outside -1000000 .. 1000000 (mm)");
}

TEST_F(SceneFile, samplesAreNotInfinitelyFine) {
    const std::string path = "volume { path: 'v' }\naccuracy { sample_spacing_um: ";
    for (const char* spacing : {"1e-14", "0.99"})
        EXPECT_EQ(refusal(path + spacing + " }"),
                  "s.textproto:2: field `accuracy.sample_spacing_um` = " + std::string(spacing) +
                      " is finer than 1 (µm): give that or more, or 0 for one sample per contact point");
    for (const char* spacing : {"0", "1"}) EXPECT_EQ(refusal(path + spacing + " }"), "accepted");
}

TEST_F(SceneFile, listElementsWithoutALineOfTheirOwnNameTheNearestLine) {
    EXPECT_EQ(
        refusal("volume { path: 'v' }\nsimulated_operator { waypoint: [ { time_s: 0 },\n { time_s: -5 } ] }"),
        "s.textproto:3: field `simulated_operator.waypoint[1].time_s` = -5 is outside 0 .. 86400 (s)");
}

TEST_F(SceneFile, refusesWhatIsNotFinite) {
    EXPECT_EQ(refusal("loop { rate_hz: nan }"),
              "s.textproto:1: field `loop.rate_hz` = nan is not a finite number");
    EXPECT_EQ(refusal("loop { rate_hz: inf }"),
              "s.textproto:1: field `loop.rate_hz` = inf is not a finite number");
    EXPECT_EQ(refusal("loop { rate_hz: -1e999 }"),
              "s.textproto:1: field `loop.rate_hz` = -inf is not a finite number");
}

TEST_F(SceneFile, volumePathIsRequired) {
    EXPECT_EQ(refusal(""),
              "s.textproto: field `volume.path` is missing: name the file or DICOM folder of the bone");
    EXPECT_EQ(refusal("name: 'x'\nvolume { }"),
              "s.textproto:2: field `volume.path` is missing: name the file or DICOM folder of the bone");
}

TEST_F(SceneFile, windowAndIsoValueMustAgree) {
    const std::string path = "volume { path: 'v'\n";
    EXPECT_EQ(refusal(path + "window_low: 5 window_high: 5 }"),
              "s.textproto:2: field `volume.window_low` = 5 is not below window_high = 5");
    EXPECT_EQ(refusal(path + "window_low: 5 iso_value: 5 }"),
              "s.textproto:2: field `volume.iso_value` = 5 is not above window_low = 5");
    EXPECT_EQ(refusal(path + "window_high: 5 iso_value: 6 }"),
              "s.textproto:2: field `volume.iso_value` = 6 is above window_high = 5");
    EXPECT_EQ(refusal(path + "window_low: 0 window_high: 5 iso_value: 5 }"), "accepted");
}

TEST_F(SceneFile, waypointTimesMustIncrease) {
    EXPECT_EQ(
        refusal(
            "volume { path: 'v' }\nsimulated_operator {\nwaypoint { time_s: 1 }\nwaypoint { time_s: 1 } }"),
        "s.textproto:4: field `simulated_operator.waypoint[1].time_s` = 1 does not come after the waypoint "
        "before "
        "it (1 s): times must increase");
}

TEST_F(SceneFile, quaternionsMustHaveLengthOne) {
    EXPECT_EQ(refusal("volume { path: 'v' }\ndevice { q_WD { w: 0 } }"),
              "s.textproto:2: field `device.q_WD` has length 0, not 1 (w is 1 where it is not written: write "
              "all of w, "
              "x, y, z)");
    EXPECT_NE(refusal("volume { path: 'v' }\ndevice { q_WD { x: 1 } }"), "accepted");
    EXPECT_EQ(refusal("volume { path: 'v' }\ndevice { q_WD { w: 0.7071 x: 0.7071 } }"), "accepted");
}

TEST_F(SceneFile, toolIsMadeOfShapesOrOfAMesh) {
    EXPECT_EQ(
        refusal("volume { path: 'v' }\ntool { shape { } }"),
        "s.textproto:2: field `tool[0].shape[0]` is empty: give it a sphere, capsule, cylinder or cone");
    EXPECT_NE(refusal("volume { path: 'v' }\ntool { shape { sphere { } } mesh_path: 'a.stl' }"), "accepted");
}

TEST_F(SceneFile, aBurrThatIsNoBallSaysHowLongItIs) {
    EXPECT_EQ(refusal("volume { path: 'v' }\n"
                      "tool {\n  burr_kind: CYLINDER }"),
              "s.textproto:2: field `tool[0].burr_length_mm` is missing: a burr_kind of CYLINDER needs it");
    EXPECT_EQ(refusal("volume { path: 'v' } tool { burr_kind: CONE burr_length_mm: 2 }"), "accepted");
}

TEST_F(SceneFile, effectsByTimeKnowOnlyABall) {
    for (const std::string effect : {"time_removal", "add_material"})
        EXPECT_EQ(refusal("volume { path: 'v' } tool {} effects { " + effect +
                          " {} }\n"
                          "tool { burr_length_mm: 2\n burr_kind: CYLINDER }"),
                  "s.textproto:3: field `tool[1].burr_kind` = CYLINDER does not go with effects." + effect +
                      ", which knows only a BALL");
}

TEST_F(SceneFile, effectsThatTurnNeedTheToolsSpeed) {
    EXPECT_EQ(refusal("volume { path: 'v' }\n"
                      "tool { speed_rpm: 9000 }\n"
                      "tool { name: 'b' }\n"
                      "effects { energy_removal {} }"),
              "s.textproto:3: field `tool[1].speed_rpm` is missing: effects.energy_removal needs it");
    EXPECT_EQ(
        refusal("volume { path: 'v' }\n effects {\n spindle {} }"),
        "s.textproto:3: field `effects.spindle` needs a tool that turns: list one in tool, with speed_rpm");
    EXPECT_EQ(refusal("volume { path: 'v' } tool { speed_rpm: -9000 } effects { energy_removal {} }"),
              "accepted");
}

TEST_F(SceneFile, bleedingNamesMaterialsOfTheScene) {
    const std::string scene =
        "volume { path: 'v' } material { name: 'core' from_value: 100 }\n"
        "effects { bleeding { material: 'core'\n material: ";
    EXPECT_EQ(refusal(scene + "'corr' } }"),
              "s.textproto:3: field `effects.bleeding.material[1]` = \"corr\" is no material of this scene");
    EXPECT_EQ(refusal(scene + "'core' } }"), "accepted");
}

TEST_F(SceneFile, heatNeedsRoomAndAnOrderOfTemperatures) {
    const std::string scene = "volume { path: 'v' } tool { speed_rpm: 9000 }\neffects { thermal {\n ";
    EXPECT_EQ(refusal(scene + "body_temperature_c: 40 necrosis_temperature_c: 38 } }"),
              "s.textproto:3: field `effects.thermal.necrosis_temperature_c` = 38 is not above "
              "body_temperature_c = 40");
    EXPECT_NE(refusal(scene + "cell_mm: 0.2 conductivity_w_per_m_k: 20 heat_capacity_j_per_cm3_k: 0.1 } }"),
              "accepted");
    EXPECT_EQ(refusal(scene + "cell_mm: 0.5 } }"), "accepted");
}

TEST_F(SceneFile, soundNeedsAnEffectThatKnowsTheBurrsWork) {
    EXPECT_NE(refusal("volume { path: 'v' } effects { time_removal {} milling_sound {} }"), "accepted");
    EXPECT_EQ(
        refusal("volume { path: 'v' } tool { speed_rpm: 9000 } effects { spindle {} milling_sound {} }"),
        "accepted");
}

TEST_F(SceneFile, tracesNeedTheEffectThatTellsOfThem) {
    const std::string scene =
        "volume { path: 'v' } tool { speed_rpm: 9000 }\nmaterial { name: 'n' from_value: 1 "
        "is_protected: true }\neffects { ";
    EXPECT_EQ(refusal(scene + "protected_structures {} bruising {} }"), "accepted");
    EXPECT_NE(refusal(scene + "thermal {} bruising {} }"), "accepted");
    EXPECT_EQ(refusal(scene + "thermal {} browning {} }"), "accepted");
    EXPECT_NE(refusal(scene + "protected_structures {} browning {} }"), "accepted");
    EXPECT_NE(refusal(scene + "thermal {} browning { charred_from_c: 55 } }"), "accepted");
}

TEST_F(SceneFile, onlyProtectedMaterialsPulsate) {
    const std::string scene =
        "volume { path: 'v' }\nmaterial { name: 'dura' from_value: 1 is_protected: true }\nmaterial { name: "
        "'bone' from_value: 2 }\neffects { pulse { ";
    EXPECT_EQ(refusal(scene + "material: 'dura' } }"), "accepted");
    EXPECT_NE(refusal(scene + "} }").find("effects.pulse.material"), std::string::npos);
    EXPECT_NE(refusal(scene + "material: 'sinus' } }").find("no material"), std::string::npos);
    EXPECT_NE(refusal(scene + "material: 'dura' material: 'bone' } }").find("effects.pulse.material[1]"),
              std::string::npos);
}

TEST_F(SceneFile, effectsThatReadContactsNeedTheGradientLaw) {
    const std::string scene =
        "volume { path: 'v' } tool { speed_rpm: 9000 }\neffects { energy_removal {} }\n";
    for (const std::string law : {"preset: THESIS_2012", "contact_law: PENALTY_THESIS_2012",
                                  "preset: PROXY_3DOF", "contact_law: BALL_PROXY"})
        EXPECT_EQ(
            refusal(scene + "accuracy { " + law + " }"),
            "s.textproto:2: field `effects.energy_removal` needs the gradient contact law, and accuracy "
            "asks for another one: take the preset FAST, BALANCED or EXACT, or leave the effect "
            "out");
    EXPECT_EQ(refusal(scene + "accuracy { preset: THESIS_2012 contact_law: GRADIENT }"), "accepted");
    EXPECT_EQ(refusal("volume { path: 'v' } effects { time_removal {} } accuracy { preset: THESIS_2012 }"),
              "accepted");
}

TEST_F(SceneFile, boneGoesByTimeOrByEnergy) {
    EXPECT_EQ(
        refusal("volume { path: 'v' } tool { speed_rpm: 9000 }\n"
                "effects { energy_removal {}\n"
                "time_removal {} }"),
        "s.textproto:3: field `effects.time_removal` stands beside effects.energy_removal: bone goes by "
        "time or by energy, list one");
}

TEST_F(SceneFile, toolsHaveNamesOfTheirOwn) {
    const std::string volume = "volume { path: 'v' }\n";
    EXPECT_EQ(
        refusal(volume + "tool { }\ntool { name: 'drill' }\ntool { name: 'drill' }"),
        "s.textproto:4: field `tool[2].name` = \"drill\" is also what tool[1] is called: give each tool a "
        "name of its own");
    EXPECT_NE(refusal(volume + "tool { name: 'tool 2' } tool { }"), "accepted");
    EXPECT_EQ(refusal(volume + "tool { } tool { }"), "accepted");
    std::string many = volume;
    for (int n = 0; n < kMaxTools; ++n) many += "tool { }\n";
    EXPECT_EQ(refusal(many), "accepted");
    EXPECT_EQ(refusal(many + "tool { }"),
              "s.textproto:18: field `tool[16]` is one tool too many: a scene has at most 16");
}

TEST(SceneTools, AreNamedByPlaceWhereTheSceneDoesNot) {
    scene::Scene scene;
    EXPECT_EQ(toolNamesOf(scene), std::vector<std::string>{"tool 1"});
    EXPECT_EQ(toolsOf(scene).front()->burr_radius_mm(), 1);
    scene.add_tool();
    scene.add_tool()->set_name("fine");
    scene.add_tool();
    const auto names = toolNamesOf(scene);
    EXPECT_EQ(names, (std::vector<std::string>{"tool 1", "fine", "tool 3"}));
    EXPECT_EQ(toolIndexOf(names, "fine"), 1u);
    EXPECT_EQ(toolIndexOf(names, "tool 3"), 2u);
    EXPECT_EQ(toolIndexOf(names, "3"), 2u);
    for (const char* none : {"", "0", "4", "-1", "2x", "coarse", "99999999999999999999"})
        EXPECT_THROW(toolIndexOf(names, none), UserError) << none;
    try {
        toolIndexOf(names, "coarse");
    } catch (const UserError& error) {
        EXPECT_STREQ(error.what(), "no tool of the scene is called 'coarse'; it has: tool 1, fine, tool 3");
    }
}

TEST_F(SceneFile, textsMustBePrintableUtf8) {
    EXPECT_EQ(refusal("name: 'a\\xff'"), "s.textproto:1: field `name` is not UTF-8 text");
    EXPECT_EQ(refusal("name: 'a\\xc3'"), "s.textproto:1: field `name` is not UTF-8 text");
    EXPECT_EQ(refusal("volume { path: 'a\\0b' }"),
              "s.textproto:1: field `volume.path` holds a control character");
    EXPECT_EQ(refusal("name: 'Zähne' volume { path: 'v' }"), "accepted");
}

TEST(FieldUnit, isTheSuffixOfTheName) {
    EXPECT_EQ(unitOfField("max_speed_mm_per_s"), "mm/s");
    EXPECT_EQ(unitOfField("hand_stiffness_n_per_m"), "N/m");
    EXPECT_EQ(unitOfField("angular_friction_nm_s_per_rad"), "N·m·s/rad");
    EXPECT_EQ(unitOfField("stiffness_n_per_mm3"), "N/mm³");
    EXPECT_EQ(unitOfField("static_damping"), "");
}

TEST(SceneTable, schemaRowsHaveUnitDefaultAndRange) {
    const std::string table = describeDefaults();
    EXPECT_NE(table.find("| `coupling.max_speed_mm_per_s` | mm/s | 500 | 1 .. 1000000 |"), std::string::npos);
    EXPECT_NE(table.find("| `tool[].shape[].sphere.radius_mm` | mm | 1 | 0.01 .. 100 |"), std::string::npos);
    EXPECT_NE(table.find("| `volume.leaf_voxels` | voxels | not set | 4 .. 31 |"), std::string::npos);
    EXPECT_NE(table.find("| `device.p_WD_mm` | mm | not set | x, y, z |"), std::string::npos);
    EXPECT_NE(
        table.find("| `accuracy.preset` |  | BALANCED | THESIS_2012, FAST, BALANCED, EXACT, PROXY_3DOF"),
        std::string::npos);
}

// BONEMILL_WRITE_DOCS=1 writes the table instead of comparing it.
TEST(SceneTable, docsHoldTheTableOfTheSchema) {
    const fs::path page = fs::path(test::sourceDir()) / "docs/reference/scene.md";
    std::ifstream stream(page);
    std::string text{std::istreambuf_iterator<char>(stream), {}};
    const std::string heading = "## Every field\n\n";
    const size_t start = text.find(heading);
    ASSERT_NE(start, std::string::npos) << page;
    text.resize(start + heading.size());
    if (std::getenv("BONEMILL_WRITE_DOCS")) {
        stream.close();
        std::ofstream(page) << text << describeDefaults();
    }
    std::ifstream again(page);
    const std::string now{std::istreambuf_iterator<char>(again), {}};
    EXPECT_EQ(now, text + describeDefaults()) << "run this test with BONEMILL_WRITE_DOCS=1";
}

}  // namespace
}  // namespace bonemill
