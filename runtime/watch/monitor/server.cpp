#include "runtime/watch/monitor/server.hpp"

#include "runtime/core/error.hpp"
#include "runtime/core/number.hpp"
#include "runtime/core/text.hpp"
#include "runtime/watch/monitor/page.hpp"

#include <boost/asio/ip/address.hpp>
#include <boost/asio/write.hpp>
#include <boost/beast/core/flat_buffer.hpp>
#include <boost/beast/core/tcp_stream.hpp>
#include <boost/beast/http/parser.hpp>
#include <boost/beast/http/read.hpp>
#include <boost/beast/http/string_body.hpp>
#include <boost/beast/http/write.hpp>

#include <algorithm>
#include <array>
#include <chrono>
#include <deque>
#include <map>
#include <string_view>
#include <utility>

namespace tess::detail {
namespace {

namespace asio = boost::asio;
namespace beast = boost::beast;
namespace http = boost::beast::http;
using Tcp = asio::ip::tcp;

constexpr std::size_t most_waiting = 8;           // events for one browser that reads slowly
constexpr std::uint64_t most_request = 16 << 10;  // bytes
constexpr std::size_t most_listeners = 64;

/// "path?token=T&array=7".
struct Target {
  std::string path;
  std::map<std::string, std::string, std::less<>> values;

  [[nodiscard]] std::string value(std::string_view key) const {
    const auto at = values.find(key);
    return at != values.end() ? at->second : std::string();
  }
};
Target target_of(std::string_view given) {
  const std::size_t mark = std::min(given.find('?'), given.size());
  Target target{std::string(given.substr(0, mark)), {}};
  for (std::size_t at = mark; at < given.size();) {
    const std::size_t next = std::min(given.find('&', at + 1), given.size());
    const std::string_view part = given.substr(at + 1, next - at - 1);
    const std::size_t equals = std::min(part.find('='), part.size());
    target.values.emplace(part.substr(0, equals), part.substr(std::min(equals + 1, part.size())));
    at = next;
  }
  return target;
}
/// The heat map that is asked for.
std::optional<HeatMapId> heat_of(const Target& target) {
  const std::string array = target.value("array"), by = target.value("by");
  HeatMapId id;
  const auto number = parse_number<decltype(id.array.value)>(array, 16);
  if (!number || (by != "load" && by != "pe")) return std::nullopt;
  id.array.value = *number;
  id.by = by == "load" ? HeatBy::load : HeatBy::pe;
  return id;
}

/// Compares all characters, so that the time tells nothing of where they differ.
bool same(const std::string& a, const std::string& b) {
  if (a.size() != b.size()) return false;
  unsigned differs = 0;
  for (std::size_t i = 0; i < a.size(); ++i)
    differs |= static_cast<unsigned>(a[i]) ^ static_cast<unsigned>(b[i]);
  return differs == 0;
}

bool names_this_machine(std::string_view host) {
  if (const std::size_t colon = host.rfind(':');
      colon != std::string_view::npos && host.find(']', colon) == std::string_view::npos)
    host = host.substr(0, colon);
  if (host.starts_with('[') && host.ends_with(']')) host = host.substr(1, host.size() - 2);
  boost::system::error_code no_address;
  const auto address = asio::ip::make_address(host, no_address);
  return host == "localhost" || (!no_address && address.is_loopback());
}

}  // namespace

/// A connection: one request and its answer, or a browser that listens. It lives while an operation
/// holds it.
class Connection final : public std::enable_shared_from_this<Connection> {
 public:
  Connection(Server& server, Tcp::socket socket) : server_(server), stream_(std::move(socket)) {
    parser_.body_limit(most_request);
    parser_.header_limit(most_request);
  }

  void read() {
    stream_.expires_after(std::chrono::seconds(10));
    http::async_read(stream_, buffer_, parser_,
                     [self = shared_from_this()](beast::error_code error, std::size_t) {
                       if (!error) self->answer();
                     });
  }

  void send(const std::shared_ptr<const std::string>& event) {
    if (waiting_.size() >= most_waiting) return;  // it reads slowly: this one it misses
    waiting_.push_back(event);
    if (waiting_.size() == 1) write_next();
  }

 private:
  void answer() {
    const auto& request = parser_.get();
    const Target target =
        target_of(std::string_view(request.target().data(), request.target().size()));
    const auto host = request[http::field::host];
    if (request.method() != http::verb::get)
      return reply(http::status::method_not_allowed, "only GET\n");
    if (server_.token().empty() ? !names_this_machine(std::string_view(host.data(), host.size()))
                                : !same(target.value("token"), server_.token()))
      return reply(http::status::forbidden,
                   server_.token().empty()
                       ? "ask for localhost, or start the run with --monitor-token\n"
                       : "the token is missing or wrong: add ?token=…\n");
    if (target.path == "/")
      return reply(http::status::ok, monitor_page(), "text/html; charset=utf-8");
    if (target.path == "/report") {
      server_.source().ask_report();
      return reply(http::status::accepted, "the answer comes as an event\n");
    }
    if (target.path != "/heat" && target.path != "/events")
      return reply(http::status::not_found, "there are /, /events, /heat and /report\n");
    if (!server_.has_room())
      return reply(http::status::service_unavailable,
                   text(most_listeners, " browsers listen already: close one\n"));
    if (target.path == "/events") return stream(std::nullopt);
    const Topic heat = heat_of(target);
    if (!heat)
      return reply(http::status::bad_request,
                   "say /heat?array=ID&by=load or by=pe, with an ID that "
                   "frames name\n");
    const std::vector<HeatMapId> watched = server_.watched();
    if (watched.size() >= most_heat_maps &&
        std::find(watched.begin(), watched.end(), *heat) == watched.end())
      return reply(http::status::service_unavailable,
                   "other browsers watch as many heat maps as a run makes: close one\n");
    stream(heat);
  }

  void reply(http::status status, std::string body,
             const char* type = "text/plain; charset=utf-8") {
    auto response = std::make_shared<http::response<http::string_body>>(status, 11);
    response->set(http::field::content_type, type);
    response->set(http::field::cache_control, "no-store");
    response->set("Content-Security-Policy",
                  "default-src 'none'; script-src 'unsafe-inline'; style-src 'unsafe-inline'; "
                  "connect-src 'self'");
    response->keep_alive(false);
    response->body() = std::move(body);
    response->prepare_payload();
    http::async_write(stream_, *response,
                      [self = shared_from_this(), response](beast::error_code, std::size_t) {
                        beast::error_code ignored;
                        self->stream_.socket().shutdown(Tcp::socket::shutdown_send, ignored);
                      });
  }

  /// Answers with the events of a topic: those that have been, and those that are sent later.
  void stream(const Topic& topic) {
    std::vector<Event> past = server_.source().past(topic);
    if (!topic) past.push_back({"now", "{}"});
    server_.listens(topic, weak_from_this());
    stream_.expires_never();
    std::string all =
        "HTTP/1.1 200 OK\r\nContent-Type: text/event-stream\r\nCache-Control: no-store\r\n"
        "Connection: close\r\n\r\n";
    for (const Event& event : past) all += as_text(event);
    waiting_.push_back(std::make_shared<const std::string>(std::move(all)));
    write_next();
  }

  void write_next() {
    asio::async_write(stream_.socket(), asio::buffer(*waiting_.front()),
                      [self = shared_from_this()](beast::error_code error, std::size_t) {
                        if (error) return;
                        self->waiting_.pop_front();
                        if (!self->waiting_.empty()) {
                          self->write_next();
                        } else {
                          self->keep();
                        }
                      });
  }

  /// Between two events a read holds the connection, which ends when the browser leaves.
  void keep() {
    if (reads_) return;
    reads_ = true;
    stream_.socket().async_read_some(
        asio::buffer(ignored_), [self = shared_from_this()](beast::error_code error, std::size_t) {
          self->reads_ = false;
          if (!error) self->keep();
        });
  }

  Server& server_;
  beast::tcp_stream stream_;
  beast::flat_buffer buffer_;
  http::request_parser<http::string_body> parser_;
  std::deque<std::shared_ptr<const std::string>> waiting_;  // the first is under way
  bool reads_ = false;
  std::array<char, 64> ignored_{};
};

namespace {

/// Binds to an address of this machine.
Tcp::acceptor bound(asio::io_context& io, const MonitorOptions& options) {
  beast::error_code error;
  const auto address = asio::ip::make_address(options.address, error);
  if (!error && options.token.empty() && !address.is_loopback())
    fail(ErrorCode::bad_argument, "--monitor ", options.address, ":", options.port,
         ": other machines can reach this address: give a token that they must know");
  Tcp::acceptor acceptor(io);
  const Tcp::endpoint at(address, options.port);
  if (!error) acceptor.open(at.protocol(), error);
  if (!error) acceptor.set_option(asio::socket_base::reuse_address(true), error);
  if (!error) acceptor.bind(at, error);
  if (!error) acceptor.listen(asio::socket_base::max_listen_connections, error);
  if (error)
    fail(ErrorCode::environment, "--monitor ", options.address, ":", options.port, ": ",
         error.message(), "; choose another port, or 0 for any");
  return acceptor;
}

}  // namespace

std::string as_text(const Event& event) {
  return "event: " + event.kind + "\ndata: " + event.json + "\n\n";
}

Server::Server(asio::io_context& io, const MonitorOptions& options, Source source)
    : token_(options.token), source_(std::move(source)), acceptor_(bound(io, options)), retry_(io) {
  accept();
}

void Server::accept() {
  acceptor_.async_accept([this](beast::error_code error, Tcp::socket socket) {
    if (error == asio::error::operation_aborted) return;
    if (error) return accept_later();
    std::make_shared<Connection>(*this, std::move(socket))->read();
    accept();
  });
}

/// After an error that may last: no descriptor is free, for instance.
void Server::accept_later() {
  retry_.expires_after(std::chrono::milliseconds(100));
  retry_.async_wait([this](beast::error_code error) {
    if (!error) accept();
  });
}

void Server::forget_gone() {
  std::erase_if(listeners_, [](const auto& one) { return one.second.expired(); });
}

void Server::publish(const std::vector<Event>& events) {
  forget_gone();
  if (listeners_.empty()) return;
  std::map<Topic, std::shared_ptr<std::string>> texts;
  for (const Event& event : events) {
    auto& topic = texts[event.topic];
    if (!topic) topic = std::make_shared<std::string>();
    *topic += as_text(event);
  }
  for (const auto& [topic, listener] : listeners_) {
    const auto message = texts.find(topic);
    if (message == texts.end()) continue;
    if (const auto connection = listener.lock()) connection->send(message->second);
  }
}

bool Server::has_room() {
  forget_gone();
  return listeners_.size() < most_listeners;
}

bool Server::has_listeners() const {
  return std::any_of(listeners_.begin(), listeners_.end(),
                     [](const auto& one) { return !one.first && !one.second.expired(); });
}

std::vector<HeatMapId> Server::watched() const {
  std::vector<HeatMapId> ids;
  for (const auto& [topic, listener] : listeners_)
    if (topic && !listener.expired()) ids.push_back(*topic);
  std::sort(ids.begin(), ids.end());
  ids.erase(std::unique(ids.begin(), ids.end()), ids.end());
  return ids;
}

}  // namespace tess::detail
