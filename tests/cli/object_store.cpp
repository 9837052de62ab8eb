#include "object_store.h"

#include <algorithm>
#include <charconv>
#include <chrono>

#include <arpa/inet.h>
#include <fmt/format.h>
#include <netinet/in.h>
#include <poll.h>
#include <sys/socket.h>
#include <unistd.h>

namespace relevo::test {
namespace {

std::string response(int code, const std::string& body = {}, const std::string& headers = {}) {
    return fmt::format("HTTP/1.1 {} Status\r\nContent-Length: {}\r\nConnection: close\r\n{}\r\n{}",
                       code, body.size(), headers, body);
}

/// The number after a name: that of "partNumber=2" in a query.
int number_after(const std::string& text, const std::string& name, int otherwise) {
    const std::size_t at = text.find(name);
    int number = otherwise;
    if (at != std::string::npos)
        std::from_chars(text.data() + at + name.size(), text.data() + text.size(), number);
    return number;
}

/// Reads until the head is there, then as much as it says follows it.
ObjectStoreServer::Request read_request(int client) {
    std::string text;
    std::size_t head = std::string::npos, wanted = 0;
    char buffer[1 << 16];
    while (head == std::string::npos || text.size() < wanted) {
        const ssize_t count = read(client, buffer, sizeof buffer);
        if (count <= 0) return {};
        text.append(buffer, static_cast<std::size_t>(count));
        if (head != std::string::npos || (head = text.find("\r\n\r\n")) == std::string::npos)
            continue;
        std::string lower = text.substr(0, head);
        std::ranges::transform(lower, lower.begin(),
                               [](unsigned char c) { return std::tolower(c); });
        wanted = head + 4 + static_cast<std::size_t>(number_after(lower, "content-length: ", 0));
        if (lower.find("expect: 100-continue") != std::string::npos) {
            constexpr std::string_view kGoOn = "HTTP/1.1 100 Continue\r\n\r\n";
            [[maybe_unused]] const auto written = write(client, kGoOn.data(), kGoOn.size());
        }
    }
    ObjectStoreServer::Request request;
    const std::size_t blank = text.find(' '), end = text.find(' ', blank + 1);
    request.method = text.substr(0, blank);
    request.path = text.substr(blank + 1, end - blank - 1);
    if (const std::size_t mark = request.path.find('?'); mark != std::string::npos) {
        request.query = request.path.substr(mark + 1);
        request.path.resize(mark);
    }
    for (std::size_t line = text.find("\r\n") + 2; line < head;) {
        const std::size_t stop = text.find("\r\n", line), colon = text.find(": ", line);
        std::string name = text.substr(line, colon - line);
        std::ranges::transform(name, name.begin(), [](unsigned char c) { return std::tolower(c); });
        request.headers[name] = text.substr(colon + 2, stop - colon - 2);
        line = stop + 2;
    }
    request.body = text.substr(head + 4);
    return request;
}

}  // namespace

ObjectStoreServer::ObjectStoreServer(Faults faults)
    : faults_(std::move(faults)), socket_(::socket(AF_INET, SOCK_STREAM | SOCK_CLOEXEC, 0)) {
    sockaddr_in at{};
    at.sin_family = AF_INET;
    at.sin_addr.s_addr = htonl(INADDR_LOOPBACK);
    socklen_t size = sizeof at;
    if (bind(socket_, reinterpret_cast<sockaddr*>(&at), size) != 0 || listen(socket_, 64) != 0 ||
        getsockname(socket_, reinterpret_cast<sockaddr*>(&at), &size) != 0)
        return;
    port_ = ntohs(at.sin_port);
    thread_ = std::thread([this] { serve(); });
}

ObjectStoreServer::~ObjectStoreServer() {
    stop_ = true;
    if (thread_.joinable()) thread_.join();
    for (std::thread& client : clients_)
        client.join();
    close(socket_);
}

std::string ObjectStoreServer::address() const {
    return fmt::format("127.0.0.1:{}", port_);
}

std::vector<std::string> ObjectStoreServer::environment() const {
    return {"AWS_S3_ENDPOINT=" + address(), "AWS_HTTPS=NO",
            "AWS_VIRTUAL_HOSTING=FALSE",    "AWS_ACCESS_KEY_ID=tester",
            "AWS_SECRET_ACCESS_KEY=open",   "AWS_REGION=here",
            "GDAL_HTTP_RETRY_DELAY=0.05"};
}

void ObjectStoreServer::put(const std::string& path, std::string content) {
    const std::lock_guard lock(mutex_);
    objects_[path] = std::move(content);
}

std::map<std::string, std::string> ObjectStoreServer::objects() const {
    const std::lock_guard lock(mutex_);
    return objects_;
}

std::vector<ObjectStoreServer::Request> ObjectStoreServer::requests() const {
    const std::lock_guard lock(mutex_);
    return requests_;
}

ObjectStoreServer::Fault ObjectStoreServer::status(int code) {
    return {response(code)};
}

void ObjectStoreServer::serve() {
    while (!stop_) {
        pollfd ready{socket_, POLLIN, 0};
        if (poll(&ready, 1, 20) <= 0) continue;
        const int client = accept4(socket_, nullptr, nullptr, SOCK_CLOEXEC);
        if (client >= 0) clients_.emplace_back([this, client] { answer(client); });
    }
}

void ObjectStoreServer::answer(int client) {
    const timeval patience{2, 0};
    setsockopt(client, SOL_SOCKET, SO_RCVTIMEO, &patience, sizeof patience);
    const Request request = read_request(client);
    int number = 0;
    if (!request.method.empty()) {
        const std::lock_guard lock(mutex_);
        requests_.push_back({request.method, request.path, request.query, request.headers, {}});
        number = static_cast<int>(requests_.size());
    }
    Fault fault = faults_ && number > 0 ? faults_(request, number) : Fault{};
    if (fault.bytes.empty() && number > 0) fault.bytes = response_to(request);
    std::string_view left = fault.bytes;
    while (!left.empty() && !stop_) {
        const std::size_t most =
            fault.bytes_a_second > 0 ? std::max(1, fault.bytes_a_second / 10) : left.size();
        const ssize_t count = send(client, left.data(), std::min(most, left.size()), MSG_NOSIGNAL);
        if (count <= 0) break;
        sent_ += static_cast<std::size_t>(count);
        left.remove_prefix(static_cast<std::size_t>(count));
        if (fault.bytes_a_second > 0) std::this_thread::sleep_for(std::chrono::milliseconds(100));
    }
    close(client);
}

std::string ObjectStoreServer::response_to(const Request& request) {
    const std::lock_guard lock(mutex_);
    if (request.query.starts_with("uploads"))
        return response(200,
                        "<InitiateMultipartUploadResult><UploadId>one</UploadId>"
                        "</InitiateMultipartUploadResult>");
    if (request.method == "PUT") return put_part(request);
    if (request.method == "POST") return finish_parts(request);
    if (request.method == "DELETE") {
        (request.query.empty() ? objects_.erase(request.path) : uploads_.erase(request.path));
        return response(204);
    }
    return got(request);
}

std::string ObjectStoreServer::put_part(const Request& request) {
    const int part = number_after(request.query, "partNumber=", 0);
    (part > 0 ? uploads_[request.path][part] : objects_[request.path]) = request.body;
    return response(200, "", "ETag: \"part\"\r\n");
}

std::string ObjectStoreServer::finish_parts(const Request& request) {
    std::string all;
    for (const auto& [number, part] : uploads_[request.path])
        all += part;
    uploads_.erase(request.path);
    objects_[request.path] = std::move(all);
    return response(200, "<CompleteMultipartUploadResult/>");
}

std::string ObjectStoreServer::got(const Request& request) {
    const auto found = objects_.find(request.path);
    if (found == objects_.end()) return response(404);
    const std::string& content = found->second;
    const auto range = request.headers.find("range");
    if (range == request.headers.end()) {
        std::string whole = response(200, content, "Accept-Ranges: bytes\r\n");
        if (request.method == "HEAD") whole.resize(whole.size() - content.size());
        return whole;
    }
    const auto first = static_cast<std::size_t>(number_after(range->second, "bytes=", 0));
    const int end = number_after(range->second, "-", static_cast<int>(content.size()) - 1);
    if (first >= content.size()) return response(416);
    const std::size_t last = std::min(content.size() - 1, static_cast<std::size_t>(end));
    return response(206, content.substr(first, last - first + 1),
                    fmt::format("Content-Range: bytes {}-{}/{}\r\n", first, last, content.size()));
}

std::vector<BadAnswer> bad_answers() {
    const std::string head = "HTTP/1.1 206 Partial\r\nContent-Length: 100000\r\n\r\n";
    return {{"Forbidden", ObjectStoreServer::status(403)},
            {"Missing", ObjectStoreServer::status(404)},
            {"NoSuchRange", ObjectStoreServer::status(416)},
            {"Busy", ObjectStoreServer::status(503)},
            {"CutOff", {head + "only so much"}},
            {"Slow", {head + std::string(99000, 'x'), 300}}};
}

}  // namespace relevo::test
