// Loads a native module and calls each of its functions, so that what goes wrong there goes wrong
// here.
//
// try_module LIBRARY ID FOLDER: parameters on standard input and a report on standard output, as
// effect/module_trial.cpp and effect/trial_report.h say. Links with little, so that it starts in
// two milliseconds.
#include <array>
#include <cerrno>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstdlib>
#include <cstring>
#include <exception>
#include <string>
#include <string_view>

#include <dlfcn.h>
#include <fcntl.h>
#include <relevo/plugin.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include "effect/service_tables.h"
#include "effect/stand_in_host.h"
#include "effect/trial_report.h"

namespace {

using namespace relevo::effect;

constexpr int kFrames = 3;

/// The way to who started this. What the module prints goes elsewhere.
class Report {
  public:
    Report() : fd_(fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3)) {
        const int nowhere = open("/dev/null", O_RDWR);
        dup2(nowhere, STDIN_FILENO);
        dup2(nowhere, STDOUT_FILENO);
        close(nowhere);
    }
    void stage(const char* name) const { write(std::string(1, kStageMark) + name + '\n'); }
    [[noreturn]] void end(std::string_view reason) const {
        std::string text(1, kVerdictMark);
        for (const char c : reason.substr(0, kMaxReasonBytes))
            text += c == kStageMark || c == kVerdictMark || c == kReportEnd ? '?' : c;
        write(text + kReportEnd);
        // Destructors of a bad library are not to be trusted either.
        _exit(0);
    }

  private:
    void write(std::string_view text) const {
        while (!text.empty()) {
            const ssize_t written = ::write(fd_, text.data(), text.size());
            if (written < 0 && errno == EINTR) continue;
            if (written <= 0) _exit(0);
            text.remove_prefix(static_cast<std::size_t>(written));
        }
    }
    int fd_;
};

void read_parameters(StandInHost& host) {
    char address[256];
    int kind = 0;
    std::array<double, 4> v{};
    while (std::scanf("%255s %d %lf %lf %lf %lf", address, &kind, &v[0], &v[1], &v[2], &v[3]) == 6)
        if (kind == kText)
            host.add_text(address);
        else
            host.add_parameter(address, kind == kHostValue, v);
}

class Trial {
  public:
    Trial(const Report& report, StandInHost& host) : report_(report), host_(host), tables_(host) {}

    [[noreturn]] void run(const char* path, const char* id) {
        report_.stage("loading it");
        void* library = dlopen(path, RTLD_NOW | RTLD_LOCAL);
        if (!library) report_.end(std::string("it cannot be loaded: ") + dlerror());
        register_it(library, id);
        call_it();
        report_.end("");
    }

  private:
    /// Calls one of the module's functions. @returns whether it did what it was asked to
    template <typename Body>
    bool call(const char* name, const Body& body) const {
        report_.stage(name);
        try {
            return body() == RELEVO_OK;
        } catch (const std::exception& error) {
            report_.end(std::string(name) + " threw an exception: " + error.what());
        } catch (...) {
            report_.end(std::string(name) + " threw an exception");
        }
    }

    void register_it(void* library, const char* id) {
        const auto* version = static_cast<const uint32_t*>(dlsym(library, "relevo_plugin_abi"));
        if (!version) report_.end("it has no symbol relevo_plugin_abi; see RELEVO_PLUGIN");
        if (*version >> 16 != RELEVO_ABI_MAJOR)
            report_.end("expected version " + std::to_string(RELEVO_ABI_MAJOR) +
                        " of the plugin interface but got " + std::to_string(*version >> 16) + "." +
                        std::to_string(*version & 0xffff) +
                        "; build it with this program's relevo/plugin.h");
        const auto registration = reinterpret_cast<decltype(&relevo_plugin_register)>(
            dlsym(library, "relevo_plugin_register"));
        if (!registration)
            report_.end("it has no symbol relevo_plugin_register; see RELEVO_PLUGIN");
        module_.size = sizeof module_;
        if (!call("its registration", [&] { return registration(tables_.host(), &module_); }))
            report_.end("its registration failed: " +
                        (tables_.reason().empty() ? "no reason given" : tables_.reason()));
        if (!module_.id || std::strcmp(module_.id, id) != 0)
            report_.end(std::string("expected the module of ") + id + " but got that of " +
                        (module_.id ? module_.id : "nobody"));
        if (!module_.create || !module_.destroy) report_.end("its table lacks create or destroy");
    }

    // What fails in good order here may do well with a device.
    void call_it() {
        void* instance = nullptr;
        tables_.offer_all();
        if (!call("its create()", [&] { return module_.create(tables_.host(), &instance); }))
            return;
        for (int frame = 0; module_.prepare && frame < kFrames; ++frame) {
            host_.begin_frame(frame);
            call("its prepare()", [&] { return module_.prepare(instance); });
            host_.end_frame();
        }
        if (!instance) return;
        call("its destroy()", [&] {
            module_.destroy(instance);
            return RELEVO_OK;
        });
    }

    const Report& report_;
    StandInHost& host_;
    ServiceTables tables_;
    relevo_module module_{};
};

}  // namespace

int main(int argc, char** argv) {
    if (argc != 4) {
        std::fputs("usage: try_module LIBRARY ID FOLDER\n", stderr);
        return 2;
    }
    // A trial ends with who asked for it, and leaves no core file.
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    const rlimit none{0, 0};
    setrlimit(RLIMIT_CORE, &none);
    StandInHost host(argv[3]);
    read_parameters(host);
    Trial(Report(), host).run(argv[1], argv[2]);
}
