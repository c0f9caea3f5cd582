#include "haptic_server/teaching/study/ask_form.h"

#include <algorithm>
#include <istream>
#include <ostream>

#include "haptic_server/teaching/study/shipped_files.h"

namespace bonemill::study {
namespace {

constexpr std::string_view kFormMark = "/*FORM*/", kAnswersMark = "/*ANSWERS*/";

// JSON within a script: no text in it may end the script.
std::string inScript(const std::string& json) {
    std::string text;
    for (const char c : json) {
        if (c == '<')
            text += "\\u003c";
        else if (c == '>')
            text += "\\u003e";
        else if (c == '&')
            text += "\\u0026";
        else
            text += c;
    }
    return text;
}

constexpr size_t kMaxLine = 4 * kMaxLetters;

enum class Line { kRead, kTooLong, kEnd };

Line readLine(std::istream& in, std::string& line) {
    line.clear();
    bool is_long = false;
    for (char c; in.get(c);) {
        if (c == '\n') return is_long ? Line::kTooLong : Line::kRead;
        if (line.size() < kMaxLine)
            line += c;
        else
            is_long = true;
    }
    return line.empty() ? Line::kEnd : is_long ? Line::kTooLong : Line::kRead;
}

std::string trimmed(const std::string& line) {
    const size_t begin = line.find_first_not_of(" \t\r"), end = line.find_last_not_of(" \t\r");
    return begin == std::string::npos ? "" : line.substr(begin, end - begin + 1);
}

struct Place {
    const Block* block;
    const Item* item;
};

std::vector<Place> placesOf(const Form& form) {
    std::vector<Place> places;
    for (const Block& block : form.blocks)
        for (const Item& item : block.items) places.push_back({&block, &item});
    return places;
}

void forget(Answers& answers, const std::string& item) {
    answers.values.erase(item);
    std::erase(answers.left_out, item);
}

void ask(const Place& place, size_t number, size_t count, std::ostream& out) {
    out << "\n[" << number << " of " << count << "] " << place.item->text << "\n";
    for (size_t i = 0; i < place.item->options.size(); ++i)
        out << "  " << i + 1 << "  " << place.item->options[i].text << "\n";
    if (place.item->range)
        out << "  from " << place.item->range->least << " to " << place.item->range->most << "\n";
    out << "> " << std::flush;
}

// Takes a line as the answer, or says why it cannot.
bool take(const Item& item, const std::string& line, Answers& answers, std::ostream& out) {
    if (line == "-") {
        forget(answers, item.id);
        answers.left_out.push_back(item.id);
        return true;
    }
    const std::variant<Answer, std::string> given = answerOf(item, line);
    if (const Answer* answer = std::get_if<Answer>(&given); answer && !line.empty()) {
        forget(answers, item.id);
        answers.values.emplace(item.id, *answer);
        return true;
    }
    if (line.empty())
        out << "An answer, please; a line with - leaves the question out.\n";
    else
        out << "Please " << std::get<std::string>(given) << ".\n";
    return false;
}

}  // namespace

std::string formPage(const std::string& form_text, const Answers& answers) {
    std::string page(shippedPage());
    const auto put = [&](std::string_view mark, const std::string& json) {
        page.replace(page.find(mark), mark.size(), inScript(json));
    };
    put(kAnswersMark, Json::parse(toJson(answers)).dump());
    put(kFormMark, parseJson(form_text, "form").dump());
    return page;
}

bool fillInTerminal(const Form& form, Answers& answers, std::istream& in, std::ostream& out,
                    const std::function<void(const Answers&)>& save) {
    const std::vector<Place> places = placesOf(form);
    const auto is_open = [&](const Place& place) { return !answers.isAnswered(place.item->id); };
    size_t at = size_t(std::find_if(places.begin(), places.end(), is_open) - places.begin());
    out << form.title << "\n"
        << form.instructions << "\n"
        << "Each answer is a line. A line with - leaves a question out, < goes back, . stops here and keeps "
           "all.\n";
    const Block* shown = nullptr;
    while (at < places.size()) {
        const Place& place = places[at];
        if (place.block != shown) out << "\n== " << place.block->title << "\n";
        shown = place.block;
        ask(place, at + 1, places.size(), out);
        std::string line;
        const Line read = readLine(in, line);
        line = trimmed(line);
        if (read == Line::kEnd || line == ".") break;
        if (read == Line::kTooLong) {
            out << "That line is too long.\n";
        } else if (line == "<") {
            at -= at > 0 ? 1 : 0;
        } else if (take(*place.item, line, answers, out)) {
            save(answers);
            ++at;
        }
    }
    const bool is_finished = answers.isFinished(form);
    out << (is_finished ? "\nThank you: all questions are done.\n"
                        : "\nStopped; the same command goes on here.\n");
    return is_finished;
}

}  // namespace bonemill::study
