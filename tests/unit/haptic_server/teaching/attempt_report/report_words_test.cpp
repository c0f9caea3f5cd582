#include "haptic_server/teaching/attempt_report/report_words.h"

#include <gtest/gtest.h>

#include <cmath>

namespace bonemill {
namespace {

TEST(ReportText, NothingInATextIsMarkup) {
    EXPECT_EQ(escaped("<b a='1' c=\"2\">&"), "&lt;b a=&#39;1&#39; c=&quot;2&quot;&gt;&amp;");
    EXPECT_EQ(escaped("Müller ≥ 3"), "Müller ≥ 3");
    EXPECT_EQ(escaped("a\x01\n\x7f"), "a???");
    EXPECT_EQ(escaped("\xc3"), "?");
    EXPECT_EQ(escaped("\xc0\xaf"), "??") << "an overlong slash";
    EXPECT_EQ(escaped("\xed\xa0\x80"), "???") << "half of a pair of UTF-16";
    EXPECT_EQ(escaped("\xc2\x85x"), "??x") << "a control character";
}

TEST(ReportText, NumbersHaveThreeDigits) {
    EXPECT_EQ(roundedText(0), "0");
    EXPECT_EQ(roundedText(61.53), "61.5");
    EXPECT_EQ(roundedText(4.5), "4.5");
    EXPECT_EQ(roundedText(-0.01234), "-0.0123");
    EXPECT_EQ(roundedText(123456), "123456");
    EXPECT_EQ(roundedText(1.5e-5), "1.50e-05");
    EXPECT_EQ(roundedText(std::nan("")), "–");
    EXPECT_EQ(valueText(0.8, "mm3"), "0.8 mm³");
    EXPECT_EQ(valueText(30, "deg"), "30°");
    EXPECT_EQ(valueText(7, ""), "7");
    EXPECT_EQ(valueText(7, "N"), "7 N");
}

TEST(ReportText, ClocksCarry) {
    EXPECT_EQ(clockText(0), "0:00.0");
    EXPECT_EQ(clockText(62.5), "1:02.5");
    EXPECT_EQ(clockText(59.96), "1:00.0");
    EXPECT_EQ(clockText(3600), "60:00.0");
}

TEST(ReportText, Base64IsThatOfTheStandard) {
    EXPECT_EQ(base64(""), "");
    EXPECT_EQ(base64("f"), "Zg==");
    EXPECT_EQ(base64("fo"), "Zm8=");
    EXPECT_EQ(base64("foo"), "Zm9v");
    EXPECT_EQ(base64("foobar"), "Zm9vYmFy");
    EXPECT_EQ(base64("\xff\xfe\xfd"), "//79");
}

}  // namespace
}  // namespace bonemill
