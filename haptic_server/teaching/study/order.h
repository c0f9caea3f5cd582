// In which order a participant meets conditions and tasks. It follows from the protocol's seed, the group and
// the place in the group alone: the same on every machine, whoever drops out. Pure; any thread may call it.
#pragma once

#include "haptic_server/teaching/study/protocol.h"

namespace bonemill::study {

using Sequence = std::vector<size_t>;

// A Latin square in which each of `count` follows each other one equally often (Williams 1949): `count` rows
// when it is even, twice as many when it is odd.
std::vector<Sequence> williamsSquare(size_t count);

// The sequence of the `place`th of a group, from 0. Balanced: the square's rows in random order, all of them
// before any comes again. `purpose` keeps the draws for conditions and for tasks apart.
Sequence sequenceOf(Order order, size_t count, uint64_t seed, const std::string& group,
                    const std::string& purpose, size_t place);

struct PlannedSession {
    std::string condition, task;
    size_t attempt = 1;
};

std::vector<PlannedSession> plannedSessions(const Protocol& protocol, const std::string& group, size_t place);

}  // namespace bonemill::study
