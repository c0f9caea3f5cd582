// What a study planned before its first participant: protocol.json of its folder (docs/research/study.md has
// its fields). Pure after reading; any thread may read it.
#pragma once

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

    const Group* findGroup(const std::string& group_id) const;
    std::vector<std::string> formIds() const;
};

// Throws UserError.
Protocol parseProtocol(const std::string& text, const std::string& file);

const char* wordOf(Order order);

// A protocol that shows every field, for `study init`.
std::string exampleProtocol();

}  // namespace bonemill::study
