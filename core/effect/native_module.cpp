#include "effect/native_module.h"

#include <array>
#include <cerrno>
#include <chrono>
#include <csignal>
#include <cstring>
#include <map>
#include <optional>

#include <dlfcn.h>
#include <fcntl.h>
#include <fmt/format.h>
#include <poll.h>
#include <spawn.h>
#include <sys/wait.h>
#include <unistd.h>

#include "base/error.h"
#include "base/log.h"
#include "base/paths.h"

extern char** environ;

namespace relevo::effect {
namespace {

constexpr std::string_view kWho = "effect::load";
constexpr int kTrialLimit_ms = 10000;

[[noreturn]] void fail(const std::filesystem::path& library, std::string_view what) {
    bad_input(fmt::format("{}: {}: {}", kWho, library.string(), what));
}

const char* signal_name(int signal) {
    switch (signal) {
        case SIGSEGV:
            return "a segmentation fault";
        case SIGABRT:
            return "an abort";
        case SIGBUS:
            return "a bus error";
        case SIGILL:
            return "an illegal instruction";
        case SIGFPE:
            return "an arithmetic error";
        default:
            return nullptr;
    }
}

/// What a child process left: what it wrote, and how it ended.
struct Trial {
    std::string output;
    int status = 0;
    bool too_long = false;
};

/// Runs a program with its standard output in a pipe and its standard error away.
std::optional<Trial> run(const std::filesystem::path& program, std::vector<std::string> arguments) {
    std::array<int, 2> ends{};
    if (pipe2(ends.data(), O_CLOEXEC) != 0) return std::nullopt;
    posix_spawn_file_actions_t actions;
    posix_spawn_file_actions_init(&actions);
    posix_spawn_file_actions_adddup2(&actions, ends[1], STDOUT_FILENO);
    posix_spawn_file_actions_addopen(&actions, STDERR_FILENO, "/dev/null", O_WRONLY, 0);
    posix_spawn_file_actions_addopen(&actions, STDIN_FILENO, "/dev/null", O_RDONLY, 0);
    arguments.insert(arguments.begin(), program.string());
    std::vector<char*> argv;
    for (std::string& argument : arguments)
        argv.push_back(argument.data());
    argv.push_back(nullptr);
    pid_t child = 0;
    const int error = posix_spawn(&child, program.c_str(), &actions, nullptr, argv.data(), environ);
    posix_spawn_file_actions_destroy(&actions);
    close(ends[1]);
    if (error != 0) {
        close(ends[0]);
        return std::nullopt;
    }

    Trial trial;
    const auto began = std::chrono::steady_clock::now();
    std::array<char, 512> buffer;
    while (true) {
        const auto waited = std::chrono::duration_cast<std::chrono::milliseconds>(
            std::chrono::steady_clock::now() - began);
        pollfd ready{ends[0], POLLIN, 0};
        const int left_ms = kTrialLimit_ms - static_cast<int>(waited.count());
        const int events = left_ms > 0 ? poll(&ready, 1, left_ms) : 0;
        if (events < 0 && errno == EINTR) continue;
        if (events <= 0) {
            trial.too_long = true;
            kill(child, SIGKILL);
            break;
        }
        const ssize_t count = read(ends[0], buffer.data(), buffer.size());
        if (count < 0 && errno == EINTR) continue;
        if (count <= 0) break;
        trial.output.append(buffer.data(), static_cast<std::size_t>(count));
    }
    close(ends[0]);
    while (waitpid(child, &trial.status, 0) < 0 && errno == EINTR) {
    }
    return trial;
}

/// Throws what is wrong with a library, found out at a distance.
void try_at_a_distance(const std::filesystem::path& library, const std::string& id) {
    const std::filesystem::path program = module_dir() / "try_module";
    const std::optional<Trial> trial = run(program, {library.string(), id});
    if (!trial)
        fail(library, fmt::format("it cannot be tried: {} does not start; the installation is "
                                  "not whole",
                                  program.string()));
    if (trial->too_long)
        fail(library, fmt::format("its registration took more than {} s", kTrialLimit_ms / 1000));
    if (WIFSIGNALED(trial->status)) {
        const int signal = WTERMSIG(trial->status);
        const char* name = signal_name(signal);
        fail(library, fmt::format("its registration ended in {}",
                                  name ? std::string(name) : fmt::format("signal {}", signal)));
    }
    if (WEXITSTATUS(trial->status) != 0 || trial->output != "good")
        fail(library, trial->output.empty() ? "its registration ended the process" : trial->output);
}

const void* log_service(const relevo_host*, const char* name, uint32_t version) {
    static const relevo_log_1 table{sizeof(relevo_log_1), nullptr,
                                    [](void*, int32_t level, const char* text) {
                                        if (level == RELEVO_LOG_WARNING)
                                            log::warning(text);
                                        else if (level == RELEVO_LOG_INFO)
                                            log::info(text);
                                        else
                                            log::debug(text);
                                    }};
    return std::strcmp(name, "relevo.log") == 0 && version == 1 ? &table : nullptr;
}

}  // namespace

void NativeModule::Close::operator()(void* library) const {
    dlclose(library);
}

NativeModule::NativeModule(NativeModule&&) noexcept = default;
NativeModule& NativeModule::operator=(NativeModule&&) noexcept = default;
NativeModule::~NativeModule() = default;

std::filesystem::path module_file(const Manifest& manifest) {
    const std::string name = manifest.module + ".so";
    const std::filesystem::path own = manifest.folder / name;
    const std::filesystem::path shipped = module_dir() / "plugins" / name;
    std::error_code ignored;
    if (std::filesystem::is_regular_file(own, ignored)) return own;
    if (std::filesystem::is_regular_file(shipped, ignored)) return shipped;
    bad_input(fmt::format("{}: {}: module {} is in neither {} nor {}; build it", kWho,
                          manifest.file.string(), manifest.module, own.string(), shipped.string()));
}

NativeModule NativeModule::load(const Manifest& manifest) {
    NativeModule module;
    module.id_ = manifest.id;
    module.folder_ = manifest.folder;
    module.library_ = module_file(manifest);
    try_at_a_distance(module.library_, manifest.id);

    module.handle_.reset(dlopen(module.library_.c_str(), RTLD_NOW | RTLD_LOCAL));
    if (!module.handle_) fail(module.library_, fmt::format("it cannot be loaded: {}", dlerror()));
    const auto registration = reinterpret_cast<decltype(&relevo_plugin_register)>(
        dlsym(module.handle_.get(), "relevo_plugin_register"));
    static const relevo_host host{sizeof(relevo_host), RELEVO_ABI_VERSION, &log_service,
                                  [](const relevo_host*, const char*) {}};
    module.functions_.size = sizeof module.functions_;
    if (!registration || registration(&host, &module.functions_) != RELEVO_OK)
        fail(module.library_, "its registration failed after it went well once");
    return module;
}

NativeSelection select_and_load(const Registry& registry, const std::vector<Preset>& presets,
                                const Switches& command_line) {
    std::map<std::string, NativeModule> loaded;
    Unusable unusable;
    while (true) {
        NativeSelection result{select(registry, presets, command_line, unusable), {}};
        bool whole = true;
        for (const Effect* effect : result.selection.effects) {
            if (effect->manifest.module.empty() || loaded.count(effect->id()) > 0) continue;
            try {
                loaded.emplace(effect->id(), NativeModule::load(effect->manifest));
            } catch (const Error& error) {
                unusable[effect->id()] = error.what();
                whole = false;
            }
        }
        if (!whole) continue;
        for (const Effect* effect : result.selection.effects)
            if (const auto found = loaded.find(effect->id()); found != loaded.end())
                result.modules.push_back(std::move(found->second));
        return result;
    }
}

}  // namespace relevo::effect
