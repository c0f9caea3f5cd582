// One connection to the gateway's port, from its TLS handshake to its end: files of the page, or a guest's
// WebSocket.
//
// Whoever breaks a protocol is told so where possible; then what he still sends is read and dropped until he
// closes, too, for a bounded time: a socket that is closed before that resets the line, and what was said
// last would be lost. Every stage has its end in time. For the thread of the io_context.
#pragma once

#include <array>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/ssl/context.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/serializer.hpp>
#include <boost/beast/ssl/ssl_stream.hpp>
#include <boost/beast/websocket/stream.hpp>
#include <chrono>
#include <cstddef>
#include <memory>
#include <optional>
#include <string>

#include "render_client/web/gateway/gateway.h"
#include "render_client/web/gateway/page_answers.h"

namespace bonemill::gateway {

// What all connections share. It outlives them.
struct Lobby {
    Gateway& gateway;
    boost::asio::ssl::context& tls;
    PageHost page;
};

class GatewayConnection : public std::enable_shared_from_this<GatewayConnection> {
  public:
    using Clock = std::chrono::steady_clock;
    static constexpr std::chrono::seconds kRequestTime{5};    // to shake hands and ask
    static constexpr std::chrono::seconds kPieceTime{10};     // to take 16 KiB of an answer
    static constexpr std::chrono::seconds kLastWordsTime{5};  // to take what is said to one who must go
    static constexpr std::chrono::seconds kFarewellTime{2};   // to close, too
    static constexpr size_t kMaxHeaderBytes = 4096;

    GatewayConnection(boost::asio::ip::tcp::socket line, GuestOrigin origin, Lobby& lobby);

    void start();
    // Says what is due, and ends who is late: often.
    void step(Clock::time_point now);
    // At once and unsaid.
    void end();
    bool hasEnded() const noexcept { return stage_ == Stage::kEnded; }
    bool isGuests() const noexcept { return guest_ != nullptr; }
    const GuestOrigin& origin() const noexcept { return origin_; }

  private:
    using Error = boost::system::error_code;
    using Line = boost::beast::ssl_stream<boost::beast::tcp_stream>;
    using RequestParser = boost::beast::http::request_parser<boost::beast::http::empty_body>;
    using AnswerWriter = boost::beast::http::response_serializer<PageAnswer::body_type>;
    enum class Stage { kGreeting, kAsking, kAnswering, kOpening, kOpen, kClosing, kFarewell, kEnded };

    template <class... Results>
    auto then(void (GatewayConnection::*next)(Results...));
    void enter(Stage stage, std::chrono::seconds at_most);
    void greeted(Error error);
    void ask();
    void asked(Error error, size_t bytes);
    void answer(PageAnswer answer, bool goes_on);
    void writeAnswer();
    void answered(Error error, size_t bytes);
    void open();
    void opened(Error error);
    void hear();
    void heard(Error error, size_t bytes);
    void take(size_t bytes, Clock::time_point now);
    void say(Clock::time_point now);
    void said(Error error, size_t bytes);
    void close();
    void bidFarewell();
    void waitForEnd(Error error);
    void drop(Error error, size_t bytes);
    void letGuestGo();

    boost::beast::websocket::stream<Line, false> socket_;
    const GuestOrigin origin_;
    Lobby& lobby_;
    Stage stage_ = Stage::kGreeting;
    Clock::time_point until_;
    boost::beast::flat_buffer asked_{2 * kMaxHeaderBytes};
    std::optional<RequestParser> request_;
    std::optional<PageAnswer> answer_;
    std::optional<AnswerWriter> writer_;
    bool goes_on_ = false;  // behind the answer
    Guest* guest_ = nullptr;
    std::array<char, 4096> piece_;
    std::string frame_;   // as much of the guest's as has come
    std::string saying_;  // the frame that is being sent
    bool is_saying_ = false;
};

}  // namespace bonemill::gateway
