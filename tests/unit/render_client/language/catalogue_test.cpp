#include "render_client/language/catalogue.h"

#include <gtest/gtest.h>

namespace bonemill {
namespace {

constexpr char kHead[] = "# Head.\nmsgid \"\"\nmsgstr \"\"\n\"Language: de\\n\"\n\n";

TEST(CatalogueOfPo, HasSentencesByTheEnglishOnes) {
    const Catalogue read =
        catalogueOfPo(std::string(kHead) +
                      "#: a.cpp\nmsgid \"Bone\"\nmsgstr \"Knochen\"\n\n"
                      "msgid \"\"\n\"two \"\n\"parts\"\nmsgstr \"\"\n\"zwei \"\n\"Teile\"\n");
    EXPECT_EQ(read, (Catalogue{{"Bone", "Knochen"}, {"two parts", "zwei Teile"}}));
}

TEST(CatalogueOfPo, TellsContextsApart) {
    const Catalogue read = catalogueOfPo(
        "msgctxt \"faults\"\nmsgid \"none\"\nmsgstr \"keine\"\n\n"
        "msgctxt \"volume\"\nmsgid \"none\"\nmsgstr \"nichts\"\n\nmsgid \"none\"\nmsgstr \"kein\"\n");
    EXPECT_EQ(read.at(catalogueKey("faults", "none")), "keine");
    EXPECT_EQ(read.at(catalogueKey("volume", "none")), "nichts");
    EXPECT_EQ(read.at("none"), "kein");
}

TEST(CatalogueOfPo, UnderstandsEscapes) {
    const Catalogue read = catalogueOfPo(R"(msgid "a\n\"b\"\\"
msgstr "c\t\n\"d\"\\"
)");
    ASSERT_EQ(read.size(), 1u);
    EXPECT_EQ(read.begin()->first, "a\n\"b\"\\");
    EXPECT_EQ(read.begin()->second, "c\t\n\"d\"\\");
}

TEST(CatalogueOfPo, LeavesOutWhatIsFuzzyEmptyOrGone) {
    const Catalogue read = catalogueOfPo(
        "#, fuzzy\nmsgid \"old\"\nmsgstr \"alt\"\n\nmsgid \"empty\"\nmsgstr \"\"\n\n"
        "#~ msgid \"gone\"\n#~ msgstr \"weg\"\n\nmsgid \"good\"\nmsgstr \"gut\"\n");
    EXPECT_EQ(read, (Catalogue{{"good", "gut"}}));
}

TEST(CatalogueOfPo, MakesNothingOfNonsense) {
    for (const char* const text : {"", "\"", "msgstr", "msgid", "msgid \"", "\"\"\"\n\\",
                                   "msgstr \"a\"\n\"b\"", "msgid \"a\\\nmsgstr \"b\\", "\n\n\xff\xfe"})
        EXPECT_TRUE(catalogueOfPo(text).empty() || catalogueOfPo(text).size() == 1) << text;
}

}  // namespace
}  // namespace bonemill
