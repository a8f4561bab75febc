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

/// A browser that listens to the events.
class Listener {
 public:
  Listener() = default;
  Listener(const Listener&) = delete;
  Listener& operator=(const Listener&) = delete;
  virtual ~Listener() = default;
  virtual void send(const std::shared_ptr<const std::string>& event) = 0;
};

class Server {
 public:
  /// What the server asks of the monitor.
  struct Source {
    std::function<std::vector<Event>()> past;
    std::function<std::vector<Event>(const HeatMapId&)> past_heat;
    std::function<void()> ask_report;
  };

  /// Listens. Throws Error if the address or port cannot be had.
  Server(boost::asio::io_context& io, const MonitorOptions& options, Source source);

  [[nodiscard]] std::uint16_t port() const { return acceptor_.local_endpoint().port(); }
  /// Sends events to all browsers that listen to them.
  void publish(const std::vector<Event>& events);
  /// Sends the event of a heat map to the browsers that watch it.
  void publish(const HeatMapId& id, const Event& event);
  /// True if any browser listens to the events.
  [[nodiscard]] bool has_listeners() const;
  /// The heat maps that browsers watch.
  [[nodiscard]] std::vector<HeatMapId> watched() const;

  // For its connections.
  /// False if as many browsers listen as the server takes.
  [[nodiscard]] bool has_room();
  [[nodiscard]] const Source& source() const { return source_; }
  [[nodiscard]] const std::string& token() const { return token_; }
  void listens(std::weak_ptr<Listener> listener) { to_all_.push_back(std::move(listener)); }
  void watches(const HeatMapId& id, std::weak_ptr<Listener> listener) {
    to_heat_.emplace_back(id, std::move(listener));
  }

 private:
  void accept();
  void accept_later();
  void forget_gone();

  const std::string token_;
  const Source source_;
  boost::asio::ip::tcp::acceptor acceptor_;
  boost::asio::steady_timer retry_;
  std::vector<std::weak_ptr<Listener>> to_all_;
  std::vector<std::pair<HeatMapId, std::weak_ptr<Listener>>> to_heat_;
};

/// An event as it stands in the stream.
[[nodiscard]] std::string as_text(const Event& event);

}  // namespace tess::detail
