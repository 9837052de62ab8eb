// A native module that does what RELEVO_TEST_FAULT says, "prepare crash": where, and what. A third
// word "later" spares the trial.
#include <chrono>
#include <cstdio>
#include <cstdlib>
#include <sstream>
#include <stdexcept>
#include <string>
#include <thread>

#include <relevo/plugin.h>
#include <signal.h>
#include <unistd.h>

namespace {

bool in_trial() {
    char name[4096];
    const ssize_t length = readlink("/proc/self/exe", name, sizeof name);
    return length > 0 &&
           std::string(name, static_cast<std::size_t>(length)).ends_with("/try_module");
}

/// Deeper than any stack.
int dive(int depth) {
    volatile char here[4096];
    here[0] = static_cast<char>(depth);
    return depth < 0 ? 0 : dive(depth + 1) + here[0];
}

const relevo_host* host_of_this = nullptr;

void misbehave(const std::string& what) {
    volatile int* volatile nowhere = nullptr;
    if (what == "crash") *nowhere = 1;
    if (what == "abort") std::abort();
    if (what == "overflow") dive(0);
    if (what == "exit") std::exit(0);
    if (what == "quick") std::quick_exit(0);
    if (what == "under") _exit(0);
    if (what == "Under") _Exit(0);
    if (what == "throw") throw std::runtime_error("no good today");
    if (what == "throwint") throw 7;
    if (what == "hang")
        while (true)
            std::this_thread::sleep_for(std::chrono::seconds(1));
    if (what == "print")
        while (true)
            std::puts("on and on");
    if (what == "log") {
        const auto* log =
            static_cast<const relevo_log_1*>(host_of_this->service(host_of_this, "relevo.log", 1));
        while (true)
            log->write(log->self, RELEVO_LOG_DEBUG, "on and on");
    }
    if (what == "thread") std::thread([] { std::exit(0); }).join();
    if (what == "fork" && fork() == 0)
        while (true)
            sleep(1);
    if (what == "close")
        for (int i = 0; i < 64; ++i)
            close(i);
    if (what == "kill") raise(SIGKILL);
}

void act(const std::string& where) {
    const char* text = std::getenv("RELEVO_TEST_FAULT");
    std::istringstream words(text ? text : "");
    std::string place, what, when;
    words >> place >> what >> when;
    if (place == where && !(when == "later" && in_trial())) misbehave(what);
}

struct Constructor {
    Constructor() { act("load"); }
    ~Constructor() { act("unload"); }
} constructor;

relevo_status fails(const char* where) {
    const char* text = std::getenv("RELEVO_TEST_FAULT");
    if (!text || std::string(text) != std::string(where) + " fail") return RELEVO_OK;
    host_of_this->fail(host_of_this, "the moon is not full");
    return RELEVO_FAILED;
}

relevo_status create(const relevo_host* host, void** instance) {
    host_of_this = host;
    act("create");
    *instance = &constructor;
    return fails("create");
}

relevo_status prepare(void*) {
    act("prepare");
    return fails("prepare");
}

void destroy(void*) {
    act("destroy");
}

}  // namespace

extern "C" {

const uint32_t relevo_plugin_abi = RELEVO_ABI_VERSION;

relevo_status relevo_plugin_register(const relevo_host* host, relevo_module* module) {
    host_of_this = host;
    act("register");
    module->id = "native";
    module->create = &create;
    module->prepare = &prepare;
    module->destroy = &destroy;
    return fails("register");
}
}
