// What a study planned before its first participant: protocol.json of its folder (docs/howto/study.md has
// its fields), and in which order a participant meets conditions and tasks. Pure after reading; any thread
// may read it.
#pragma once

#include <algorithm>
#include <cstdint>
#include <string>
#include <vector>

#include "haptic_server/teaching/study/json_input.h"

namespace bonemill::study {

struct Group {
    std::string id, title;
    size_t wanted = 0;
};

struct Condition {
    std::string id, title, options;  // options: what programs are started with under it
};

struct Task {
    std::string id, title, scene;
    double seconds = 0;  // 0: as long as it takes
    size_t attempts = 1;
};

enum class Order { kFixed, kBalanced, kRandom };

struct Protocol {
    std::string id, title;
    uint64_t seed = 0;
    double alpha = 0.05, power = 0.8;
    double threshold = 3;  // a share of answers at least as high is reported
    std::vector<Group> groups;
    std::vector<Condition> conditions;
    std::vector<Task> tasks;
    Order condition_order = Order::kBalanced, task_order = Order::kFixed;
    std::vector<std::string> forms_before, forms_after_each, forms_after;
    // What a reporting checklist asks for and no program can know.
    std::string hypothesis, orientation, feedback, blinding, sample_size_reason, ethics, device;

    const Group* findGroup(const std::string& group_id) const {
        for (const Group& group : groups)
            if (group.id == group_id) return &group;
        return nullptr;
    }
    std::vector<std::string> formIds() const {
        std::vector<std::string> ids;
        for (const auto* forms : {&forms_before, &forms_after_each, &forms_after})
            for (const std::string& id : *forms)
                if (std::find(ids.begin(), ids.end(), id) == ids.end()) ids.push_back(id);
        return ids;
    }
};

// Throws UserError.
Protocol parseProtocol(const std::string& text, const std::string& file);

const char* wordOf(Order order);

// A protocol that shows every field, for `study init`.
std::string exampleProtocol();

// An order follows from the protocol's seed, the group and the place in the group alone: the same on every
// machine, whoever drops out.
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
