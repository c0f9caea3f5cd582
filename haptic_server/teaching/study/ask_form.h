// Asks a questionnaire: line by line, in a terminal or through a pipe, or as a page. It is for one thread.
#pragma once

#include <functional>
#include <iosfwd>
#include <string>

#include "haptic_server/teaching/study/study_participant.h"

namespace bonemill::study {

// A questionnaire as one page of HTML for a tablet or another PC: it loads nothing, and saves a file that
// `study import` takes. `form_text` is the form's file. Answers that are there already are filled in.
std::string formPage(const std::string& form_text, const Answers& answers);

// Goes on at the first question without an answer. `save` is called after each answer, so that nothing given
// is lost whatever ends the program. Returns whether all questions are done; it ends early when the input
// does, or at a line with a dot.
bool fillInTerminal(const Form& form, Answers& answers, std::istream& in, std::ostream& out,
                    const std::function<void(const Answers&)>& save);

}  // namespace bonemill::study
