#include "haptic_server/teaching/study_report/agreement.h"

#include <charconv>
#include <fstream>
#include <vector>

#include "common/base/user_error.h"
#include "common/files/require_file.h"
#include "haptic_server/teaching/study/json_input.h"
#include "haptic_server/teaching/study_report/number_text.h"
#include "haptic_server/teaching/study_statistics/reliability.h"

namespace bonemill::study {
namespace {

constexpr size_t kMaxRaters = 50, kMaxRows = 10'000, kMaxBytes = 10'000, kMaxFileBytes = 10'000'000;

std::vector<std::string> fieldsOf(const std::string& line) {
    std::vector<std::string> fields = {""};
    for (const char c : line) {
        if (c == ',')
            fields.emplace_back();
        else if (c != '\r' && c != '"' && c != ' ')
            fields.back() += c;
    }
    return fields;
}

struct Ratings {
    std::vector<std::string> raters;
    Table table;
};

std::vector<double> numbersOf(const std::vector<std::string>& fields, size_t count,
                              const std::string& place) {
    std::vector<double> numbers;
    for (const std::string& field : fields) {
        double value = 0;
        const auto [end, error] = std::from_chars(field.data(), field.data() + field.size(), value);
        if (error != std::errc() || end != field.data() + field.size() || !(std::abs(value) <= 1e9))
            throw UserError(place + ": every field must be a number");
        numbers.push_back(value);
    }
    if (numbers.size() != count) throw UserError(place + ": has not as many fields as the header");
    return numbers;
}

Ratings readRatings(const std::filesystem::path& path) {
    requireFile(path);
    std::ifstream file(path);
    if (!file || std::filesystem::is_directory(path)) throw UserError(path.string() + ": cannot be read");
    if (std::filesystem::file_size(path) > kMaxFileBytes)
        throw UserError(path.string() + ": is larger than 10 MB");
    Ratings ratings;
    size_t number = 0;
    for (std::string line; std::getline(file, line);) {
        const std::string place = path.string() + ", line " + std::to_string(++number);
        if (line.size() > kMaxBytes || number > kMaxRows) throw UserError(place + ": the table is too large");
        if (line.empty() || line == "\r") continue;
        const std::vector<std::string> fields = fieldsOf(line);
        if (!ratings.raters.empty()) {
            ratings.table.push_back(numbersOf(fields, ratings.raters.size(), place));
            continue;
        }
        for (const std::string& field : fields)
            if (!isPlainText(field)) throw UserError(place + ": the header must name the raters");
        ratings.raters = fields;
    }
    if (ratings.raters.size() < 2 || ratings.raters.size() > kMaxRaters || ratings.table.size() < 2)
        throw UserError(path.string() + ": needs a header, 2 to 50 columns of raters and two rows or more");
    return ratings;
}

}  // namespace

std::string agreementText(const std::filesystem::path& file) {
    const Ratings ratings = readRatings(file);
    std::string text = "ICC(2,1), single raters, absolute agreement: " + fixedText(icc21(ratings.table), 3) +
                       " (" + std::to_string(ratings.table.size()) + " things, " +
                       std::to_string(ratings.raters.size()) + " raters)\n";
    for (size_t i = 0; i < ratings.raters.size(); ++i)
        for (size_t j = i + 1; j < ratings.raters.size(); ++j) {
            const std::vector<double> a = columnOf(ratings.table, i), b = columnOf(ratings.table, j);
            text += "kappa of " + ratings.raters[i] + " and " + ratings.raters[j] + ": " +
                    fixedText(cohensKappa(a, b, KappaWeights::kNone), 3) + ", with quadratic weights " +
                    fixedText(cohensKappa(a, b, KappaWeights::kQuadratic), 3) + "\n";
        }
    return text;
}

}  // namespace bonemill::study
