#include "haptic_server/teaching/study/form_scoring.h"

namespace bonemill::study {
namespace {

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

std::vector<Score> scoresOf(const Form& form, const Values& values) {
    if (form.scoring == Scoring::kSus) return susOf(form, values);
    if (form.scoring == Scoring::kNasaTlx) return nasaTlxOf(form, values);
    return {};
}

}  // namespace bonemill::study
