#include "common/digest/name_uuid.h"

#include <gtest/gtest.h>

namespace bonemill {
namespace {

// The second is Python's own example of uuid.uuid5(); all are what it gives.
TEST(NameUuid, IsThatOfOthers) {
    EXPECT_EQ(uuidOfName(kDnsNames, "www.example.com"), "2ed6657d-e927-568b-95e1-2665a8aea6a2");
    EXPECT_EQ(uuidOfName(kDnsNames, "python.org"), "886313e1-3b8a-5372-9b90-0c9aee199e5d");
    EXPECT_EQ(uuidOfName(kUrlNames, "https://bonemill.invalid/attempts/"),
              "0343b93d-9634-5d8b-b39a-3e9e10ed0eff");
}

}  // namespace
}  // namespace bonemill
