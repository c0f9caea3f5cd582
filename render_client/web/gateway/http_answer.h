// Answers one request over HTTP with a file of the page. For the thread of libwebsockets.
#pragma once

#include <libwebsockets.h>

#include "render_client/web/gateway/static_pages.h"

namespace bonemill::gateway {

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
