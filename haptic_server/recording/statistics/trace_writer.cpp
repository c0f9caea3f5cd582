#include "haptic_server/recording/statistics/trace_writer.h"

#include <cerrno>
#include <charconv>
#include <cstring>
#include <span>

#include "common/base/user_error.h"
#include "common/files/require_file.h"

namespace bonemill {
namespace {

std::string headerOf(const std::vector<TickColumn>& columns) {
    std::string header;
    for (const TickColumn& column : columns) header += std::string(column.trace_names) + ',';
    header.back() = '\n';
    return header;
}

std::vector<TickColumn> traceColumns(const RecordedEffects& recorded) {
    std::vector<TickColumn> columns = tickColumns(recorded);
    std::erase_if(columns, [](const TickColumn& column) { return !column.trace_names; });
    return columns;
}

template <class Number>
void append(std::string& line, Number value) {
    char text[32];  // the longest shortest double has 24 characters
    const auto end = std::to_chars(text, text + sizeof(text), value).ptr;
    line.append(text, end).push_back(',');
}

void append(std::string& line, std::span<const double> values) {
    for (const double value : values) append(line, value);
}

std::FILE* openForWriting(const std::string& path) {
    requireNoPipe(path);
    return std::fopen(path.c_str(), "w");
}

}  // namespace

TraceWriter::TraceWriter(const std::string& path, const RecordedEffects& recorded)
    : columns_(traceColumns(recorded)), file_(openForWriting(path)) {
    if (!file_) {
        throw UserError("trace " + path + " cannot be written (" + std::strerror(errno) +
                        "): does its folder exist, and may you write there?");
    }
    is_good_ = std::fputs(headerOf(columns_).c_str(), file_.get()) >= 0;
}

bool TraceWriter::write(const TickRecord& record) {
    if (!is_good_ || !file_) return false;
    line_.clear();
    for (const TickColumn& column : columns_)
        std::visit([&](const auto& value) { append(line_, value); }, column.in(record));
    line_.back() = '\n';
    is_good_ = std::fwrite(line_.data(), 1, line_.size(), file_.get()) == line_.size();
    return is_good_;
}

bool TraceWriter::close() {
    if (!file_) return is_good_;
    is_good_ = std::fclose(file_.release()) == 0 && is_good_;
    return is_good_;
}

}  // namespace bonemill
