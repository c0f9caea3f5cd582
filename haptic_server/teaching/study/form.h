// A questionnaire as a data file (docs/howto/study.md has its fields), what counts as an answer to it, and
// its scores. Pure after reading; any thread may read a form.
#pragma once

#include <map>
#include <optional>
#include <string>
#include <variant>
#include <vector>

#include "haptic_server/teaching/study/json_input.h"

namespace bonemill::study {

struct Option {
    double value = 0;
    std::string text;
    std::string counts_for;  // of NASA-TLX' pairs: the rating that it gives weight to
};

struct NumberRange {
    double least = 0, most = 0;
    double step = 0;  // 0: any number
};

// It has options, or a range, or takes words.
struct Item {
    std::string id, text;
    std::vector<Option> options;
    std::optional<NumberRange> range;
    size_t most_letters = 0;
    bool is_rating = false;  // statistics are made of it

    bool takesWords() const { return options.empty() && !range; }
};

struct Block {
    std::string id, title;
    std::vector<Item> items;
};

enum class Scoring { kNone, kNasaTlx, kSus };

struct Form {
    std::string id, language, title, source, instructions;
    size_t version = 0;
    Scoring scoring = Scoring::kNone;
    std::vector<Block> blocks;
    std::string digest;  // of its text: answers say which one they were given to

    const Item* find(const std::string& item_id) const {
        for (const Block& block : blocks)
            for (const Item& item : block.items)
                if (item.id == item_id) return &item;
        return nullptr;
    }
    std::vector<const Item*> items() const {
        std::vector<const Item*> all;
        for (const Block& block : blocks)
            for (const Item& item : block.items) all.push_back(&item);
        return all;
    }
};

// Throws UserError.
Form parseForm(const std::string& text, const std::string& file);
Form readForm(const std::filesystem::path& path);

// A value of options and ranges, or words.
using Answer = std::variant<double, std::string>;

// Says what is wrong with an answer to this item; nothing when it is right.
std::string wrongWith(const Item& item, const Answer& answer);

// What a terminal got for it: the number of an option as it is shown (from 1), a number, or words.
std::variant<Answer, std::string> answerOf(const Item& item, const std::string& line);

using Values = std::map<std::string, Answer>;  // by the items' ids; what was left out is not there

struct Score {
    std::string id, title;
    double value = 0;
};

// SUS (Brooke 1996): 0 to 100. NASA-TLX (Hart and Staveland 1988): the mean of the six ratings, and weighted
// by how often each was chosen in the pairs. A score of which an answer is missing is not made.
std::vector<Score> scoresOf(const Form& form, const Values& values);

}  // namespace bonemill::study
