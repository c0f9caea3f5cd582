#include "haptic_server/cases/casework/case_request.h"

#include <CLI/CLI.hpp>
#include <algorithm>
#include <charconv>

#include "common/base/user_error.h"
#include "common/cli/command_line.h"
#include "common/text/printed_text.h"
#include "haptic_server/scans/labels/labels.h"

namespace bonemill {

void addCaseOptions(CLI::App& app, CaseRequest& request) {
    app.add_option("scan", request.scan,
                   "folder of a DICOM series or of images, a file, or an archive of them")
        ->required();
    app.add_option("--out", request.out, "new folder for the case")->required()->type_name("DIR");
    app.add_option("--series", request.series,
                   "UID of the series; default: the one that list-series recommends");
    app.add_option("--acquisition", request.acquisition,
                   "which of the series' acquisitions, phases or kernels, as list-series names them");
    app.add_option("--spacing-mm", request.spacing_mm,
                   "edges of the voxels, mm, for images and files that do not say them")
        ->expected(3);
    app.add_option("--title", request.title, "what people read in the list of scenes");
    app.add_option("--task", request.task, "what the trainee is to do");
    app.add_option("--credit", request.credit,
                   "who is to be named for the scan, and its licence; stands behind the task");
    app.add_option("--iso", request.iso, "raw value (HU) of the bone's surface; default: proposed");
    app.add_option("--at", request.at_mm,
                   "middle of the part that is milled, in W (docs/reference/frames.md), mm; default: all is")
        ->expected(3);
    app.add_option("--size-mm", request.size_mm, "edge of that part")
        ->check(within(2, 500))
        ->capture_default_str();
    app.add_option("--voxel-mm", request.voxel_mm,
                   "of that part; default: a quarter of the smallest burr's radius")
        ->check(within(0.01, 10));
    app.add_option("--from", request.from_mm, "where the hand comes from, in W, mm; default: from outside")
        ->expected(3);
    app.add_option("--drop-piece", request.drop_pieces, "leaves this piece of bone out, may be given again");
    app.add_option("--labels", request.labels, "label map, on any grid");
    app.add_option(
        "--label", request.label_words,
        "NUMBER=NAME of a structure in it, or the NAME of a segment that its file names, with :protected or "
        ":target behind it, may be given again");
    app.add_option("--tools", request.tools, "scene text with the tools, as those in deploy/tools")
        ->type_name("FILE");
    app.add_option(
           "--figures", request.figures,
           "new folder with what gnuplot makes the pictures of pieces and values of, as deploy/make-case "
           "does")
        ->type_name("DIR");
}

namespace {

// As short as reads back the same.
std::string numberText(double value) {
    char text[32];
    return {text, std::to_chars(text, text + sizeof text, value).ptr};
}

class RequestWords {
  public:
    explicit RequestWords(const std::string& first) : words_{first} {}

    void add(const char* option, const std::string& word) {
        if (!word.empty()) words_.insert(words_.end(), {option, word});
    }
    void add(const char* option, const std::optional<double>& number) {
        if (number) add(option, numberText(*number));
    }
    void add(const char* option, const std::vector<double>& numbers) {
        if (!numbers.empty()) words_.push_back(option);
        for (const double number : numbers) words_.push_back(numberText(number));
    }
    std::vector<std::string> take() { return std::move(words_); }

  private:
    std::vector<std::string> words_;
};

// Without "=" the name is a segment's.
CaseLabel numberAndName(const std::string& word) {
    const size_t equals = word.find('=');
    if (equals == std::string::npos) return {.labels = {}, .name = word};
    uint32_t number = 0;
    const char* const end = word.data() + equals;
    const auto read = std::from_chars(word.data(), end, number);
    if (read.ec != std::errc() || read.ptr != end || number > kMaxLabel)
        throw UserError("--label " + word +
                        ": write NUMBER=NAME, or the NAME of a segment, and :protected or :target behind it");
    return {.labels = {number}, .name = word.substr(equals + 1)};
}

CaseLabel labelOf(const std::string& word) {
    CaseLabel label = numberAndName(word);
    const auto endsIn = [&](const std::string& role) {
        if (!label.name.ends_with(role)) return false;
        label.name.resize(label.name.size() - role.size());
        return true;
    };
    if (endsIn(":protected"))
        label.role = CaseLabel::Role::kProtected;
    else if (endsIn(":target"))
        label.role = CaseLabel::Role::kTarget;
    if (label.name.empty()) throw UserError("--label " + word + ": the structure has no name");
    return label;
}

bool isSameStructure(const CaseLabel& a, const CaseLabel& b) {
    return a.name == b.name || (!a.labels.empty() && a.labels == b.labels);
}

}  // namespace

std::vector<std::string> wordsOf(const CaseRequest& request) {
    RequestWords words(request.scan);
    words.add("--out", request.out);
    words.add("--series", request.series);
    words.add("--acquisition", request.acquisition);
    words.add("--spacing-mm", request.spacing_mm);
    words.add("--title", request.title);
    words.add("--task", request.task);
    words.add("--credit", request.credit);
    words.add("--iso", request.iso);
    words.add("--at", request.at_mm);
    if (!request.at_mm.empty()) words.add("--size-mm", std::optional(request.size_mm));
    words.add("--voxel-mm", request.voxel_mm);
    words.add("--from", request.from_mm);
    for (const uint32_t piece : request.drop_pieces) words.add("--drop-piece", std::to_string(piece));
    words.add("--labels", request.labels);
    for (const std::string& word : request.label_words) words.add("--label", word);
    words.add("--tools", request.tools);
    words.add("--figures", request.figures);
    return words.take();
}

std::string commandLineOf(const std::string& command, const CaseRequest& request) {
    std::string line = command;
    for (const std::string& word : wordsOf(request)) line += " " + quoted(word);
    return line;
}

std::vector<CaseLabel> labelsOf(const std::vector<std::string>& words) {
    std::vector<CaseLabel> labels;
    for (const std::string& word : words) {
        labels.push_back(labelOf(word));
        for (size_t n = 0; n + 1 < labels.size(); ++n)
            if (isSameStructure(labels[n], labels.back()))
                throw UserError("--label " + word + ": that number or name was given before");
    }
    return labels;
}

void findSegments(const Segments& segments, const std::string& file, std::vector<CaseLabel>& labels) {
    for (CaseLabel& label : labels) {
        if (!label.labels.empty()) {
            if (!segments.are_layered) continue;
            throw UserError(file + ": its labels lie in several layers; give --label the names of segments");
        }
        label.labels = labelsOfSegment(segments, label.name, file);
        if (label.labels.empty()) throw UserError(file + ": its segment " + label.name + " has no voxel");
        label.color = std::ranges::find(segments.list, label.name, &Segment::name)->color;
    }
}

}  // namespace bonemill
