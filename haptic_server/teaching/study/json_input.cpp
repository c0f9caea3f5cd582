#include "haptic_server/teaching/study/json_input.h"

#include <algorithm>
#include <cmath>
#include <fstream>
#include <set>

#include "common/base/user_error.h"
#include "common/files/require_file.h"
#include "common/text/text_encoding.h"

namespace bonemill::study {
namespace {

constexpr int kMaxLevels = 12;
constexpr size_t kMaxIdentifier = 40;
constexpr size_t kMaxFields = 1000;  // an object is searched field by field

using Event = Json::parse_event_t;

// Watches the parser: it stops at too many levels and at a key that an object has twice.
class ParseWatch {
  public:
    explicit ParseWatch(const std::string& file) : file_(file) {}

    bool operator()(int depth, Event event, Json& value) {
        if (depth > kMaxLevels) throw UserError(file_ + ": has more than 12 levels of brackets");
        if (event == Event::object_start) keys_.emplace_back();
        if (event == Event::object_end) keys_.pop_back();
        if (event == Event::key && !keys_.back().insert(value.get<std::string>()).second)
            throw UserError(file_ + ": has the field \"" +
                            value.get<std::string>().substr(0, kMaxIdentifier) + "\" twice; keep one");
        if (event == Event::key && keys_.back().size() > kMaxFields)
            throw UserError(file_ + ": has an object of more than 1000 fields");
        return true;
    }

  private:
    const std::string& file_;
    std::vector<std::set<std::string>> keys_;
};

size_t lineOf(const std::string& text, size_t byte) {
    return 1 + size_t(std::count(text.begin(), text.begin() + long(std::min(byte, text.size())), '\n'));
}

}  // namespace

Json parseJson(std::string text, const std::string& file) {
    if (text.size() > kMaxJsonBytes) throw UserError(file + ": is larger than 1 MiB; it is not one of ours");
    requireUtf8(text, file);
    try {
        return Json::parse(text, ParseWatch(file));
    } catch (const nlohmann::json::parse_error& error) {
        throw UserError(file + ": is not valid JSON near line " + std::to_string(lineOf(text, error.byte)) +
                        "; look for a missing comma, quote or bracket there");
    } catch (const nlohmann::json::exception&) {
        throw UserError(file + ": has a number that is too large");
    }
}

Json readJson(const std::filesystem::path& path) {
    requireFile(path);
    std::ifstream file(path, std::ios::binary);
    if (!file || std::filesystem::is_directory(path))
        throw UserError(path.string() + ": cannot be read; is it there, and may you read it?");
    std::string text(kMaxJsonBytes + 1, '\0');
    file.read(text.data(), std::streamsize(text.size()));
    text.resize(size_t(file.gcount()));
    return parseJson(std::move(text), path.string());
}

bool isIdentifier(std::string_view text) {
    const auto fits = [](char c) {
        return (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') || c == '-' ||
               c == '_';
    };
    return !text.empty() && text.size() <= kMaxIdentifier && text[0] != '-' &&
           std::all_of(text.begin(), text.end(), fits);
}

bool isPlainText(std::string_view text) {
    const auto byte = [&](size_t i) { return i < text.size() ? uint8_t(text[i]) : uint8_t(0); };
    for (size_t at = 0; at < text.size();) {
        const size_t length = letterBytes(text, at);
        // What turns the direction of writing makes one answer look like another.
        const uint8_t second = byte(at + 1), third = byte(at + 2);
        const bool is_turn = byte(at) == 0xe2 && ((second == 0x80 && third >= 0xaa && third <= 0xae) ||
                                                  (second == 0x81 && third >= 0xa6 && third <= 0xa9));
        if (length == 0 || is_turn) return false;
        at += length;
    }
    return true;
}

JsonObject::JsonObject(const Json& json, std::string place) : json_(json), place_(std::move(place)) {
    if (!json_.is_object()) throw UserError(place_ + ": is no object; put { and } around its fields");
}

void JsonObject::refuse(const std::string& key, const std::string& what) const {
    throw UserError(place_ + ": \"" + key + "\" " + what);
}

const Json& JsonObject::at(const std::string& key, const char* what) const {
    if (!has(key)) refuse(key, std::string("is missing; it must be ") + what);
    return json_.at(key);
}

void JsonObject::allowOnly(const std::vector<std::string_view>& keys) const {
    for (const auto& [key, value] : json_.items())
        if (std::find(keys.begin(), keys.end(), key) == keys.end()) {
            const std::string shown = isPlainText(key) ? key.substr(0, kMaxIdentifier) : "?";
            throw UserError(place_ + ": does not know a field \"" + shown + "\"; see docs/howto/study.md");
        }
}

std::string JsonObject::text(const std::string& key, size_t most_bytes) const {
    const Json& value = at(key, "a text");
    if (!value.is_string()) refuse(key, "must be a text in quotes");
    std::string text = value.get<std::string>();
    if (text.size() > most_bytes) refuse(key, "has more than " + std::to_string(most_bytes) + " bytes");
    if (!isPlainText(text)) refuse(key, "has control characters, or is no UTF-8");
    return text;
}

std::string JsonObject::textOr(const std::string& key, const std::string& otherwise) const {
    return has(key) ? text(key) : otherwise;
}

std::string JsonObject::identifier(const std::string& key) const {
    const std::string text = this->text(key);
    if (!isIdentifier(text)) refuse(key, "must be 1 to 40 letters, digits, - or _ and begin with none of - ");
    return text;
}

double JsonObject::number(const std::string& key, double least, double most) const {
    const Json& value = at(key, "a number");
    const double number = value.is_number() ? value.get<double>() : HUGE_VAL;
    if (!(number >= least && number <= most)) {
        std::string bounds = Json(least).dump() + " to " + Json(most).dump();
        refuse(key, "must be a number from " + bounds);
    }
    return number;
}

double JsonObject::numberOr(const std::string& key, double otherwise, double least, double most) const {
    return has(key) ? number(key, least, most) : otherwise;
}

size_t JsonObject::whole(const std::string& key, size_t least, size_t most) const {
    const double value = number(key, double(least), double(most));
    if (value != std::floor(value)) refuse(key, "must be a whole number");
    return size_t(value);
}

bool JsonObject::flagOr(const std::string& key, bool otherwise) const {
    if (!has(key)) return otherwise;
    if (!json_.at(key).is_boolean()) refuse(key, "must be true or false");
    return json_.at(key).get<bool>();
}

std::vector<JsonObject> JsonObject::objects(const std::string& key, size_t least, size_t most) const {
    if (!has(key) && least == 0) return {};
    const Json& list = at(key, "a list");
    if (!list.is_array() || list.size() < least || list.size() > most)
        refuse(key,
               "must be a list of " + std::to_string(least) + " to " + std::to_string(most) + " objects");
    std::vector<JsonObject> all;
    for (size_t i = 0; i < list.size(); ++i)
        all.emplace_back(list[i], place_ + ", " + key + "[" + std::to_string(i + 1) + "]");
    return all;
}

std::vector<std::string> JsonObject::identifiers(const std::string& key, size_t most) const {
    if (!has(key)) return {};
    const Json& list = json_.at(key);
    if (!list.is_array() || list.size() > most)
        refuse(key, "must be a list of at most " + std::to_string(most) + " names");
    std::vector<std::string> all;
    for (const Json& entry : list) {
        if (!entry.is_string() || !isIdentifier(entry.get<std::string>()))
            refuse(key, "has an entry that is no name of 1 to 40 letters, digits, - or _");
        all.push_back(entry.get<std::string>());
    }
    return all;
}

JsonObject JsonObject::object(const std::string& key) const {
    return {at(key, "an object"), place_ + ", " + key};
}

}  // namespace bonemill::study
