#include "haptic_server/teaching/study/form.h"

#include <algorithm>
#include <charconv>
#include <cmath>
#include <fstream>
#include <iterator>
#include <set>

#include "common/base/user_error.h"
#include "common/digest/digest.h"
#include "common/files/require_file.h"
#include "common/text/csv_text.h"

namespace bonemill::study {
namespace {

constexpr size_t kMaxOptions = 30, kMaxItems = 300, kMaxBlocks = 30;

std::vector<Option> optionsOf(const JsonObject& json) {
    std::vector<Option> options;
    std::set<double> values;
    for (const JsonObject& entry : json.objects("options", 2, kMaxOptions)) {
        entry.allowOnly({"value", "text", "counts_for"});
        options.push_back({entry.number("value", -1000, 1000), entry.text("text"),
                           entry.has("counts_for") ? entry.identifier("counts_for") : std::string()});
        if (!values.insert(options.back().value).second) entry.refuse("value", "stands there twice");
    }
    return options;
}

// What scale and item say about the answer.
void readScale(const JsonObject& json, Item& item) {
    item.is_rating = json.flagOr("rating", false);
    if (json.has("options")) {
        item.options = optionsOf(json);
    } else if (json.has("least")) {
        item.range = NumberRange{json.number("least", -1e9, 1e9), json.number("most", -1e9, 1e9),
                                 json.numberOr("step", 0, 1e-6, 1e9)};
        if (!(item.range->least < item.range->most)) json.refuse("most", "must be above \"least\"");
    } else {
        item.most_letters = json.whole("most_letters", 1, kMaxLetters);
        if (item.is_rating) json.refuse("rating", "goes with options or with least and most");
    }
}

Item readItem(const JsonObject& json, const JsonObject& form) {
    json.allowOnly({"id", "text", "scale", "options"});
    Item item;
    item.id = json.identifier("id");
    item.text = json.text("text");
    if (json.has("options")) {
        item.options = optionsOf(json);
        return item;
    }
    const std::string name = json.identifier("scale");
    const JsonObject scales = form.object("scales");
    if (!scales.has(name)) json.refuse("scale", "is \"" + name + "\", which \"scales\" does not have");
    const JsonObject scale = scales.object(name);
    scale.allowOnly({"rating", "options", "least", "most", "step", "most_letters"});
    readScale(scale, item);
    return item;
}

Scoring scoringOf(const JsonObject& json) {
    const std::string name = json.textOr("scoring", "none");
    if (name == "none") return Scoring::kNone;
    if (name == "nasa_tlx") return Scoring::kNasaTlx;
    if (name == "sus") return Scoring::kSus;
    json.refuse("scoring", "must be none, nasa_tlx or sus");
}

// A score is made of answers that it was made for, and of no others.
void checkScoring(const Form& form, const JsonObject& json) {
    const std::vector<const Item*> items = form.items();
    const auto ratings =
        std::count_if(items.begin(), items.end(), [](const Item* item) { return item->is_rating; });
    if (form.scoring == Scoring::kSus) {
        const bool fits = std::all_of(items.begin(), items.end(), [](const Item* item) {
            return item->options.size() == 5 && item->options.front().value == 1 &&
                   item->options.back().value == 5;
        });
        if (items.size() != 10 || !fits)
            json.refuse("scoring", "sus goes with ten items of five options, from 1 to 5");
    }
    if (form.scoring != Scoring::kNasaTlx) return;
    if (ratings < 2) json.refuse("scoring", "nasa_tlx goes with two or more ratings");
    for (const Item* item : items)
        for (const Option& option : item->options) {
            const Item* const rated = form.find(option.counts_for);
            if (!item->is_rating && (!rated || !rated->is_rating))
                json.refuse("scoring", "nasa_tlx: an option of " + item->id + " counts for no rating");
        }
}

std::string rangeText(const NumberRange& range) {
    return "a number from " + numberText(range.least) + " to " + numberText(range.most) +
           (range.step > 0 ? " in steps of " + numberText(range.step) : "");
}

bool isOnStep(const NumberRange& range, double value) {
    if (range.step <= 0) return true;
    const double steps = (value - range.least) / range.step;
    return std::abs(steps - std::round(steps)) < 1e-6;
}

size_t lettersOf(const std::string& text) {
    return size_t(
        std::count_if(text.begin(), text.end(), [](char c) { return (uint8_t(c) & 0xc0) != 0x80; }));
}

std::optional<double> valueOf(const Values& values, const std::string& id) {
    const auto found = values.find(id);
    if (found == values.end() || !std::holds_alternative<double>(found->second)) return {};
    return std::get<double>(found->second);
}

// The odd statements are in favour, the even ones against.
std::vector<Score> susOf(const Form& form, const Values& values) {
    double sum = 0;
    bool is_odd = true;
    for (const Item* item : form.items()) {
        const std::optional<double> value = valueOf(values, item->id);
        if (!value) return {};
        sum += is_odd ? *value - 1 : 5 - *value;
        is_odd = !is_odd;
    }
    return {{"sus", "SUS, 0 to 100", 2.5 * sum}};
}

std::vector<Score> nasaTlxOf(const Form& form, const Values& values) {
    double sum = 0, ratings = 0, weighted = 0, weights = 0;
    bool has_pairs = false;
    for (const Item* item : form.items()) {
        const std::optional<double> value = valueOf(values, item->id);
        if (item->is_rating) {
            if (!value) return {};
            sum += *value;
            ++ratings;
            continue;
        }
        has_pairs = true;
        for (const Option& option : item->options) {
            const std::optional<double> rating = valueOf(values, option.counts_for);
            if (!value || option.value != *value || !rating) continue;
            weighted += *rating;
            ++weights;
        }
    }
    std::vector<Score> scores = {{"raw_tlx", "NASA-TLX, mean of the ratings, 0 to 100", sum / ratings}};
    const double pairs = ratings * (ratings - 1) / 2;
    if (has_pairs && weights == pairs)
        scores.push_back({"weighted_tlx", "NASA-TLX, weighted, 0 to 100", weighted / weights});
    return scores;
}

}  // namespace

Form parseForm(const std::string& text, const std::string& file) {
    const Json parsed = parseJson(text, file);
    const JsonObject json(parsed, file);
    json.allowOnly(
        {"form", "version", "language", "title", "source", "instructions", "scoring", "scales", "blocks"});
    Form form;
    form.id = json.identifier("form");
    form.version = json.whole("version", 1, 1'000'000);
    form.language = json.identifier("language");
    form.title = json.text("title");
    form.source = json.textOr("source", "");
    form.instructions = json.textOr("instructions", "");
    form.scoring = scoringOf(json);
    form.digest = sha256OfText(text);
    std::set<std::string> ids;
    for (const JsonObject& entry : json.objects("blocks", 1, kMaxBlocks)) {
        entry.allowOnly({"id", "title", "items"});
        Block& block = form.blocks.emplace_back(Block{entry.identifier("id"), entry.text("title"), {}});
        for (const JsonObject& item : entry.objects("items", 1, kMaxItems)) {
            block.items.push_back(readItem(item, json));
            if (!ids.insert(block.items.back().id).second) item.refuse("id", "stands in the form twice");
        }
    }
    checkScoring(form, json);
    return form;
}

Form readForm(const std::filesystem::path& path) {
    requireFile(path);
    std::ifstream file(path, std::ios::binary);
    if (!file || std::filesystem::is_directory(path))
        throw UserError(path.string() + ": cannot be read; is it there, and may you read it?");
    if (std::filesystem::file_size(path) > kMaxJsonBytes)
        throw UserError(path.string() + ": is larger than 1 MiB; it is no questionnaire");
    return parseForm(std::string(std::istreambuf_iterator<char>(file), {}), path.string());
}

std::string wrongWith(const Item& item, const Answer& answer) {
    if (item.takesWords()) {
        const std::string* words = std::get_if<std::string>(&answer);
        if (!words) return "must be words";
        if (!isPlainText(*words)) return "has control characters, or is no UTF-8";
        if (lettersOf(*words) > item.most_letters)
            return "has more than " + std::to_string(item.most_letters) + " letters";
        return {};
    }
    const double* value = std::get_if<double>(&answer);
    if (item.range) {
        const bool fits = value && *value >= item.range->least && *value <= item.range->most;
        return fits && isOnStep(*item.range, *value) ? "" : "must be " + rangeText(*item.range);
    }
    for (const Option& option : item.options)
        if (value && option.value == *value) return {};
    return "is none of the options";
}

std::variant<Answer, std::string> answerOf(const Item& item, const std::string& line) {
    if (item.takesWords()) {
        const std::string wrong = wrongWith(item, line);
        if (!wrong.empty()) return "shorten or retype it: it " + wrong;
        return Answer(line);
    }
    double value = 0;
    const auto [end, error] = std::from_chars(line.data(), line.data() + line.size(), value);
    const bool is_number = error == std::errc() && end == line.data() + line.size() && std::isfinite(value);
    if (item.range) {
        if (!is_number || !wrongWith(item, value).empty()) return "type " + rangeText(*item.range);
        return Answer(value);
    }
    if (!is_number || value != std::floor(value) || value < 1 || value > double(item.options.size()))
        return "type a number from 1 to " + std::to_string(item.options.size());
    return Answer(item.options[size_t(value) - 1].value);
}

std::vector<Score> scoresOf(const Form& form, const Values& values) {
    if (form.scoring == Scoring::kSus) return susOf(form, values);
    if (form.scoring == Scoring::kNasaTlx) return nasaTlxOf(form, values);
    return {};
}

}  // namespace bonemill::study
