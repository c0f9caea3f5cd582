// What the port answers to one request over HTTP: a file of the page, a session, or why not. Any thread.
#pragma once

#include <boost/beast/http/empty_body.hpp>
#include <boost/beast/http/message.hpp>
#include <boost/beast/http/span_body.hpp>
#include <string>

#include "render_client/web/gateway/host_names.h"
#include "render_client/web/gateway/static_pages.h"

namespace bonemill::gateway {

using PageRequest = boost::beast::http::request<boost::beast::http::empty_body>;
using PageAnswer = boost::beast::http::response<boost::beast::http::span_body<const char>>;

inline constexpr char kSubprotocol[] = "bonemill.v1";

// Every answer has this.
inline constexpr const char* kContentPolicy =
    "default-src 'none'; script-src 'self' 'wasm-unsafe-eval'; style-src 'self'; connect-src 'self'; "
    "img-src 'self' data: blob:; font-src 'self'; media-src 'self' blob:; worker-src 'self' blob:; "
    "manifest-src 'self'; base-uri 'none'; form-action 'none'; frame-ancestors 'none'";

// Where the port is.
struct PageHost {
    const StaticPages& pages;
    const HostNames& names;
    bool has_strict_transport = false;  // browsers are told to come by HTTPS only
};

struct Decision {
    bool opens_session = false;
    PageAnswer answer;        // otherwise; its body lives as long as the pages do
    std::string complaint{};  // for the log; empty: none
};

Decision decide(const PageRequest& request, const PageHost& host);
// The answer to what is no request.
PageAnswer badRequest();

}  // namespace bonemill::gateway
