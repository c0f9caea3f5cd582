// The window of make-case in every language, without words that are cut.
#include <gtest/gtest.h>
#include <imgui.h>

#include "tests/support/cut_words.h"
#include "tests/support/spoken.h"
#include "tests/support/temporary_folder.h"
#include "tests/unit/render_client/case_window/case_screen/clicked_screen.h"

namespace bonemill {
namespace {

constexpr float kSteps = 0.45f * 1280;  // pixels; what is drawn on the slices ends at their edges

TEST(CaseLanguage, NoLanguageHasWordsThatAreCut) {
    const test::TemporaryFolder folder;
    test::writeHead(folder.path() / "scans/head");
    CaseRequest request;
    request.scan = folder / "scans/head";
    request.out = folder / "case";
    test::ClickedScreen screen(request, 1280, 2000);  // all steps are seen at once
    screen.click("A part of it, with fine voxels");
    for (const Language& language : languages()) {
        const test::Spoken spoken(language.code);
        screen.look();
        int letters = 0;
        EXPECT_EQ(test::placesOfCuts(*screen.screen.stage().drawData(), letters, kSteps), "")
            << language.name;
        EXPECT_GT(letters, 500) << language.name;
    }
    const test::Spoken spoken("de");
    screen.look();
    EXPECT_TRUE(screen.screen.find("Den Fall erstellen"));
}

}  // namespace
}  // namespace bonemill
