// A questionnaire as one page of HTML for a tablet or another PC: it loads nothing, and saves a file that
// `study import` takes. Pure; any thread may call it.
#pragma once

#include "haptic_server/teaching/study/study_participant.h"

namespace bonemill::study {

// `form_text` is the form's file. Answers that are there already are filled in.
std::string formPage(const std::string& form_text, const Answers& answers);

}  // namespace bonemill::study
