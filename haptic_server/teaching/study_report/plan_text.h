// What a study of given size can and cannot see, in words, for `study plan` and for the report. Pure; any
// thread may call them.
#pragma once

#include <cstddef>
#include <optional>
#include <string>

namespace bonemill::study {

struct Plan {
    size_t first = 0, second = 0;  // people per group
    size_t tests = 1;
    double alpha = 0.05, power = 0.8;
    std::optional<double> p;  // a printed P of Student's test of these groups
};

std::string planText(const Plan& plan);

}  // namespace bonemill::study
