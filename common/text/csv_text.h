// Tables that a spreadsheet and other programs open: comma-separated values. Pure; any thread may call it, it
// allocates.
#pragma once

#include <charconv>
#include <cstring>
#include <string>
#include <string_view>
#include <type_traits>

namespace bonemill {

// Makes one field of a text, in quotes. A spreadsheet takes what begins with = + - or @ for a formula, so an
// apostrophe goes before.
inline std::string csvText(const std::string& text) {
    std::string field = "\"";
    if (!text.empty() && std::strchr("=+-@\t\r", text[0])) field += '\'';
    for (const char c : text) {
        if (c == '"') field += '"';
        field += static_cast<unsigned char>(c) < ' ' ? ' ' : c;
    }
    return field + '"';
}

// The fewest digits that read back as the same number.
template <class Number>
std::string numberText(Number value) {
    char text[32];  // the longest shortest double has 24 characters
    return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

// One line of a table, field by field.
class CsvLine {
  public:
    CsvLine& operator<<(const std::string& text) { return field(csvText(text)); }
    CsvLine& operator<<(const char* text) { return *this << std::string(text); }
    // NaN is an empty field.
    template <class Number>
    requires std::is_arithmetic_v<Number> CsvLine& operator<<(Number value) {
        return field(value == value ? numberText(value) : "");
    }
    CsvLine& nothing() { return field(""); }
    // As it is.
    CsvLine& field(std::string_view text) {
        if (!is_empty_) text_ += ',';
        is_empty_ = false;
        text_ += text;
        return *this;
    }
    const std::string& text() const { return text_; }
    std::string end() const { return text_ + '\n'; }

  private:
    std::string text_;
    bool is_empty_ = true;
};

}  // namespace bonemill
