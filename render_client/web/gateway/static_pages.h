// The page's files, in memory: what is not one of them is not there. Any thread after construction.
#pragma once

#include <cstddef>
#include <filesystem>
#include <map>
#include <string>

struct lws;

namespace bonemill::gateway {

struct StaticFile {
    std::string bytes;
    std::string gzip;  // the same, compressed; empty: there is none
    const char* type = "";
    bool is_index = false;
};

class StaticPages {
  public:
    static constexpr size_t kMaxFiles = 256, kMaxBytes = 64 << 20;

    // Reads a folder; one that is not there leaves a page that says so. Throws UserError where it is too
    // large.
    explicit StaticPages(const std::filesystem::path& folder);
    // `path` is that of an address: "/", "/main.js". Returns nothing for what is not there.
    const StaticFile* find(const std::string& path) const;
    bool isBuilt() const noexcept { return is_built_; }

  private:
    std::map<std::string, StaticFile> files_;  // by path
    bool is_built_ = false;
};

// Every answer has this.
inline constexpr const char* kContentPolicy =
    "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; connect-src 'self'; "
    "img-src 'self' data: blob:; font-src 'self'; media-src 'self' blob:; worker-src 'self' blob:; "
    "manifest-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

// Answers one request over HTTP with a file of the page. For the thread of libwebsockets.
//
// It lies in the connection's own memory, which libwebsockets sets to zero.
struct HttpAnswer {
    const std::string* bytes;  // what is left of it begins at `sent`
    size_t sent;
    bool ends_connection;
};

// Both return what the callback returns: other than 0 ends the connection.
int beginAnswer(lws* connection, const StaticPages& pages, HttpAnswer& answer);
int continueAnswer(lws* connection, HttpAnswer& answer);

}  // namespace bonemill::gateway
