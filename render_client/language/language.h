// What people read in a window, in their language. The English sentences of the code are the keys; the others
// are in files, LANGUAGE.po (docs/howto/translate.md). What comes from scenes, from the server and from the
// command line is not translated, and numbers are written as in English everywhere.
//
// All functions are for any thread. What tr() returns stays valid to the program's end, also when the
// language is changed; not RT-safe.
#pragma once

#include <initializer_list>
#include <string>
#include <string_view>
#include <vector>

namespace bonemill {

// Returns the sentence in the language that is spoken, or itself where there is no translation.
const char* tr(const char* text);
// The same, with these in the places of {1}, {2} and so on.
std::string tr(const char* text, std::initializer_list<std::string_view> parts);
// The same word means different things at different places: `context` tells translators which.
const char* trIn(const char* context, const char* text);
// Marks a sentence in a table, which is translated where it is used.
constexpr const char* trMark(const char* text) {
    return text;
}

struct Language {
    std::string code;  // "de": the file's name
    std::string name;  // "Deutsch": its own
};
inline constexpr char kEnglish[] = "en";

// Returns the languages that can be spoken, English first. They lie beside the programs, and in the folder
// `languages` of the user's own settings.
const std::vector<Language>& languages();

// Returns the code of the language that is spoken; at first it is English.
std::string spokenLanguage();
// From now on this one is spoken; English if there is no such language.
void speak(const std::string& code);

// Returns what was chosen in a window before, or what the desktop speaks (LANGUAGE, LC_ALL, LC_MESSAGES,
// LANG).
std::string wantedLanguage();
// Speaks it, and remembers that for the next windows. Throws UserError where it cannot be remembered.
void chooseLanguage(const std::string& code);

}  // namespace bonemill
