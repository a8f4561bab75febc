// The web server of the monitor. On the thread that runs its io_context:
//
//     GET /          the page
//     GET /events    server-sent events: what has been (Board::past), `now`, then each event as it comes
//     GET /heat?array=ID&by=load    the heat map of an array likewise, while the connection lasts;
//                    ID: in hexadecimal, as frames name it; by: load, or pe
//     GET /report    asks what waits; the answer comes as an event
//
// A browser that reads more slowly than events come misses frames, and never holds anything up:
// one event is under way to it at a time, and what comes meanwhile is kept only up to a limit.
// With a token every request must bring it (?token=…); without one the server answers only requests
// for this machine by name, so that no page of the web can read it through a browser here.
#pragma once

#include "runtime/pe/interfaces/runtime_options.hpp"
#include "runtime/watch/monitor/board.hpp"

#include <boost/asio/io_context.hpp>
#include <boost/asio/ip/tcp.hpp>
#include <boost/asio/steady_timer.hpp>

#include <cstdint>
#include <functional>
#include <memory>
#include <string>
#include <utility>
#include <vector>

namespace tess::detail {

/// A connection to a browser (server.cpp).
class Connection;

class Server {
 public:
  /// What the server asks of the monitor.
  struct Source {
    std::function<std::vector<Event>(const Topic&)> past;
    std::function<void()> ask_report;
  };

  /// Listens. Throws Error if the address or port cannot be had.
  Server(boost::asio::io_context& io, const MonitorOptions& options, Source source);

  [[nodiscard]] std::uint16_t port() const { return acceptor_.local_endpoint().port(); }
  /// Sends events to all browsers that listen to their topics.
  void publish(const std::vector<Event>& events);
  /// True if any browser listens to what all hear.
  [[nodiscard]] bool has_listeners() const;
  /// The heat maps that browsers watch.
  [[nodiscard]] std::vector<HeatMapId> watched() const;

  // For its connections.
  /// False if as many browsers listen as the server takes.
  [[nodiscard]] bool has_room();
  [[nodiscard]] const Source& source() const { return source_; }
  [[nodiscard]] const std::string& token() const { return token_; }
  void listens(const Topic& topic, std::weak_ptr<Connection> listener) {
    listeners_.emplace_back(topic, std::move(listener));
  }

 private:
  void accept();
  void accept_later();
  void forget_gone();

  const std::string token_;
  const Source source_;
  boost::asio::ip::tcp::acceptor acceptor_;
  boost::asio::steady_timer retry_;
  std::vector<std::pair<Topic, std::weak_ptr<Connection>>> listeners_;
};

/// An event as it stands in the stream.
[[nodiscard]] std::string as_text(const Event& event);

}  // namespace tess::detail
