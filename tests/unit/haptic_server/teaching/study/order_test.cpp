#include <gtest/gtest.h>

#include <algorithm>
#include <map>

#include "haptic_server/teaching/study/protocol.h"

namespace bonemill::study {
namespace {

TEST(StudyOrder, WilliamsSquaresBalancePlacesAndNeighbours) {
    for (size_t count = 1; count <= 12; ++count) {
        const std::vector<Sequence> rows = williamsSquare(count);
        ASSERT_EQ(rows.size(), count % 2 && count > 1 ? 2 * count : count);
        std::map<std::pair<size_t, size_t>, size_t> at_place, followed;
        for (const Sequence& row : rows)
            for (size_t i = 0; i < count; ++i) {
                ++at_place[{i, row[i]}];
                if (i > 0) ++followed[{row[i - 1], row[i]}];
            }
        EXPECT_EQ(at_place.size(), count * count);
        for (const auto& [place, times] : at_place) EXPECT_EQ(times, rows.size() / count);
        EXPECT_EQ(followed.size(), count * (count - 1)) << "of " << count;
        for (const auto& [pair, times] : followed) EXPECT_EQ(times, rows.size() / count);
    }
}

TEST(StudyOrder, ABlockHasEveryRowOnce) {
    for (const size_t count : {2, 3, 4, 5}) {
        const std::vector<Sequence> rows = williamsSquare(count);
        for (size_t block = 0; block < 5; ++block) {
            std::map<Sequence, size_t> seen;
            for (size_t i = 0; i < rows.size(); ++i)
                ++seen[sequenceOf(Order::kBalanced, count, 7, "residents", "conditions",
                                  block * rows.size() + i)];
            EXPECT_EQ(seen.size(), rows.size());
        }
    }
}

TEST(StudyOrder, FollowsFromSeedGroupAndPlaceAlone) {
    const auto ordersOf = [](uint64_t seed, const std::string& group, const std::string& purpose,
                             Order order) {
        std::vector<Sequence> all;
        for (size_t place = 0; place < 40; ++place)
            all.push_back(sequenceOf(order, 4, seed, group, purpose, place));
        return all;
    };
    for (const Order order : {Order::kBalanced, Order::kRandom}) {
        const auto one = ordersOf(1, "a", "tasks", order);
        EXPECT_EQ(one, ordersOf(1, "a", "tasks", order));
        EXPECT_NE(one, ordersOf(2, "a", "tasks", order));
        EXPECT_NE(one, ordersOf(1, "b", "tasks", order));
        EXPECT_NE(one, ordersOf(1, "a", "conditions", order));
    }
    // On every machine and with every library.
    EXPECT_EQ(sequenceOf(Order::kBalanced, 4, 2011, "resident", "conditions", 0), (Sequence{0, 1, 3, 2}));
    EXPECT_EQ(sequenceOf(Order::kFixed, 4, 2011, "resident", "conditions", 3), (Sequence{0, 1, 2, 3}));
}

TEST(StudyOrder, EverySessionIsPlannedOnce) {
    Protocol protocol;
    protocol.conditions = {{"x", "", ""}, {"y", "", ""}, {"z", "", ""}};
    protocol.tasks = {{"one", "", "", 0, 1}, {"two", "", "", 0, 3}};
    for (size_t place = 0; place < 12; ++place) {
        std::map<std::string, size_t> counts;
        for (const PlannedSession& session : plannedSessions(protocol, "g", place))
            ++counts[session.condition + "/" + session.task + "/" + std::to_string(session.attempt)];
        EXPECT_EQ(counts.size(), 12u);
        for (const auto& [name, count] : counts) EXPECT_EQ(count, 1u) << name;
    }
}

}  // namespace
}  // namespace bonemill::study
