#pragma once

#include <atomic>
#include <functional>
#include <map>
#include <mutex>
#include <string>
#include <thread>
#include <vector>

namespace relevo::test {

/// An object store on this machine, with as much of S3's protocol as GDAL asks of one: objects are
/// got whole or in ranges, put whole or in parts, listed as nothing, and deleted. One request for
/// each connection.
class ObjectStoreServer {
  public:
    struct Request {
        std::string method, path, query;
        std::map<std::string, std::string> headers;  // names in small letters
        std::string body;
    };
    /// What is sent instead of an answer.
    struct Fault {
        std::string bytes;       ///< after which the connection is closed
        int bytes_a_second = 0;  ///< 0: at once
    };
    /// Asked for each request; without bytes the store answers.
    using Faults = std::function<Fault(const Request& request, int number)>;

    explicit ObjectStoreServer(Faults faults = {});
    ~ObjectStoreServer();
    ObjectStoreServer(const ObjectStoreServer&) = delete;
    ObjectStoreServer& operator=(const ObjectStoreServer&) = delete;

    std::string address() const;  ///< "127.0.0.1:1234"
    /// Variables with which GDAL's /vsis3/ goes here.
    std::vector<std::string> environment() const;

    void put(const std::string& path, std::string content);  ///< "/bucket/a.tif"
    std::map<std::string, std::string> objects() const;
    std::vector<Request> requests() const;  ///< without their bodies
    std::size_t bytes_sent() const { return sent_; }

    static Fault status(int code);  ///< an answer of that status and no content

  private:
    void serve();
    void answer(int client);
    std::string response_to(const Request& request);
    std::string put_part(const Request& request);
    std::string finish_parts(const Request& request);
    std::string got(const Request& request);

    Faults faults_;
    int socket_ = -1, port_ = 0;
    std::atomic<bool> stop_ = false;
    std::atomic<std::size_t> sent_ = 0;
    mutable std::mutex mutex_;
    std::map<std::string, std::string> objects_;
    std::map<std::string, std::map<int, std::string>> uploads_;  // parts by path
    std::vector<Request> requests_;
    std::vector<std::thread> clients_;
    std::thread thread_;
};

/// What stores may answer in place of an object.
struct BadAnswer {
    const char* name;
    ObjectStoreServer::Fault fault;
};
std::vector<BadAnswer> bad_answers();

}  // namespace relevo::test
