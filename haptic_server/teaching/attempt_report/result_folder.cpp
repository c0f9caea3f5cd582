#include "haptic_server/teaching/attempt_report/result_folder.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <fstream>
#include <functional>
#include <nlohmann/json.hpp>

#include "common/files/line_file.h"
#include "common/files/whole_file.h"
#include "haptic_server/teaching/attempt_report/attempt_result.h"

namespace bonemill {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMaxStatements = size_t(256) << 20;

// The text of a file of at most `most` bytes.
std::string readBounded(const fs::path& file, size_t most) {
    std::ifstream input(file, std::ios::binary);
    std::error_code error;
    const uintmax_t size = fs::file_size(file, error);
    std::string text(error ? most + 1 : std::min<uintmax_t>(most, size) + 1, '\0');
    input.read(text.data(), std::streamsize(text.size()));
    const auto count = size_t(input.gcount());
    if (input.bad() || (!input.is_open())) throw UserError(file.string() + ": cannot be read");
    if (count > most) throw UserError(file.string() + ": has more than " + std::to_string(most) + " bytes");
    text.resize(count);
    return text;
}

// Those whose names have this part.
std::vector<fs::path> resultFiles(const fs::path& folder, const std::string& part) {
    std::vector<fs::path> files;
    std::error_code error;
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
        const fs::path& path = entry.path();
        if (path.extension() == ".json" && path.filename().string().find(part) != std::string::npos &&
            entry.is_regular_file(error))
            files.push_back(path);
    }
    return files;
}

void eachResult(const fs::path& class_folder,
                const std::function<void(const fs::path&, const AttemptResult&)>& see) {
    const ResultFolder folder(class_folder);
    for (const fs::path& part : {folder.results(), folder.experts()}) {
        // A file of unknown kind ends this: it may be the person's.
        std::error_code error;
        std::vector<fs::path> files;
        for (const fs::directory_entry& entry : fs::directory_iterator(part, error))
            if (entry.path().extension() == ".json" && entry.is_regular_file()) files.push_back(entry.path());
        std::ranges::sort(files);
        for (const fs::path& file : files) {
            try {
                see(file, readResultFile(file));
            } catch (const UserError&) {
                continue;  // no person's result
            }
        }
    }
}

void deleteFile(const fs::path& file, Forgotten& forgotten) {
    std::error_code error;
    if (fs::remove(file, error)) forgotten.deleted.push_back(file.string());
    if (error) forgotten.problems.push_back(file.string() + ": cannot be deleted: " + error.message());
}

bool isStatementOf(const std::string& line, const std::string& pseudonym) {
    const auto json = nlohmann::json::parse(line, nullptr, false);
    const nlohmann::json::json_pointer name("/actor/account/name");
    return json.is_object() && json.contains(name) && json.at(name) == pseudonym;
}

void forgetStatements(const fs::path& path, const std::string& pseudonym, Forgotten& forgotten) {
    std::error_code error;
    if (!fs::is_regular_file(path, error)) return;
    try {
        const LineFile file(path);
        if (file.size() > off_t(kMaxStatements))
            throw UserError(path.string() + ": is too large; delete the person's lines by hand");
        const size_t count =
            file.removeLines([&](const std::string& line, bool) { return isStatementOf(line, pseudonym); });
        if (count > 0)
            forgotten.deleted.push_back(path.string() + ": " + std::to_string(count) + " statements");
    } catch (const UserError& problem) {
        forgotten.problems.emplace_back(problem.what());
    }
}

// The page is made of the results, in which this person is no more.
void forgetInClassPage(const fs::path& class_folder, Forgotten& forgotten) {
    const ResultFolder folder(class_folder);
    std::error_code error;
    if (!fs::exists(folder.classPage(), error)) return;
    try {
        folder.writeClassPage();
    } catch (const UserError& problem) {
        forgotten.problems.push_back(folder.classPage().string() +
                                     ": may still name the person: " + problem.what());
    }
}

std::string utc(const AttemptResult& result, const char* format) {
    const std::time_t seconds = std::time_t(result.start_unix_ns / 1'000'000'000);
    std::tm parts{};
    char text[32] = "";
    if (result.start_unix_ns > 0 && gmtime_r(&seconds, &parts))
        std::strftime(text, sizeof text, format, &parts);
    return text;
}

// Two people's names are two: what a file's name cannot say is told by a sum of all of it (FNV-1a).
std::string inFileName(const std::string& pseudonym) {
    std::string name;
    uint32_t sum = 2166136261u;
    for (const char c : pseudonym) {
        name += (c >= 'a' && c <= 'z') || (c >= 'A' && c <= 'Z') || (c >= '0' && c <= '9') ? c : '_';
        sum = (sum ^ uint8_t(c)) * 16777619u;
    }
    char text[10];
    std::snprintf(text, sizeof text, "-%08x", sum);
    return name == pseudonym ? name : name + text;
}

// Another user may have put a link there, to have another file written over.
void requireNoLink(const fs::path& path) {
    std::error_code error;
    if (fs::is_symlink(fs::symlink_status(path, error)))
        throw UserError(path.string() + ": is a link; results are not written through one, take it away");
}

}  // namespace

AttemptResult readResultFile(const fs::path& file) {
    return parseResult(readBounded(file, kMaxResult), file.string());
}

Forgotten forgetResults(const fs::path& class_folder, const std::string& pseudonym) {
    Forgotten forgotten;
    eachResult(class_folder, [&](const fs::path& file, const AttemptResult& result) {
        if (result.pseudonym != pseudonym) return;
        for (const char* beside : {".html", ".png"})
            deleteFile(fs::path(file).replace_extension(beside), forgotten);
        deleteFile(file, forgotten);
    });
    forgetStatements(ResultFolder(class_folder).statements(), pseudonym, forgotten);
    forgetInClassPage(class_folder, forgotten);
    return forgotten;
}

std::string utcText(const AttemptResult& result) {
    return utc(result, "%Y-%m-%dT%H:%M:%SZ");
}

std::string fileStemOf(const AttemptResult& result) {
    return utc(result, "%Y%m%dT%H%M%SZ") + '_' + inFileName(result.pseudonym) + '_' +
           std::to_string(result.number);
}

void ResultFolder::write(const AttemptResult& result, std::vector<ReportPicture> pictures,
                         double begin_s) const {
    const fs::path stem = results() / fileStemOf(result);
    const auto with = [&](const char* ending) {
        fs::path file(stem.string() + ending);
        requireNoLink(file);
        return file;
    };
    requireNoLink(results());
    writePrivateFile(with(".json"), resultJson(result));
    ReportExtras extras;
    extras.pictures = std::move(pictures);
    extras.begin_s = begin_s;
    extras.own = read(results(), result.scene_hash, result.pseudonym);
    std::erase_if(extras.own, [&](const AttemptResult& own) {
        return result.assessment.total && own.assessment.total &&
               own.assessment.total->weights_hash != result.assessment.total->weights_hash;
    });
    extras.comparison = compareWith(read(experts(), result.scene_hash, ""), result);
    writePrivateFile(with(".html"), htmlReport(result, extras));
    LineFile(statements()).append(xapiStatement(result) + "\n");
}

void ResultFolder::writeClassPage() const {
    requireNoLink(classPage());
    writePrivateFile(classPage(),
                     bonemill::classPage(read(results(), "", ""), results().filename().string()));
}

std::vector<AttemptResult> ResultFolder::read(const fs::path& folder, const std::string& scene_hash,
                                              const std::string& pseudonym) {
    std::vector<fs::path> files =
        resultFiles(folder, pseudonym.empty() ? "" : '_' + inFileName(pseudonym) + '_');
    std::ranges::sort(files, std::ranges::greater{});
    if (files.size() > kMaxRead) files.resize(kMaxRead);
    std::vector<AttemptResult> results;
    for (const fs::path& file : files) {
        try {
            AttemptResult result = readResultFile(file);
            if ((scene_hash.empty() || result.scene_hash == scene_hash) &&
                (pseudonym.empty() || result.pseudonym == pseudonym))
                results.push_back(std::move(result));
        } catch (const UserError&) {
            continue;  // as the header says
        }
    }
    std::ranges::stable_sort(results, {}, &AttemptResult::start_unix_ns);
    return results;
}

}  // namespace bonemill
