// Loads a native module and calls each of its functions: what crashes or hangs, does so in this
// process. effect/module_trial.h has the arguments and the report. It links few libraries, so that
// it starts in two milliseconds.
#include <algorithm>
#include <array>
#include <csignal>
#include <cstdint>
#include <cstdio>
#include <cstring>
#include <exception>
#include <sstream>
#include <string>
#include <string_view>

#include <dlfcn.h>
#include <fcntl.h>
#include <relevo/plugin.h>
#include <sys/prctl.h>
#include <sys/resource.h>
#include <unistd.h>

#include "effect/module_trial.h"
#include "effect/stand_in_host.h"

namespace {

using namespace relevo::effect;

constexpr int kFrames = 3;

/// The report to the program that started this one.
class Report {
  public:
    /// What the module prints must not get into the report.
    Report() : fd_(fcntl(STDOUT_FILENO, F_DUPFD_CLOEXEC, 3)) { dup2(STDERR_FILENO, STDOUT_FILENO); }
    void calls(std::string_view function) {
        copy(function, report_.function);
        write();
    }
    [[noreturn]] void end(std::string_view reason) {
        copy(reason, report_.reason);
        report_.is_complete = true;
        write();
        // Destructors of a bad library may crash.
        _exit(0);
    }

  private:
    template <std::size_t N>
    static void copy(std::string_view from, std::array<char, N>& to) {
        to.fill('\0');
        std::copy_n(from.begin(), std::min(from.size(), N - 1), to.begin());
    }
    void write() {
        if (pwrite(fd_, &report_, sizeof report_, 0) != sizeof report_) _exit(0);
    }

    int fd_;
    TrialReport report_;
};

void read_parameter(const char* argument, StandInHost& host) {
    std::istringstream words(argument);
    std::string kind, address;
    StandInHost::Value value{};
    words >> kind >> address;
    if (kind == "text") return host.add_text(address);
    if (kind == "marks") return host.add_marks(address);
    for (double& v : value)
        words >> v;
    host.add_parameter(address, kind == "host", value);
}

/// Calls a function of the module. @returns whether it succeeded
template <typename Body>
bool call(Report& report, const std::string& function, const Body& body) {
    report.calls(function);
    try {
        return body() == RELEVO_OK;
    } catch (const std::exception& error) {
        report.end(function + " threw an exception: " + error.what());
    } catch (...) {
        report.end(function + " threw an exception");
    }
}

relevo_module load(Report& report, StandInHost& host, const char* file, const std::string& id) {
    report.calls("loading it");
    void* const library = dlopen(file, RTLD_NOW | RTLD_LOCAL);
    if (!library) report.end(std::string("it cannot be loaded: ") + dlerror());
    const auto* version = static_cast<const uint32_t*>(dlsym(library, "relevo_plugin_abi"));
    if (!version) report.end("it has no symbol relevo_plugin_abi; see RELEVO_PLUGIN");
    if (*version >> 16 != RELEVO_ABI_MAJOR)
        report.end("expected version " + std::to_string(RELEVO_ABI_MAJOR) +
                   " of the plugin interface but got " + std::to_string(*version >> 16) + "." +
                   std::to_string(*version & 0xffff) +
                   "; build it with this program's relevo/plugin.h");
    const auto registration = reinterpret_cast<decltype(&relevo_plugin_register)>(
        dlsym(library, "relevo_plugin_register"));
    if (!registration) report.end("it has no symbol relevo_plugin_register; see RELEVO_PLUGIN");
    relevo_module module{};
    module.size = sizeof module;
    if (!call(report, "its registration", [&] { return registration(host.host(), &module); }))
        report.end("its registration failed: " +
                   (host.reason().empty() ? "no reason given" : host.reason()));
    if (!module.id || module.id != id)
        report.end("expected the module of " + id + " but got that of " +
                   (module.id ? module.id : "nobody"));
    if (!module.create || !module.destroy) report.end("its table lacks create or destroy");
    return module;
}

/// Ignores statuses: a function that fails here may succeed with a device.
void call_all(Report& report, StandInHost& host, const relevo_module& module) {
    void* instance = nullptr;
    host.offer_all();
    if (!call(report, "its create()", [&] { return module.create(host.host(), &instance); }))
        return;
    for (int frame = 0; module.prepare && frame < kFrames; ++frame) {
        host.begin_frame(frame);
        call(report, "its prepare()", [&] { return module.prepare(instance); });
        host.end_frame();
    }
    if (!instance) return;
    call(report, "its destroy()", [&] {
        module.destroy(instance);
        return RELEVO_OK;
    });
}

}  // namespace

int main(int argc, char** argv) {
    if (argc < 4) {
        std::fputs("usage: try_module LIBRARY ID FOLDER [PARAMETER ...]\n", stderr);
        return 2;
    }
    // The trial ends with the program that started it, and leaves no core file.
    prctl(PR_SET_PDEATHSIG, SIGKILL);
    const rlimit none{0, 0};
    setrlimit(RLIMIT_CORE, &none);
    StandInHost host(argv[3]);
    for (int i = 4; i < argc; ++i)
        read_parameter(argv[i], host);
    Report report;
    call_all(report, host, load(report, host, argv[1], argv[2]));
    report.end("");
}
