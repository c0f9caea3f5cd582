#include "haptic_server/teaching/lessons/class_table.h"

#include <filesystem>

#include "common/attempts_csv/attempts_csv.h"
#include "common/files/line_file.h"
#include "haptic_server/recording/statistics/bone_files.h"

namespace bonemill {
namespace {

constexpr size_t kLongestHeader = 4096;
constexpr size_t kMaxTable = size_t(64) << 20;

// 0: it is no class table.
size_t columnsIn(const LineFile& file) {
    const std::string start = file.read(0, kLongestHeader);
    return attemptColumns(start.substr(0, start.find('\n')));
}

// The columns of the table: those of today, or fewer of a table that an earlier release began.
size_t columnsOf(const LineFile& file, const std::string& path) {
    if (file.size() == 0) return attemptColumns(kAttemptsHeader);
    const size_t columns = columnsIn(file);
    if (columns == 0)
        throw UserError(path + ": is there and has other columns than a class table; name another file");
    return columns;
}

}  // namespace

ClassTable::ClassTable(std::string path) : path_(std::move(path)) {
    if (path_.empty()) return;
    try {
        if (!std::filesystem::exists(path_)) {
            requireWritable(path_);
            return;
        }
        columnsOf(LineFile(path_), path_);
    } catch (const UserError& error) {
        throw UserError(std::string("--class-table ") + error.what());
    }
}

std::string ClassTable::append(const topics::Attempt& attempt, const std::string& scene) const {
    if (path_.empty()) return "";
    try {
        const LineFile file(path_);
        const size_t columns = columnsOf(file, path_);
        const std::string header = file.size() == 0 ? std::string(kAttemptsHeader) + "\n" : "";
        file.append(header + attemptLine(attempt, scene, columns) + "\n");
        return "";
    } catch (const std::exception& error) {
        return error.what();
    }
}

size_t ClassTable::forget(const std::string& path, const std::string& trainee) {
    const LineFile file(path);
    columnsOf(file, path);
    if (file.size() > off_t(kMaxTable))
        throw UserError(path + ": is larger than any class table; delete the lines by hand");
    const std::string text = file.read(0, size_t(file.size()));
    std::string kept;
    size_t forgotten = 0;
    for (size_t at = 0; at < text.size();) {
        const size_t end = std::min(text.find('\n', at), text.size() - 1) + 1;
        const std::string line = text.substr(at, end - at);
        if (at > 0 && isAttemptOf(line, trainee))
            ++forgotten;
        else
            kept += line;
        at = end;
    }
    if (forgotten > 0) file.replace(kept);
    return forgotten;
}

bool ClassTable::isTable(const std::string& path) {
    std::error_code error;
    if (!std::filesystem::is_regular_file(path, error)) return false;
    return columnsIn(LineFile(path)) > 0;
}

}  // namespace bonemill
