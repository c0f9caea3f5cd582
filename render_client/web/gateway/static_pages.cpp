#include "render_client/web/gateway/static_pages.h"

#include <libwebsockets.h>

#include <algorithm>
#include <array>
#include <cstring>
#include <fstream>
#include <sstream>
#include <utility>
#include <vector>

#include "common/base/user_error.h"

namespace bonemill::gateway {
namespace {

constexpr int kMaxPath = 256;
constexpr size_t kAnswerHeaderBytes = 2048;
constexpr size_t kAnswerPieceBytes = 16 << 10;
constexpr int kPieceSeconds = 10;  // a reader that takes no piece within this is gone

const StaticFile kNotThere{"not found\n", "", "text/plain; charset=utf-8", false};
const StaticFile kNotAllowed{"only GET\n", "", "text/plain; charset=utf-8", false};

bool takesGzip(lws* connection) {
    std::array<char, 256> value{};
    return lws_hdr_copy(connection, value.data(), int(value.size()), WSI_TOKEN_HTTP_ACCEPT_ENCODING) > 0 &&
           std::strstr(value.data(), "gzip") != nullptr;
}

// Nobody here reads it, and it may never end.
bool hasBody(lws* connection) {
    return lws_hdr_total_length(connection, WSI_TOKEN_HTTP_CONTENT_LENGTH) > 0 ||
           lws_hdr_total_length(connection, WSI_TOKEN_HTTP_TRANSFER_ENCODING) > 0;
}

class Headers {
  public:
    Headers(lws* connection, int status, const char* type, size_t length)
        : connection_(connection), at_(bytes_.data() + LWS_PRE), end_(bytes_.data() + bytes_.size()) {
        is_good_ = lws_add_http_common_headers(connection, unsigned(status), type, length, &at_, end_) == 0;
    }
    void add(const char* name, const char* value) {
        is_good_ =
            is_good_ && lws_add_http_header_by_name(connection_, reinterpret_cast<const unsigned char*>(name),
                                                    reinterpret_cast<const unsigned char*>(value),
                                                    int(std::strlen(value)), &at_, end_) == 0;
    }
    bool write() {
        return is_good_ &&
               lws_finalize_write_http_header(connection_, bytes_.data() + LWS_PRE, &at_, end_) == 0;
    }

  private:
    lws* connection_;
    std::array<unsigned char, LWS_PRE + kAnswerHeaderBytes> bytes_{};
    unsigned char* at_;
    unsigned char* end_;
    bool is_good_ = false;
};

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

int beginAnswer(lws* connection, const StaticPages& pages, HttpAnswer& answer) {
    std::array<char, kMaxPath> path{};
    const int length = lws_hdr_copy(connection, path.data(), int(path.size()), WSI_TOKEN_GET_URI);
    const StaticFile* found = length > 0 ? pages.find(path.data()) : nullptr;
    const bool is_get = lws_hdr_total_length(connection, WSI_TOKEN_GET_URI) > 0;
    const StaticFile& file = found ? *found : is_get ? kNotThere : kNotAllowed;
    const bool is_packed = !file.gzip.empty() && takesGzip(connection);
    answer = {is_packed ? &file.gzip : &file.bytes, 0, hasBody(connection)};
    Headers headers(connection, found ? 200 : is_get ? 404 : 405, file.type, answer.bytes->size());
    headers.add("content-security-policy:", kContentPolicy);
    headers.add("x-content-type-options:", "nosniff");
    headers.add("referrer-policy:", "no-referrer");
    headers.add("cross-origin-opener-policy:", "same-origin");
    headers.add("cross-origin-resource-policy:", "same-origin");
    headers.add("cache-control:", file.is_index ? "no-store" : "no-cache");
    headers.add("vary:", "accept-encoding");
    if (is_packed) headers.add("content-encoding:", "gzip");
    if (answer.ends_connection) headers.add("connection:", "close");
    if (!headers.write()) return -1;
    lws_callback_on_writable(connection);
    return 0;
}

int continueAnswer(lws* connection, HttpAnswer& answer) {
    if (!answer.bytes) return 0;
    const size_t left = answer.bytes->size() - answer.sent;
    const size_t length = std::min(left, kAnswerPieceBytes);
    std::vector<unsigned char> piece(LWS_PRE + length);
    std::memcpy(piece.data() + LWS_PRE, answer.bytes->data() + answer.sent, length);
    const bool is_last = length == left;
    lws_set_timeout(connection, PENDING_TIMEOUT_HTTP_CONTENT, kPieceSeconds);
    if (lws_write(connection, piece.data() + LWS_PRE, length,
                  is_last ? LWS_WRITE_HTTP_FINAL : LWS_WRITE_HTTP) < int(length))
        return -1;
    answer.sent += length;
    if (!is_last) return lws_callback_on_writable(connection) < 0 ? -1 : 0;
    const bool ends = std::exchange(answer, {}).ends_connection;
    return ends || lws_http_transaction_completed(connection) ? -1 : 0;
}

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
