#include <gtest/gtest.h>

#include "common/base/user_error.h"
#include "common/config/scene_check.h"

namespace bonemill {
namespace {

const std::string kStart =
    "volume { path: 'v' label_path: 'l' }\n"
    "material { name: 'bone' label: 1 } material { name: 'nerve' label: 2 is_protected: true }\n";
const std::string kTarget = "zone { name: 'box' role: TARGET shape { sphere { } } }\n";

// Of the assessment, which begins on line 3.
std::string taskRefusal(const std::string& assessment) {
    try {
        checkScene(parseSceneText(kStart + "assessment { " + assessment + " }", "s"), "s");
    } catch (const UserError& error) {
        return error.what();
    }
    return "accepted";
}

void expectRefused(const std::string& assessment, const std::string& message) {
    EXPECT_EQ(taskRefusal(assessment), message);
}

TEST(TaskCheck, aWholeTaskIsAccepted) {
    EXPECT_EQ(taskRefusal(kTarget + R"(
        zone { name: 'around' role: LEEWAY_SIDES material: 'bone' shape { box { size_mm { x: 1 y: 2 z: 3 } } } }
        zone { name: 'duct' role: PROTECTED material: 'bone' }
        reference { shape { capsule { to_mm { x: 1 } } } }
        gate { figure: 'zone.removed:box' at_least: 90 } gate { figure: 'structure.lost_volume:nerve' at_most: 0 }
        gate { figure: 'structure.exposed_area:duct' at_most: 2 } gate { figure: 'heat.peak' at_most: 47 }
        gate { figure: 'breach.grade' at_most: 1 label: 'No breach of 2 mm' }
        sub_score { figure: 'cavity.depth_mean' worst: 0 best: 2 weight: 3 }
        weights_version: 4 time_limit_s: 600 most_attempts: 3 feedback: LIVE
        approach { z: -1 } plan { tip_mm { z: -9 } } skeletonised_mm: 0.5)"),
              "accepted");
    EXPECT_EQ(taskRefusal("exam: true " + kTarget), "accepted");
    EXPECT_EQ(taskRefusal(""), "accepted");
}

TEST(TaskCheck, zonesHaveNamesPlacesAndMaterialsThatAreThere) {
    expectRefused("zone { shape { sphere {} } }",
                  "s:3: field `assessment.zone[0].name` is missing: say what the zone is called");
    expectRefused(kTarget + "zone { name: 'box' shape { sphere {} } }",
                  "s:4: field `assessment.zone[1].name` = \"box\" is also what assessment.zone[0] is called: "
                  "give each zone a name of its own");
    expectRefused(kTarget + "zone { name: 'a' }",
                  "s:4: field `assessment.zone[1]` does not say where it is: give it material or shape");
    expectRefused(kTarget + "zone { name: 'a' material: 'pulp' }",
                  "s:4: field `assessment.zone[1].material[0]` = \"pulp\" is no material of this scene");
    expectRefused(
        kTarget + "zone { name: 'a' shape {} }",
        "s:4: field `assessment.zone[1].shape[0]` is empty: give it a box, sphere, capsule, cylinder "
        "or cone");
    expectRefused(
        kTarget + "zone { name: 'a' shape { box { size_mm { x: 1 y: 1 } } } }",
        "s:4: field `assessment.zone[1].shape[0].box.size_mm` is not above 0 on each axis (mm): give "
        "x, y and z");
    expectRefused(kTarget + "zone { name: 'nerve' role: PROTECTED shape { sphere {} } }",
                  "s:4: field `assessment.zone[1].name` = \"nerve\" is also a protected material: it is a "
                  "structure already, leave the zone out or call it otherwise");
    expectRefused(
        "zone { name: 'a' shape { sphere {} } }",
        "s:3: field `assessment.zone[0]` has no target beside it: give one zone the role TARGET, or "
        "the task a reference");
    std::string many = kTarget;
    for (int n = 0; n < 32; ++n) many += "zone { name: 'z" + std::to_string(n) + "' shape { sphere {} } }";
    expectRefused(many, "s:4: field `assessment.zone[32]` is one too many: a task has at most 32 zones");
}

TEST(TaskCheck, figuresOfWhatIsNotThereAreRefused) {
    const auto gate = [](const std::string& figure) {
        return kTarget + "gate { figure: '" + figure + "' at_most: 1 }";
    };
    const std::string at = "s:4: field `assessment.gate[0].figure` ";
    expectRefused(gate(""), at + "is missing: name a figure, for example \"target.removed\"");
    expectRefused(gate("Big Hole"),
                  at + "= \"Big Hole\" is no figure: small letters, digits, '_' and '.' make "
                       "its id, then ':' and the name of what it is of");
    expectRefused(gate("zone.removed:x"),
                  at + "= \"zone.removed:x\" ends in no zone of this task: name one behind ':'");
    expectRefused(gate("structure.lost_volume:bone"),
                  at +
                      "= \"structure.lost_volume:bone\" ends in no structure of this scene: name a protected "
                      "material or zone behind ':'");
    expectRefused(gate("cavity.isthmus"),
                  at + "= \"cavity.isthmus\" needs assessment.approach: say which way goes into the bone");
    expectRefused(gate("plan.tip_error"),
                  at + "= \"plan.tip_error\" needs assessment.plan: say where the line lies");
    expectRefused(kTarget + "gate { figure: 'a' }",
                  "s:4: field `assessment.gate[0]` has no limit: give it at_most or at_least");
}

TEST(TaskCheck, scalesWaysAndExamsMustMakeSense) {
    expectRefused(kTarget + "sub_score { figure: 'a' best: 1 }",
                  "s:4: field `assessment.sub_score[0]` needs both worst and best: the figures at which its "
                  "score is 0 and 1");
    expectRefused(
        kTarget + "sub_score { figure: 'a' best: 1 worst: 1 }",
        "s:4: field `assessment.sub_score[0].best` = 1 is also the worst: there is no scale between");
    expectRefused(kTarget + "approach { }",
                  "s:4: field `assessment.approach` has no length: give the way into the bone");
    expectRefused(kTarget + "plan { }",
                  "s:4: field `assessment.plan` has its tip where it enters: give both");
    expectRefused(
        kTarget + "exam: true feedback: LIVE",
        "s:4: field `assessment.feedback` = LIVE does not go with exam, which gives none: leave one "
        "out");
    expectRefused(kTarget + "reference { }",
                  "s:4: field `assessment.reference` needs a volume_path or shapes, one of both");
    expectRefused(kTarget + "skeletonised_mm: 0",
                  "s:4: field `assessment.skeletonised_mm` = 0 is outside 0.01 .. 50 (mm)");
}

}  // namespace
}  // namespace bonemill
