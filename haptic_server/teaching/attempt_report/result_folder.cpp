#include "haptic_server/teaching/attempt_report/result_folder.h"

#include <algorithm>
#include <cstdint>
#include <cstdio>
#include <ctime>
#include <fstream>

#include "common/files/line_file.h"
#include "common/files/whole_file.h"
#include "haptic_server/teaching/attempt_report/result_json.h"
#include "haptic_server/teaching/attempt_report/xapi.h"

namespace bonemill {
namespace {

namespace fs = std::filesystem;

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

std::string utcText(const AttemptResult& result) {
    return utc(result, "%Y-%m-%dT%H:%M:%SZ");
}

std::string fileStemOf(const AttemptResult& result) {
    return utc(result, "%Y%m%dT%H%M%SZ") + '_' + inFileName(result.pseudonym) + '_' +
           std::to_string(result.number);
}

std::string readBounded(const fs::path& file, size_t most) {
    std::ifstream input(file, std::ios::binary);
    std::string text(most + 1, '\0');
    input.read(text.data(), std::streamsize(text.size()));
    const auto count = size_t(input.gcount());
    if (input.bad() || (!input.is_open())) throw UserError(file.string() + ": cannot be read");
    if (count > most) throw UserError(file.string() + ": has more than " + std::to_string(most) + " bytes");
    text.resize(count);
    return text;
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
    extras.comparison = compareWith(read(experts(), result.scene_hash, ""), result);
    writePrivateFile(with(".html"), htmlReport(result, extras));
    LineFile(statements()).append(xapiStatement(result) + "\n");
}

std::vector<AttemptResult> ResultFolder::read(const fs::path& folder, const std::string& scene_hash,
                                              const std::string& pseudonym) {
    std::vector<fs::path> files;
    std::error_code error;
    const std::string part = pseudonym.empty() ? "" : '_' + inFileName(pseudonym) + '_';
    for (const fs::directory_entry& entry : fs::directory_iterator(folder, error)) {
        const fs::path& path = entry.path();
        if (path.extension() == ".json" && path.filename().string().find(part) != std::string::npos &&
            entry.is_regular_file(error))
            files.push_back(path);
    }
    std::ranges::sort(files, std::ranges::greater{});
    if (files.size() > kMaxRead) files.resize(kMaxRead);
    std::vector<AttemptResult> results;
    for (const fs::path& file : files) {
        try {
            AttemptResult result = parseResult(readBounded(file, kMaxResult), file.string());
            if (result.scene_hash == scene_hash && (pseudonym.empty() || result.pseudonym == pseudonym))
                results.push_back(std::move(result));
        } catch (const UserError&) {
            continue;  // as the header says
        }
    }
    std::ranges::stable_sort(results, {}, &AttemptResult::start_unix_ns);
    return results;
}

}  // namespace bonemill
