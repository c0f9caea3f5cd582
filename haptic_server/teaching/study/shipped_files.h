// The files that come with the program, put into it by CMake: the questionnaires of
// haptic_server/teaching/study/forms (the thesis' of its section 5.4, NASA-TLX with and without weights,
// SUS), and the page and the R script beside them.
#pragma once

#include <string_view>
#include <vector>

namespace bonemill::study {

struct ShippedFile {
    std::string_view name;
    std::string_view text;
};

const std::vector<ShippedFile>& shippedForms();

std::string_view shippedPage();
std::string_view shippedAnalysis();

}  // namespace bonemill::study
