#include <gtest/gtest.h>

#include "common/digest/digest.h"

namespace bonemill {
namespace {

// The namespace of domain names, RFC 4122, appendix C.
constexpr UuidBytes kDnsNames{0x6b, 0xa7, 0xb8, 0x10, 0x9d, 0xad, 0x11, 0xd1,
                              0x80, 0xb4, 0x00, 0xc0, 0x4f, 0xd4, 0x30, 0xc8};

// The second is Python's own example of uuid.uuid5(); all are what it gives.
TEST(NameUuid, IsThatOfOthers) {
    EXPECT_EQ(uuidOfName(kDnsNames, "www.example.com"), "2ed6657d-e927-568b-95e1-2665a8aea6a2");
    EXPECT_EQ(uuidOfName(kDnsNames, "python.org"), "886313e1-3b8a-5372-9b90-0c9aee199e5d");
    EXPECT_EQ(uuidOfName(kUrlNames, "https://bonemill.invalid/attempts/"),
              "0343b93d-9634-5d8b-b39a-3e9e10ed0eff");
}

}  // namespace
}  // namespace bonemill
