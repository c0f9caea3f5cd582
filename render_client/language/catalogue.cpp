#include "render_client/language/catalogue.h"

#include <sstream>
#include <utility>

namespace bonemill {
namespace {

// What stands between the first and the last quotation mark of the line, without its escapes.
std::string unquoted(std::string_view line) {
    const size_t begin = line.find('"'), end = line.rfind('"');
    std::string text;
    if (begin == end) return text;
    for (size_t n = begin + 1; n < end; ++n) {
        char sign = line[n];
        if (sign == '\\' && n + 1 < end) {
            sign = line[++n];
            sign = sign == 'n' ? '\n' : sign == 't' ? '\t' : sign;
        }
        text += sign;
    }
    return text;
}

class PoReader {
  public:
    void take(std::string_view line) {
        if (line.starts_with("#,")) {
            is_fuzzy_next_ = line.find("fuzzy") != std::string_view::npos;
        } else if (line.starts_with("msgctxt ")) {
            begin();
            part_ = &context_;
        } else if (line.starts_with("msgid ")) {
            if (part_ != &context_) begin();
            part_ = &text_;
        } else if (line.starts_with("msgstr ")) {
            part_ = &translation_;
        } else if (!line.starts_with('"')) {
            return;
        }
        if (part_ && !line.starts_with('#')) *part_ += unquoted(line);
    }
    Catalogue finish() {
        begin();
        return std::move(catalogue_);
    }

  private:
    // Another entry begins: the one before is complete. The first, of no text, is the head of the file.
    void begin() {
        if (!text_.empty() && !translation_.empty() && !is_fuzzy_)
            catalogue_[catalogueKey(context_, text_)] = translation_;
        context_.clear();
        text_.clear();
        translation_.clear();
        is_fuzzy_ = std::exchange(is_fuzzy_next_, false);
    }

    Catalogue catalogue_;
    std::string context_, text_, translation_;
    std::string* part_ = nullptr;
    bool is_fuzzy_ = false, is_fuzzy_next_ = false;
};

}  // namespace

std::string catalogueKey(std::string_view context, std::string_view text) {
    constexpr char kBetween = '\4';  // as in gettext's own files
    return context.empty() ? std::string(text) : std::string(context) + kBetween + std::string(text);
}

Catalogue catalogueOfPo(const std::string& text) {
    PoReader reader;
    std::istringstream lines(text);
    for (std::string line; std::getline(lines, line);) reader.take(line);
    return reader.finish();
}

}  // namespace bonemill
