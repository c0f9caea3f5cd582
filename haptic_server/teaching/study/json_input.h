// JSON that people write and that comes back from other PCs: nothing in it is believed before it was looked
// at. Every refusal is a UserError that names the file, the place in it and what would be right. It is for
// one thread.
#pragma once

#include <filesystem>
#include <nlohmann/json.hpp>
#include <string>
#include <string_view>
#include <vector>

namespace bonemill::study {

using Json = nlohmann::ordered_json;

inline constexpr size_t kMaxJsonBytes = 1 << 20;
inline constexpr size_t kMaxLetters = 1000;

// No key twice, no more than 12 levels, no more than kMaxJsonBytes, UTF-8.
Json parseJson(std::string text, const std::string& file);
Json readJson(const std::filesystem::path& path);

// 1 to 40 letters, digits, - and _: it may name a file, and nothing outside its folder.
bool isIdentifier(std::string_view text);
// UTF-8 without control characters, so that neither a terminal nor a table is led astray.
bool isPlainText(std::string_view text);

// An object of which every field is asked for by name.
class JsonObject {
  public:
    // `place` stands in messages: the file, and the way to the object in it. `json` outlives it.
    JsonObject(const Json& json, std::string place);

    const std::string& place() const { return place_; }
    bool has(const std::string& key) const { return json_.contains(key); }
    // Refuses fields that are not among these: a mistyped one would be passed over.
    void allowOnly(const std::vector<std::string_view>& keys) const;

    std::string text(const std::string& key, size_t most_bytes = 4 * kMaxLetters) const;
    std::string textOr(const std::string& key, const std::string& otherwise) const;
    std::string identifier(const std::string& key) const;
    double number(const std::string& key, double least, double most) const;
    double numberOr(const std::string& key, double otherwise, double least, double most) const;
    size_t whole(const std::string& key, size_t least, size_t most) const;
    bool flagOr(const std::string& key, bool otherwise) const;
    std::vector<JsonObject> objects(const std::string& key, size_t least, size_t most) const;
    std::vector<std::string> identifiers(const std::string& key,
                                         size_t most) const;  // none when it is not there
    JsonObject object(const std::string& key) const;
    const Json& json() const { return json_; }

    [[noreturn]] void refuse(const std::string& key, const std::string& what) const;

  private:
    const Json& at(const std::string& key, const char* what) const;

    const Json& json_;
    std::string place_;
};

}  // namespace bonemill::study
