#include "render_client/web/gateway/page_answers.h"

#include <boost/beast/http/field.hpp>
#include <boost/beast/http/rfc7230.hpp>
#include <boost/beast/websocket/rfc6455.hpp>
#include <string_view>
#include <utility>

#include "common/text/foreign_text.h"

namespace bonemill::gateway {
namespace {

namespace http = boost::beast::http;
using http::field;
using http::status;

constexpr std::string_view kSessionPath = "/session", kWebSocketVersion = "13", kAllowed = "GET, HEAD";
constexpr char kPlainText[] = "text/plain; charset=utf-8";

std::string_view valueOf(const PageRequest& request, field name) {
    const auto value = request[name];
    return {value.data(), value.size()};
}

PageAnswer answerOf(status code, std::string_view body, const char* type) {
    PageAnswer answer(code, 11);
    answer.body() = {body.data(), body.size()};
    answer.set(field::server, "bonemill");
    answer.set("content-type", type);
    answer.set("content-security-policy", kContentPolicy);
    answer.set("x-content-type-options", "nosniff");
    answer.set("referrer-policy", "no-referrer");
    answer.set("cross-origin-opener-policy", "same-origin");
    answer.set("cross-origin-resource-policy", "same-origin");
    answer.set("cache-control", "no-cache");
    answer.set("vary", "accept-encoding");
    answer.content_length(body.size());
    return answer;
}

PageAnswer wordsOf(status code, std::string_view words) {
    return answerOf(code, words, kPlainText);
}

bool takesGzip(const PageRequest& request) {
    return http::ext_list(request[field::accept_encoding]).exists("gzip");
}

PageAnswer fileOf(const StaticFile& file, const PageRequest& request) {
    const bool is_packed = !file.gzip.empty() && takesGzip(request);
    PageAnswer answer = answerOf(status::ok, is_packed ? file.gzip : file.bytes, file.type);
    if (is_packed) answer.set("content-encoding", "gzip");
    if (file.is_index) answer.set("cache-control", "no-store");
    return answer;
}

// A page of elsewhere must not speak through the user's browser. What is no browser names no origin.
bool isOurOwnPage(const PageRequest& request) {
    const std::string_view origin = valueOf(request, field::origin);
    return origin.empty() || isSameOrigin(origin, valueOf(request, field::host));
}

Decision sessionFor(const PageRequest& request) {
    if (valueOf(request, field::sec_websocket_version) != kWebSocketVersion) {
        PageAnswer answer = wordsOf(status::upgrade_required, "only version 13 of WebSockets\n");
        answer.set(field::sec_websocket_version, "13");
        answer.set(field::upgrade, "websocket");
        return {false, std::move(answer)};
    }
    if (!isOurOwnPage(request))
        return {false, wordsOf(status::forbidden, "only for this gateway's own page\n"),
                "a page of " + printableLine(std::string(valueOf(request, field::origin)), 100) +
                    " asked for the session; only the gateway's own may"};
    if (!http::token_list(request[field::sec_websocket_protocol]).exists(kSubprotocol))
        return {false, wordsOf(status::bad_request, "only the subprotocol bonemill.v1\n")};
    return {true, {}};
}

Decision pageFor(const PageRequest& request, const PageHost& host) {
    if (request.method() != http::verb::get && request.method() != http::verb::head) {
        PageAnswer answer = wordsOf(status::method_not_allowed, "only GET and HEAD\n");
        answer.set(field::allow, {kAllowed.data(), kAllowed.size()});
        return {false, std::move(answer)};
    }
    const std::string_view whole(request.target().data(), request.target().size());
    const std::string path(whole.substr(0, whole.find('?')));
    if (boost::beast::websocket::is_upgrade(request) && path == kSessionPath) return sessionFor(request);
    const StaticFile* const file = host.pages.find(path);
    return {false, file ? fileOf(*file, request) : wordsOf(status::not_found, "not found\n")};
}

}  // namespace

Decision decide(const PageRequest& request, const PageHost& host) {
    const std::string_view name = valueOf(request, field::host);
    Decision decision;
    if (name.empty() && request.version() >= 11)
        decision.answer = badRequest();
    else if (!name.empty() && !host.names.isOwn(name))
        decision.answer = wordsOf(status::misdirected_request, "this gateway has another name\n");
    else
        decision = pageFor(request, host);
    if (host.has_strict_transport) decision.answer.set("strict-transport-security", "max-age=31536000");
    if (request.method() == http::verb::head) decision.answer.body() = {};
    return decision;
}

PageAnswer badRequest() {
    return wordsOf(status::bad_request, "this is no request\n");
}

}  // namespace bonemill::gateway
