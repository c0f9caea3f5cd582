// Spoils a catalogue, and looks whether tests/support/check_languages tells of it.
#include <gtest/gtest.h>

#include <string>

#include "tests/support/places.h"
#include "tests/support/process.h"

namespace bonemill {
namespace {

class SpoiledCatalogue : public testing::Test {
  protected:
    void replace(const std::string& what, const std::string& by) {
        const size_t at = text_.find(what);
        ASSERT_NE(at, std::string::npos) << what;
        text_.replace(at, what.size(), by);
    }
    test::Finished check() {
        test::writeFile(folder_ / "de.po", text_);
        return test::run(
            {test::sourceDir() + "/tests/support/check_languages", "--catalogues", folder_.path().string()});
    }

    test::TemporaryFolder folder_;
    std::string text_ = test::readFile(test::sourceDir() + "/render_client/language/de.po");
};

TEST_F(SpoiledCatalogue, IsFoundInEveryWay) {
    replace("msgstr \"Knochenmehl\"", "msgstr \"\"");
    replace("msgid \"Bleeding\"", "msgid \"Bleeding a lot\"");
    replace("msgid \"Irrigation\"", "#, fuzzy\nmsgid \"Irrigation\"");
    replace("msgstr \"{1} von {2} offen\"", "msgstr \"{1} von {3} offen\"");
    replace("msgstr \", unvollst\u00e4ndig\"", "msgstr \", unvollst\u0430ndig \"");
    const test::Finished told = check();
    EXPECT_EQ(told.exit_code, 1);
    for (const char* const line :
         {"de.po: 'Bone dust' has no translation\n", "de.po: 'Bleeding' has no translation\n",
          "de.po: 'Bleeding a lot' is no sentence of the windows, nor of the page\n",
          "de.po: 'Irrigation' is fuzzy: look at it, and take the mark away\n",
          "de.po: '{1} of {2} open' has other {1}, {2} ... than the sentence\n",
          "de.po: ', incomplete' has other blanks at its ends, or other line breaks, than the sentence\n",
          "de.po: ', incomplete' has letters that the windows cannot draw: \u0430\n", " 7 faults\n"})
        EXPECT_NE(told.out.find(line), std::string::npos) << line << told.out << told.err;
}

}  // namespace
}  // namespace bonemill
