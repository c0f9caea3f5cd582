#include "haptic_server/teaching/study/form_page.h"

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

}  // namespace bonemill::study
