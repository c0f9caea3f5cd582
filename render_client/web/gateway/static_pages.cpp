#include "render_client/web/gateway/static_pages.h"

#include <fstream>
#include <sstream>
#include <utility>

#include "common/base/user_error.h"

namespace bonemill::gateway {
namespace {

constexpr const char* kNotBuilt =
    "<!doctype html><html lang=\"en\"><meta charset=\"utf-8\"><title>bonemill</title>"
    "<p>The gateway is here, but its page was not built.</p></html>";

const char* typeOf(const std::filesystem::path& file) {
    static const std::map<std::string, const char*> kTypes = {
        {".html", "text/html; charset=utf-8"},
        {".js", "text/javascript; charset=utf-8"},
        {".css", "text/css; charset=utf-8"},
        {".json", "application/json"},
        {".map", "application/json"},
        {".webmanifest", "application/manifest+json"},
        {".wasm", "application/wasm"},
        {".svg", "image/svg+xml"},
        {".png", "image/png"},
        {".ico", "image/x-icon"},
        {".woff2", "font/woff2"},
        {".txt", "text/plain; charset=utf-8"},
    };
    const auto known = kTypes.find(file.extension().string());
    return known == kTypes.end() ? "application/octet-stream" : known->second;
}

std::string contentOf(const std::filesystem::path& file) {
    std::ifstream stream(file, std::ios::binary);
    std::ostringstream content;
    content << stream.rdbuf();
    return std::move(content).str();
}

}  // namespace

StaticPages::StaticPages(const std::filesystem::path& folder) {
    namespace fs = std::filesystem;
    std::error_code error;
    size_t bytes = 0;
    for (fs::recursive_directory_iterator at(folder, error), end; !error && at != end; at.increment(error)) {
        if (!at->is_regular_file(error)) continue;
        const bool is_packed = at->path().extension() == ".gz";
        fs::path file = at->path();
        if (is_packed) file.replace_extension();
        const std::string path = "/" + fs::relative(file, folder, error).generic_string();
        StaticFile& entry = files_[path];
        (is_packed ? entry.gzip : entry.bytes) = contentOf(at->path());
        entry.type = typeOf(file);
        bytes += entry.bytes.size() + entry.gzip.size();
        if (files_.size() > kMaxFiles || bytes > kMaxBytes)
            throw UserError("--page " + folder.string() + ": is too large for a page");
    }
    std::erase_if(files_, [](const auto& file) { return file.second.bytes.empty(); });
    is_built_ = files_.contains("/index.html");
    if (!is_built_) {
        files_.clear();
        files_["/index.html"] = {kNotBuilt, "", "text/html; charset=utf-8", false};
    }
    files_["/index.html"].is_index = true;
    files_["/"] = files_["/index.html"];
}

const StaticFile* StaticPages::find(const std::string& path) const {
    const auto file = files_.find(path);
    return file == files_.end() ? nullptr : &file->second;
}

}  // namespace bonemill::gateway
