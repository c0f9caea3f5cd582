#include "common/device_messages/device_state.h"

#include <gtest/gtest.h>

#include <set>
#include <string>

namespace bonemill {
namespace {

// Beyond the known ones come those that a stranger might write.
constexpr uint32_t kUnknown[] = {1000u, 1u << 31, UINT32_MAX};

TEST(DeviceState, everyStateHasANameOfItsOwn) {
    std::set<std::string> names;
    for (uint32_t state = 0; state < kSafetyStateCount; ++state) names.insert(nameOf(SafetyState(state)));
    EXPECT_EQ(names.size(), kSafetyStateCount);
    EXPECT_EQ(names.count("") + names.count("unknown state"), 0u);
}

TEST(DeviceState, everyCauseHasANameOfItsOwn) {
    std::set<std::string> names;
    for (uint32_t cause = 0; cause < kStopCauseCount; ++cause) names.insert(nameOf(StopCause(cause)));
    EXPECT_EQ(names.size(), kStopCauseCount);
    EXPECT_EQ(names.count("") + names.count("unknown cause"), 0u);
}

TEST(DeviceState, everyCauseSaysWhatToDo) {
    EXPECT_STREQ(whatToDo(StopCause::kNone), "");
    const std::string for_strangers = whatToDo(StopCause(kUnknown[0]));
    for (uint32_t cause = 1; cause < kStopCauseCount; ++cause) {
        const std::string sentence = whatToDo(StopCause(cause));
        ASSERT_FALSE(sentence.empty()) << cause;
        EXPECT_TRUE(isupper(sentence.front()) && sentence.back() == '.') << sentence;
        EXPECT_NE(sentence, for_strangers);
    }
}

TEST(DeviceState, unknownNumbersHaveANameToo) {
    for (const uint32_t number : kUnknown) {
        EXPECT_STREQ(nameOf(SafetyState(number)), "unknown state");
        EXPECT_STREQ(nameOf(StopCause(number)), "unknown cause");
        EXPECT_EQ(std::string(whatToDo(StopCause(number))).back(), '.');
    }
    EXPECT_STREQ(nameOf(SafetyState(kSafetyStateCount)), "unknown state");
    EXPECT_STREQ(nameOf(StopCause(kStopCauseCount)), "unknown cause");
}

}  // namespace
}  // namespace bonemill
