#pragma once

#include <atomic>
#include <string>
#include <string_view>
#include <thread>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace relevo::test {

/// A server on this machine that has nothing, and counts who asks.
class CountingServer {
  public:
    CountingServer() : socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
        sockaddr_in at{};
        at.sin_family = AF_INET;
        at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
        socklen_t size = sizeof at;
        if (bind(socket_, reinterpret_cast<sockaddr*>(&at), size) != 0 ||
            listen(socket_, 16) != 0 ||
            getsockname(socket_, reinterpret_cast<sockaddr*>(&at), &size) != 0)
            return;
        port_ = ntohs(at.sin_port);
        thread_ = std::thread([this] { serve(); });
    }
    ~CountingServer() {
        stop_ = true;
        if (thread_.joinable()) thread_.join();
        close(socket_);
    }
    CountingServer(const CountingServer&) = delete;
    CountingServer& operator=(const CountingServer&) = delete;

    std::string address() const { return fmt::format("http://127.0.0.1:{}", port_); }
    int asked() const { return asked_; }

  private:
    void serve() {
        while (!stop_) {
            pollfd ready{socket_, POLLIN, 0};
            if (poll(&ready, 1, 20) <= 0) continue;
            const int client = accept4(socket_, nullptr, nullptr, SOCK_CLOEXEC);
            if (client < 0) continue;
            ++asked_;
            const timeval patience{1, 0};
            setsockopt(client, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
            char request[4096];
            if (read(client, request, sizeof request) > 0) {
                constexpr std::string_view kNothing =
                    "HTTP/1.0 404 Not Found\r\nContent-Length: 0\r\n\r\n";
                [[maybe_unused]] const auto written =
                    write(client, kNothing.data(), kNothing.size());
            }
            close(client);
        }
    }

    int socket_;
    int port_ = 0;
    std::atomic<bool> stop_ = false;
    std::atomic<int> asked_ = 0;
    std::thread thread_;
};

}  // namespace relevo::test
