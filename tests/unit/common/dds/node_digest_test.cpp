#include "common/dds/node_digest.h"

#include <gtest/gtest.h>

#include <set>

namespace bonemill {
namespace {

TEST(NodeDigest, DoesNotDependOnTheOrder) {
    NodeDigest forward, backward;
    for (uint32_t node = 0; node < 100; ++node) forward.add(node, 2 * node);
    for (uint32_t node = 100; node-- > 0;) backward.add(node, 2 * node);
    EXPECT_EQ(forward, backward);
    EXPECT_EQ(forward.count(), 100u);
}

TEST(NodeDigest, ForgetsWhatIsRemoved) {
    NodeDigest changed, expected;
    changed.add(1, 2);
    changed.add(3, 4);
    changed.remove(1, 2);
    expected.add(3, 4);
    EXPECT_EQ(changed, expected);
}

TEST(NodeDigest, TellsSmallSetsApart) {
    std::set<uint64_t> values;
    for (uint32_t node = 0; node < 100; ++node) {
        for (uint32_t revision = 0; revision < 100; ++revision) {
            NodeDigest digest;
            digest.add(node, revision);
            values.insert(digest.value());
        }
    }
    EXPECT_EQ(values.size(), 100u * 100u);
}

TEST(NodeDigest, NoticesSwappedRevisions) {
    NodeDigest a, b;
    a.add(1, 10);
    a.add(2, 20);
    b.add(1, 20);
    b.add(2, 10);
    EXPECT_EQ(a.count(), b.count());
    EXPECT_NE(a.value(), b.value());
}

}  // namespace
}  // namespace bonemill
