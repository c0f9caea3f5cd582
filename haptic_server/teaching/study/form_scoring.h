// Scores of the shipped forms. Pure; any thread may call them.
#pragma once

#include "haptic_server/teaching/study/form.h"

namespace bonemill::study {

using Values = std::map<std::string, Answer>;  // by the items' ids; what was left out is not there

struct Score {
    std::string id, title;
    double value = 0;
};

// SUS (Brooke 1996): 0 to 100. NASA-TLX (Hart and Staveland 1988): the mean of the six ratings, and weighted
// by how often each was chosen in the pairs. A score of which an answer is missing is not made.
std::vector<Score> scoresOf(const Form& form, const Values& values);

}  // namespace bonemill::study
