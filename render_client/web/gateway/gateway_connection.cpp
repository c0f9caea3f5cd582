#include "render_client/web/gateway/gateway_connection.h"

#include <boost/asio/buffer.hpp>
#include <boost/beast/http/error.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/write.hpp>
#include <boost/beast/websocket/ssl.hpp>
#include <utility>

namespace bonemill::gateway {
namespace {

namespace net = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;

constexpr std::chrono::seconds kNobodyThere{40};  // a guest is asked after half of it
constexpr char kNoSense[] = "This message makes no sense to the gateway; reload the page.";

// Nobody here reads it, and it may never end.
bool hasBody(const PageRequest& request) {
    return request.count(http::field::content_length) > 0 ||
           request.count(http::field::transfer_encoding) > 0;
}

}  // namespace

// Results of what was begun are nobody's once the connection has ended.
template <class... Results>
auto GatewayConnection::then(void (GatewayConnection::*next)(Results...)) {
    return [self = shared_from_this(), next](Results... results) {
        if (!self->hasEnded()) (self.get()->*next)(results...);
    };
}

GatewayConnection::GatewayConnection(net::ip::tcp::socket line, GuestOrigin origin, Lobby& lobby)
    : socket_(beast::tcp_stream(std::move(line)), lobby.tls), origin_(std::move(origin)), lobby_(lobby) {}

void GatewayConnection::enter(Stage stage, std::chrono::seconds at_most) {
    stage_ = stage;
    until_ = Clock::now() + at_most;
}

void GatewayConnection::start() {
    enter(Stage::kGreeting, kRequestTime);
    socket_.next_layer().async_handshake(net::ssl::stream_base::server, then(&GatewayConnection::greeted));
}

void GatewayConnection::greeted(Error error) {
    error ? waitForEnd(error) : ask();
}

void GatewayConnection::ask() {
    enter(Stage::kAsking, kRequestTime);
    request_.emplace();
    request_->header_limit(kMaxHeaderBytes);
    http::async_read_header(socket_.next_layer(), asked_, *request_, then(&GatewayConnection::asked));
}

void GatewayConnection::asked(Error error, size_t) {
    if (error == http::error::end_of_stream) return bidFarewell();
    if (error && error.category() != make_error_code(http::error::bad_method).category())
        return waitForEnd(error);
    if (error) return answer(badRequest(), false);
    Decision decision = decide(request_->get(), lobby_.page);
    if (!decision.complaint.empty()) lobby_.gateway.noteComplaint(origin_, decision.complaint);
    if (!decision.opens_session) {
        decision.answer.version(request_->get().version());
        return answer(std::move(decision.answer), request_->get().keep_alive() && !hasBody(request_->get()));
    }
    // A guest waits for the answer before he says anything.
    asked_.size() > 0 ? answer(badRequest(), false) : open();
}

void GatewayConnection::answer(PageAnswer answer, bool goes_on) {
    goes_on_ = goes_on;
    answer.keep_alive(goes_on);
    answer_.emplace(std::move(answer));
    writer_.emplace(*answer_);
    writeAnswer();
}

void GatewayConnection::writeAnswer() {
    enter(Stage::kAnswering, kPieceTime);
    http::async_write_some(socket_.next_layer(), *writer_, then(&GatewayConnection::answered));
}

void GatewayConnection::answered(Error error, size_t) {
    if (error) return waitForEnd(error);
    if (!writer_->is_done()) return writeAnswer();
    goes_on_ ? ask() : bidFarewell();
}

void GatewayConnection::open() {
    enter(Stage::kOpening, kRequestTime);
    using Options = beast::websocket::stream_base;
    socket_.set_option(Options::timeout{Options::none(), kNobodyThere, true});
    socket_.set_option(Options::decorator([](beast::websocket::response_type& response) {
        response.set(http::field::server, "bonemill");
        response.set(http::field::sec_websocket_protocol, kSubprotocol);
    }));
    socket_.read_message_max(0);  // take() counts
    socket_.auto_fragment(false);
    socket_.binary(true);
    socket_.async_accept(request_->get(), then(&GatewayConnection::opened));
}

void GatewayConnection::opened(Error error) {
    if (error) return bidFarewell();
    request_.reset();
    guest_ = lobby_.gateway.come(origin_, Clock::now());
    if (!guest_) return end();
    stage_ = Stage::kOpen;
    until_ = Clock::time_point::max();
    hear();
}

void GatewayConnection::hear() {
    socket_.async_read_some(net::buffer(piece_), then(&GatewayConnection::heard));
}

void GatewayConnection::heard(Error error, size_t bytes) {
    if (stage_ != Stage::kOpen) return;  // what closes reads for itself
    if (error) return waitForEnd(error);
    const auto now = Clock::now();
    take(bytes, now);
    say(now);
    if (stage_ == Stage::kOpen) hear();
}

void GatewayConnection::take(size_t bytes, Clock::time_point now) {
    const size_t most = guest_->isAdmitted() ? kMaxFrameBytes : kMaxHelloBytes;
    if (frame_.size() + bytes > most || !socket_.got_binary()) {
        frame_.clear();
        return guest_->refuse(kNoSense, false);
    }
    frame_.append(piece_.data(), bytes);
    if (!socket_.is_message_done()) return;
    lobby_.gateway.receive(*guest_, frame_, now);
    frame_.clear();
}

void GatewayConnection::say(Clock::time_point now) {
    if (stage_ != Stage::kOpen || is_saying_) return;
    saying_ = guest_->nextFrame(now);
    if (saying_.empty()) {
        if (guest_->shouldClose(now)) close();
        return;
    }
    is_saying_ = true;
    socket_.async_write(net::buffer(saying_), then(&GatewayConnection::said));
}

void GatewayConnection::said(Error error, size_t) {
    is_saying_ = false;
    if (stage_ != Stage::kOpen) return;
    error ? waitForEnd(error) : say(Clock::now());
}

void GatewayConnection::close() {
    letGuestGo();
    enter(Stage::kClosing, kFarewellTime);
    socket_.async_close(beast::websocket::close_code::policy_error, then(&GatewayConnection::waitForEnd));
}

// Nothing else may be under way.
void GatewayConnection::bidFarewell() {
    enter(Stage::kFarewell, kFarewellTime);
    socket_.next_layer().async_shutdown(then(&GatewayConnection::waitForEnd));
}

void GatewayConnection::waitForEnd(Error) {
    letGuestGo();
    enter(Stage::kFarewell, kFarewellTime);
    Error unused;
    beast::get_lowest_layer(socket_).socket().shutdown(net::ip::tcp::socket::shutdown_send, unused);
    drop({}, 0);
}

void GatewayConnection::drop(Error error, size_t) {
    if (error) return end();
    beast::get_lowest_layer(socket_).socket().async_read_some(net::buffer(piece_),
                                                              then(&GatewayConnection::drop));
}

void GatewayConnection::letGuestGo() {
    if (guest_) lobby_.gateway.leave(std::exchange(guest_, nullptr));
}

void GatewayConnection::step(Clock::time_point now) {
    if (hasEnded()) return;
    if (guest_ && guest_->shouldClose(now) && is_saying_ && until_ == Clock::time_point::max())
        until_ = now + kLastWordsTime;
    if (now > until_) return end();
    say(now);
}

void GatewayConnection::end() {
    if (hasEnded()) return;
    letGuestGo();
    stage_ = Stage::kEnded;
    Error unused;
    beast::get_lowest_layer(socket_).socket().close(unused);
}

}  // namespace bonemill::gateway
