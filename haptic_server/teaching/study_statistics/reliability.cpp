#include "haptic_server/teaching/study_statistics/reliability.h"

namespace bonemill::study {
namespace {

std::vector<double> rowMeansOf(const Table& table) {
    std::vector<double> means;
    for (const std::vector<double>& row : table) means.push_back(meanOf(row));
    return means;
}

}  // namespace

std::vector<double> columnOf(const Table& table, size_t column) {
    std::vector<double> values;
    for (const std::vector<double>& row : table) values.push_back(row[column]);
    return values;
}

double cronbachsAlpha(const Table& people_items) {
    if (people_items.size() < 2 || people_items[0].size() < 2) return kNotKnown;
    const double items = double(people_items[0].size());
    double of_items = 0;
    for (size_t i = 0; i < people_items[0].size(); ++i) of_items += varianceOf(columnOf(people_items, i));
    std::vector<double> sums = rowMeansOf(people_items);
    for (double& sum : sums) sum *= items;
    const double of_sums = varianceOf(sums);
    return of_sums > 0 ? items / (items - 1) * (1 - of_items / of_sums) : kNotKnown;
}

double icc21(const Table& things_raters) {
    if (things_raters.size() < 2 || things_raters[0].size() < 2) return kNotKnown;
    const double n = double(things_raters.size()), k = double(things_raters[0].size());
    const std::vector<double> row_means = rowMeansOf(things_raters);
    std::vector<double> column_means;
    for (size_t i = 0; i < things_raters[0].size(); ++i)
        column_means.push_back(meanOf(columnOf(things_raters, i)));
    const double rows = k * varianceOf(row_means), columns = n * varianceOf(column_means);
    const double mean = meanOf(row_means);
    double squares = 0;
    for (size_t i = 0; i < things_raters.size(); ++i)
        for (size_t j = 0; j < things_raters[i].size(); ++j) {
            const double rest = things_raters[i][j] - row_means[i] - column_means[j] + mean;
            squares += rest * rest;
        }
    const double error = squares / ((n - 1) * (k - 1));
    const double all = rows + (k - 1) * error + k * (columns - error) / n;
    return all > 0 ? (rows - error) / all : kNotKnown;
}

double cohensKappa(Sample first, Sample second, KappaWeights weights) {
    if (first.empty() || first.size() != second.size()) return kNotKnown;
    const auto weight = [&](double a, double b) {
        return weights == KappaWeights::kNone ? double(a != b) : (a - b) * (a - b);
    };
    double seen = 0, by_chance = 0;
    for (size_t i = 0; i < first.size(); ++i) {
        seen += weight(first[i], second[i]);
        for (const double b : second) by_chance += weight(first[i], b) / double(first.size());
    }
    return by_chance > 0 ? 1 - seen / by_chance : kNotKnown;
}

}  // namespace bonemill::study
