#include "render_client/language/language.h"

#include <gtest/gtest.h>

#include <algorithm>
#include <clocale>
#include <cstdlib>
#include <filesystem>
#include <fstream>

#include "tests/support/spoken.h"
#include "tests/support/temporary_folder.h"

namespace bonemill {
namespace {

// The settings' folder is this process' own.
class Languages : public testing::Test {
  protected:
    Languages() {
        setenv("XDG_CONFIG_HOME", folder_.path().c_str(), 1);
        for (const char* const name : {"LANGUAGE", "LC_ALL", "LC_MESSAGES", "LANG"}) unsetenv(name);
    }

    test::TemporaryFolder folder_;
    test::Spoken english_{kEnglish};
};

TEST_F(Languages, EnglishIsSpokenAtFirst) {
    EXPECT_EQ(spokenLanguage(), "en");
    EXPECT_STREQ(tr("Bone"), "Bone");
    EXPECT_STREQ(trIn("faults", "none"), "none");
    EXPECT_EQ(tr("Attempt {1}: {2}", {"3", "Ann"}), "Attempt 3: Ann");
}

TEST_F(Languages, ThereAreThreeByTheirOwnNames) {
    ASSERT_GE(languages().size(), 3u);
    EXPECT_EQ(languages()[0].name, "English");
    const auto nameOf = [](const std::string& code) {
        return std::ranges::find(languages(), code, &Language::code)->name;
    };
    EXPECT_EQ(nameOf("de"), "Deutsch");
    EXPECT_EQ(nameOf("sv"), "Svenska");
}

TEST_F(Languages, AnotherIsSpokenAtOnceAndWhatWasSaidStaysValid) {
    speak("de");
    const char* const german = tr("Bone");
    EXPECT_STREQ(german, "Knochen");
    EXPECT_STREQ(trIn("faults", "none"), "keine");
    EXPECT_STREQ(trIn("volume", "none"), "nichts");
    EXPECT_EQ(tr("Attempt {1}: {2}", {"3", "Ann"}), "Versuch 3: Ann");
    speak("sv");
    EXPECT_STREQ(tr("Bone"), "Ben");
    EXPECT_STREQ(german, "Knochen");
    speak("xx");
    EXPECT_STREQ(tr("Bone"), "Bone");
}

TEST_F(Languages, WhatHasNoTranslationStaysEnglish) {
    speak("de");
    EXPECT_STREQ(tr("no sentence of any window"), "no sentence of any window");
    EXPECT_EQ(tr("no {2} of {1} {3}", {"a", "b"}), "no b of a {3}");
}

TEST_F(Languages, NumbersAreWrittenAsEver) {
    speak("de");
    EXPECT_EQ(std::string(std::localeconv()->decimal_point), ".");
}

TEST_F(Languages, TheDesktopsIsWantedUntilOneIsChosen) {
    EXPECT_EQ(wantedLanguage(), "en");
    setenv("LANG", "sv_SE.UTF-8", 1);
    EXPECT_EQ(wantedLanguage(), "sv");
    setenv("LC_ALL", "de_AT.UTF-8@euro", 1);
    EXPECT_EQ(wantedLanguage(), "de");
    setenv("LC_ALL", "C.UTF-8", 1);
    EXPECT_EQ(wantedLanguage(), "en") << "C hides what LANG says";
    setenv("LANGUAGE", "fi:sv:de", 1);
    EXPECT_EQ(wantedLanguage(), "sv");
    setenv("LANGUAGE", "fi", 1);
    EXPECT_EQ(wantedLanguage(), "en");
    chooseLanguage("de");
    EXPECT_EQ(spokenLanguage(), "de");
    EXPECT_EQ(wantedLanguage(), "de");
}

TEST_F(Languages, AChoiceThatMakesNoSenseIsNone) {
    setenv("LANG", "sv_SE.UTF-8", 1);
    std::filesystem::create_directories(folder_.path() / "bonemill");
    for (const char* const text : {"", "\n", "xx\n", "../../de\n"}) {
        std::ofstream(folder_.path() / "bonemill/language") << text;
        EXPECT_EQ(wantedLanguage(), "sv") << text;
    }
}

}  // namespace
}  // namespace bonemill
