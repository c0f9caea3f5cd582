#include "render_client/language/language.h"

#include <algorithm>
#include <atomic>
#include <cstdlib>
#include <filesystem>
#include <fstream>
#include <iterator>
#include <map>
#include <mutex>

#include "common/files/config_folder.h"
#include "common/files/whole_file.h"
#include "render_client/language/catalogue.h"

namespace bonemill {
namespace {

namespace fs = std::filesystem;

struct Spoken {
    std::string code;
    Catalogue sentences;
};
// Null: English. Catalogues stay for good, since what tr() returned may be in use.
std::atomic<const Spoken*> spoken_now{nullptr};

// The first bytes of the file; empty if it cannot be read.
std::string textOf(const fs::path& file) {
    constexpr size_t kMostBytes = 1 << 20;
    std::ifstream stream(file, std::ios::binary);
    std::string text(kMostBytes, '\0');
    stream.read(text.data(), std::streamsize(text.size()));
    text.resize(size_t(stream.gcount()));
    return text;
}

// A user's own comes first.
std::vector<fs::path> folders() {
    std::error_code error;
    const fs::path program = fs::read_symlink("/proc/self/exe", error);
    return {configFolder() / "languages",
            program.parent_path().parent_path() / "share" / "bonemill" / "languages"};
}

fs::path fileOf(const std::string& code) {
    for (const fs::path& folder : folders())
        if (std::error_code error; fs::is_regular_file(folder / (code + ".po"), error))
            return folder / (code + ".po");
    return {};
}

// The sentence "English" is translated as the language's own name.
std::string nameOf(const std::string& code) {
    const Catalogue sentences = catalogueOfPo(textOf(fileOf(code)));
    const auto name = sentences.find(std::string_view("English"));
    return name == sentences.end() ? code : name->second;
}

std::vector<Language> findLanguages() {
    std::map<std::string, std::string> names;
    for (const fs::path& folder : folders()) {
        std::error_code error;
        for (const auto& entry : fs::directory_iterator(folder, error))
            if (entry.path().extension() == ".po") names[entry.path().stem().string()];
    }
    std::vector<Language> found{{kEnglish, trMark("English")}};
    for (const auto& [code, unnamed] : names)
        if (code != kEnglish) found.push_back({code, nameOf(code)});
    return found;
}

bool isThere(const std::string& code) {
    return std::ranges::any_of(languages(), [&](const Language& language) { return language.code == code; });
}

// "de_AT.UTF-8" is spoken by de_AT.po, or by de.po; empty: by none. C and POSIX are English.
std::string codeOf(const std::string& locale) {
    const std::string place = locale.substr(0, locale.find_first_of(".@"));
    if (place == "C" || place == "POSIX") return kEnglish;
    if (isThere(place)) return place;
    const std::string language = place.substr(0, place.find('_'));
    return isThere(language) ? language : "";
}

std::string desktopLanguage() {
    for (const char* const name : {"LANGUAGE", "LC_ALL", "LC_MESSAGES", "LANG"}) {
        const char* const value = std::getenv(name);
        std::string wishes = value ? value : "";
        while (!wishes.empty()) {
            const size_t end = std::min(wishes.find(':'), wishes.size());
            if (const std::string code = codeOf(wishes.substr(0, end)); !code.empty()) return code;
            wishes.erase(0, end + 1);
        }
        if (value && *value) return kEnglish;
    }
    return kEnglish;
}

fs::path choiceFile() {
    return configFolder() / "language";
}

}  // namespace

const char* tr(const char* text) {
    const Spoken* const spoken = spoken_now.load(std::memory_order_acquire);
    if (!spoken) return text;
    const auto found = spoken->sentences.find(std::string_view(text));
    return found == spoken->sentences.end() ? text : found->second.c_str();
}

std::string tr(const char* text, std::initializer_list<std::string_view> parts) {
    const std::string_view sentence = tr(text);
    std::string filled;
    for (size_t n = 0; n < sentence.size(); ++n) {
        const bool is_place = n + 2 < sentence.size() && sentence[n] == '{' && sentence[n + 2] == '}' &&
                              sentence[n + 1] >= '1' && size_t(sentence[n + 1] - '0') <= parts.size();
        if (is_place) {
            filled += std::data(parts)[sentence[n + 1] - '1'];
            n += 2;
        } else {
            filled += sentence[n];
        }
    }
    return filled;
}

const char* trIn(const char* context, const char* text) {
    const Spoken* const spoken = spoken_now.load(std::memory_order_acquire);
    if (!spoken) return text;
    const auto found = spoken->sentences.find(catalogueKey(context, text));
    return found == spoken->sentences.end() ? text : found->second.c_str();
}

const std::vector<Language>& languages() {
    static const std::vector<Language> kFound = findLanguages();
    return kFound;
}

std::string spokenLanguage() {
    const Spoken* const spoken = spoken_now.load(std::memory_order_acquire);
    return spoken ? spoken->code : kEnglish;
}

void speak(const std::string& code) {
    static std::mutex mutex;
    static std::map<std::string, Spoken> known;
    const std::lock_guard lock(mutex);
    if (code == kEnglish || !isThere(code)) return spoken_now.store(nullptr, std::memory_order_release);
    const auto [spoken, is_new] = known.try_emplace(code);
    if (is_new) spoken->second = {code, catalogueOfPo(textOf(fileOf(code)))};
    spoken_now.store(&spoken->second, std::memory_order_release);
}

std::string wantedLanguage() {
    std::string chosen = textOf(choiceFile());
    chosen.erase(std::min(chosen.find('\n'), chosen.size()));
    return isThere(chosen) ? chosen : desktopLanguage();
}

void chooseLanguage(const std::string& code) {
    speak(code);
    writePrivateFile(choiceFile(), code + "\n");
}

}  // namespace bonemill
