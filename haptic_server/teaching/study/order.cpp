#include "haptic_server/teaching/study/order.h"

#include <algorithm>
#include <numeric>
#include <random>

namespace bonemill::study {
namespace {

Sequence counted(size_t count) {
    Sequence sequence(count);
    std::iota(sequence.begin(), sequence.end(), size_t(0));
    return sequence;
}

// std::shuffle differs between libraries.
Sequence shuffled(size_t count, std::mt19937_64& random) {
    Sequence sequence = counted(count);
    for (size_t i = count; i > 1; --i) std::swap(sequence[i - 1], sequence[random() % i]);
    return sequence;
}

std::mt19937_64 randomOf(uint64_t seed, const std::string& group, const std::string& purpose, size_t block) {
    std::vector<uint32_t> words = {uint32_t(seed), uint32_t(seed >> 32), uint32_t(block)};
    for (const std::string& text : {group, purpose}) {
        words.push_back(uint32_t(text.size()));
        for (const char c : text) words.push_back(uint8_t(c));
    }
    std::seed_seq sequence(words.begin(), words.end());
    return std::mt19937_64(sequence);
}

}  // namespace

std::vector<Sequence> williamsSquare(size_t count) {
    std::vector<Sequence> rows;
    // The first row goes 0, 1, n-1, 2, n-2 ...; the others are shifted by one each.
    for (size_t shift = 0; shift < count; ++shift) {
        Sequence row;
        for (size_t i = 0; i < count; ++i)
            row.push_back(((i % 2 ? (i + 1) / 2 : count - i / 2) + shift) % count);
        rows.push_back(row);
    }
    if (count % 2 && count > 1)
        for (size_t i = 0; i < count; ++i) rows.emplace_back(rows[i].rbegin(), rows[i].rend());
    return rows;
}

Sequence sequenceOf(Order order, size_t count, uint64_t seed, const std::string& group,
                    const std::string& purpose, size_t place) {
    if (order == Order::kFixed || count < 2) return counted(count);
    if (order == Order::kRandom) {
        std::mt19937_64 random = randomOf(seed, group, purpose, place);
        return shuffled(count, random);
    }
    const std::vector<Sequence> rows = williamsSquare(count);
    std::mt19937_64 random = randomOf(seed, group, purpose, place / rows.size());
    return rows[shuffled(rows.size(), random)[place % rows.size()]];
}

std::vector<PlannedSession> plannedSessions(const Protocol& protocol, const std::string& group,
                                            size_t place) {
    const auto sequence = [&](Order order, size_t count, const char* purpose) {
        return sequenceOf(order, count, protocol.seed, group, purpose, place);
    };
    const Sequence conditions = sequence(protocol.condition_order, protocol.conditions.size(), "conditions");
    const Sequence tasks = sequence(protocol.task_order, protocol.tasks.size(), "tasks");
    std::vector<PlannedSession> sessions;
    for (const size_t condition : conditions)
        for (const size_t task : tasks)
            for (size_t attempt = 1; attempt <= protocol.tasks[task].attempts; ++attempt)
                sessions.push_back({protocol.conditions[condition].id, protocol.tasks[task].id, attempt});
    return sessions;
}

}  // namespace bonemill::study
