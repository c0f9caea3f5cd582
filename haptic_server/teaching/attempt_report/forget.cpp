#include "haptic_server/teaching/attempt_report/forget.h"

#include <algorithm>
#include <functional>
#include <nlohmann/json.hpp>

#include "common/files/line_file.h"
#include "haptic_server/teaching/attempt_report/result_folder.h"
#include "haptic_server/teaching/attempt_report/result_json.h"

namespace bonemill {
namespace {

namespace fs = std::filesystem;

constexpr size_t kMaxStatements = size_t(256) << 20;

void eachResult(const fs::path& class_folder,
                const std::function<void(const fs::path&, const AttemptResult&)>& see) {
    const ResultFolder folder(class_folder);
    for (const fs::path& part : {folder.results(), folder.experts()}) {
        std::error_code error;
        std::vector<fs::path> files;
        for (const fs::directory_entry& entry : fs::directory_iterator(part, error))
            if (entry.path().extension() == ".json" && entry.is_regular_file()) files.push_back(entry.path());
        std::ranges::sort(files);
        for (const fs::path& file : files) {
            try {
                see(file, parseResult(readBounded(file, kMaxResult), file.string()));
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
        const std::string text = file.read(0, size_t(file.size()));
        std::string kept;
        size_t count = 0;
        for (size_t at = 0; at < text.size();) {
            const size_t end = std::min(text.find('\n', at), text.size() - 1) + 1;
            const std::string line = text.substr(at, end - at);
            if (isStatementOf(line, pseudonym))
                ++count;
            else
                kept += line;
            at = end;
        }
        if (count == 0) return;
        file.replace(kept);
        forgotten.deleted.push_back(path.string() + ": " + std::to_string(count) + " statements");
    } catch (const UserError& problem) {
        forgotten.problems.emplace_back(problem.what());
    }
}

}  // namespace

Forgotten forgetResults(const fs::path& class_folder, const std::string& pseudonym) {
    Forgotten forgotten;
    eachResult(class_folder, [&](const fs::path& file, const AttemptResult& result) {
        if (result.pseudonym != pseudonym) return;
        fs::path report = file;
        deleteFile(report.replace_extension(".html"), forgotten);
        deleteFile(file, forgotten);
    });
    forgetStatements(ResultFolder(class_folder).statements(), pseudonym, forgotten);
    return forgotten;
}

}  // namespace bonemill
