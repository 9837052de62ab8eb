#include "gl/context.h"

#include <algorithm>
#include <array>
#include <cstring>
#include <mutex>
#include <utility>

#include <dlfcn.h>
#include <epoxy/egl.h>
#include <epoxy/gl.h>
#include <fmt/format.h>

#include "base/error.h"
#include "base/log.h"
#include "base/text.h"
#include "gl/errors.h"

namespace relevo::gl {
namespace {

constexpr EGLint kMaxDevices = 32;

constexpr std::array<std::string_view, 8> kSoftwareRenderers = {
    "llvmpipe",    "lavapipe", "softpipe", "swr (",
    "swiftshader", "software", "swrast",   "gdi generic"};

struct Candidate {
    Device device;
    EGLDeviceEXT egl_device = nullptr;
};

bool client_extension(const char* name) {
    return epoxy_has_egl_extension(EGL_NO_DISPLAY, name);
}

bool contains(const char* list, const char* word) {
    return list && std::strstr(list, word) != nullptr;
}

/// Libepoxy ends the program where a library is missing that it needs. Each name is a list of which
/// one has to be there.
std::string missing_library() {
    const std::vector<std::vector<const char*>> needed = {{"libEGL.so.1"},
                                                          {"libOpenGL.so.0", "libGL.so.1"}};
    for (const auto& names : needed) {
        const bool found = std::ranges::any_of(names, [](const char* name) {
            // Never closed: libepoxy opens it next.
            return dlopen(name, RTLD_LAZY | RTLD_LOCAL) != nullptr;
        });
        if (!found) return names.front();
    }
    return {};
}

std::vector<Candidate> candidates() {
    std::vector<Candidate> found;
    if (!missing_library().empty()) return found;
    if (client_extension("EGL_EXT_platform_device") && client_extension("EGL_EXT_device_base")) {
        EGLDeviceEXT devices[kMaxDevices];
        EGLint count = 0;
        if (eglQueryDevicesEXT(kMaxDevices, devices, &count) == EGL_TRUE) {
            for (EGLint i = 0; i < count; ++i) {
                const char* extensions = eglQueryDeviceStringEXT(devices[i], EGL_EXTENSIONS);
                Candidate candidate;
                candidate.egl_device = devices[i];
                candidate.device.platform = "device";
                candidate.device.software = contains(extensions, "EGL_MESA_device_software");
                const char* node = nullptr;
                if (contains(extensions, "EGL_EXT_device_drm"))
                    node = eglQueryDeviceStringEXT(devices[i], EGL_DRM_DEVICE_FILE_EXT);
                candidate.device.description = candidate.device.software ? "software renderer"
                                               : node                    ? node
                                                                         : "GPU without a DRM node";
                found.push_back(candidate);
            }
        }
    }
    std::ranges::stable_partition(found, [](const Candidate& c) { return !c.device.software; });
    if (client_extension("EGL_MESA_platform_surfaceless")) {
        Candidate candidate;
        candidate.device.platform = "surfaceless";
        candidate.device.description = "whatever Mesa picks without a surface";
        found.push_back(candidate);
    }
    for (std::size_t i = 0; i < found.size(); ++i)
        found[i].device.index = static_cast<int>(i);
    return found;
}

const char* egl_error() {
    constexpr std::array kNames = {std::pair(EGL_NOT_INITIALIZED, "EGL_NOT_INITIALIZED"),
                                   std::pair(EGL_BAD_ACCESS, "EGL_BAD_ACCESS"),
                                   std::pair(EGL_BAD_ALLOC, "EGL_BAD_ALLOC"),
                                   std::pair(EGL_BAD_ATTRIBUTE, "EGL_BAD_ATTRIBUTE"),
                                   std::pair(EGL_BAD_CONFIG, "EGL_BAD_CONFIG"),
                                   std::pair(EGL_BAD_MATCH, "EGL_BAD_MATCH"),
                                   std::pair(EGL_BAD_PARAMETER, "EGL_BAD_PARAMETER")};
    const EGLint error = eglGetError();
    for (const auto& [number, name] : kNames)
        if (number == error) return name;
    return "EGL gives no reason";
}

const char* gl_string(GLenum name) {
    const GLubyte* text = glGetString(name);
    return text ? reinterpret_cast<const char*>(text) : "";
}

}  // namespace

bool is_software_renderer(std::string_view renderer) {
    // Mesa's (zink may stand on lavapipe, which is llvmpipe), SwiftShader, Windows' and Apple's.
    const std::string name = lower(renderer);
    return std::ranges::any_of(kSoftwareRenderers, [&](std::string_view word) {
        return name.find(word) != std::string::npos;
    });
}

std::vector<Device> list_devices() {
    std::vector<Device> devices;
    for (const Candidate& candidate : candidates())
        devices.push_back(candidate.device);
    return devices;
}

struct Context::Impl {
    EGLDisplay display = EGL_NO_DISPLAY;
    EGLContext context = EGL_NO_CONTEXT;
    std::function<void()> make_current;  // of others' contexts: they destroy it
    bool reports_loss = false;
    DeviceInfo info;
    std::vector<std::string> errors;

    /// Empty on success, else why this device will not do.
    std::string open(const Candidate& candidate, bool debug) {
        if (candidate.egl_device)
            display =
                eglGetPlatformDisplayEXT(EGL_PLATFORM_DEVICE_EXT, candidate.egl_device, nullptr);
        else
            display =
                eglGetPlatformDisplayEXT(EGL_PLATFORM_SURFACELESS_MESA,
                                         reinterpret_cast<void*>(EGL_DEFAULT_DISPLAY), nullptr);
        if (display == EGL_NO_DISPLAY) return fmt::format("no display, {}", egl_error());
        if (!eglInitialize(display, nullptr, nullptr)) {
            display = EGL_NO_DISPLAY;
            return fmt::format("cannot be initialised, {}", egl_error());
        }
        if (!epoxy_has_egl_extension(display, "EGL_KHR_surfaceless_context"))
            return "has no EGL_KHR_surfaceless_context";
        if (!eglBindAPI(EGL_OPENGL_API)) return "has no desktop OpenGL";
        // A context needs no config where the driver allows that; others want any one.
        EGLConfig config = EGL_NO_CONFIG_KHR;
        if (!epoxy_has_egl_extension(display, "EGL_KHR_no_config_context")) {
            const EGLint wanted[] = {EGL_RENDERABLE_TYPE, EGL_OPENGL_BIT, EGL_SURFACE_TYPE, 0,
                                     EGL_NONE};
            EGLint count = 0;
            if (!eglChooseConfig(display, wanted, &config, 1, &count) || count == 0)
                return "has no config for OpenGL";
        }
        std::string reason = create(config, EGL_NO_CONTEXT, debug);
        if (reason.empty()) name(candidate.device);
        return reason;
    }

    /// Makes a context without a surface, and makes it current. Empty on success, else what is
    /// wrong with the device.
    std::string create(EGLConfig config, EGLContext shared, bool debug) {
        const auto attributes = [&](bool with_loss) {
            std::vector<EGLint> list = {
                EGL_CONTEXT_MAJOR_VERSION,       4,
                EGL_CONTEXT_MINOR_VERSION,       5,
                EGL_CONTEXT_OPENGL_PROFILE_MASK, EGL_CONTEXT_OPENGL_CORE_PROFILE_BIT,
                EGL_CONTEXT_OPENGL_DEBUG,        debug ? EGL_TRUE : EGL_FALSE};
            if (with_loss)
                list.insert(list.end(), {EGL_CONTEXT_OPENGL_RESET_NOTIFICATION_STRATEGY,
                                         EGL_LOSE_CONTEXT_ON_RESET});
            list.push_back(EGL_NONE);
            return list;
        };
        // Contexts that share must agree on whether a loss of the device is reported.
        const bool alone = shared == EGL_NO_CONTEXT;
        if (alone) reports_loss = true;
        context = eglCreateContext(display, config, shared, attributes(reports_loss).data());
        if (context == EGL_NO_CONTEXT && alone) {
            reports_loss = false;
            context = eglCreateContext(display, config, shared, attributes(false).data());
        }
        if (context == EGL_NO_CONTEXT)
            return fmt::format("has no OpenGL 4.5 core, {}", egl_error());
        if (!eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, context))
            return fmt::format("cannot be made current, {}", egl_error());
        return {};
    }

    /// Asks the current context what it is.
    void name(const Device& device) {
        info.device = device;
        info.renderer = gl_string(GL_RENDERER);
        info.vendor = gl_string(GL_VENDOR);
        info.version = gl_string(GL_VERSION);
        info.device.software = device.software || is_software_renderer(info.renderer);
    }

    void close() {
        // Not eglTerminate: the display is the process's, and would go from under every other
        // context on it.
        if (context == EGL_NO_CONTEXT || make_current) return;
        if (eglGetCurrentContext() == context)
            eglMakeCurrent(display, EGL_NO_SURFACE, EGL_NO_SURFACE, EGL_NO_CONTEXT);
        eglDestroyContext(display, context);
        display = EGL_NO_DISPLAY;
        context = EGL_NO_CONTEXT;
    }

    ~Impl() { close(); }

    static void GLAPIENTRY on_message(GLenum source, GLenum type, GLuint, GLenum, GLsizei length,
                                      const GLchar* text, const void* user) {
        auto& self = *static_cast<Impl*>(const_cast<void*>(user));
        const std::string_view message(text, static_cast<std::size_t>(std::max(0, length)));
        // What the compiler refuses is told by Program::build.
        if (source == GL_DEBUG_SOURCE_SHADER_COMPILER) return;
        if (type == GL_DEBUG_TYPE_ERROR || type == GL_DEBUG_TYPE_UNDEFINED_BEHAVIOR)
            self.errors.emplace_back(trimmed(message));
        else
            log::debug(fmt::format("gl: {}", trimmed(message)));
    }

    void start(bool debug) {
        GLint value = 0;
        glGetIntegerv(GL_MAX_TEXTURE_IMAGE_UNITS, &value);
        info.max_texture_units = value;
        glGetIntegerv(GL_MAX_TEXTURE_SIZE, &value);
        info.max_texture_size = value;
        std::array<GLint, 2> viewport{};
        glGetIntegerv(GL_MAX_VIEWPORT_DIMS, viewport.data());
        info.max_picture_size = std::min({info.max_texture_size, viewport[0], viewport[1]});
        glGetIntegerv(GL_MAX_3D_TEXTURE_SIZE, &value);
        info.max_volume_size = value;
        glGetIntegerv(GL_MAX_ARRAY_TEXTURE_LAYERS, &value);
        info.max_array_layers = value;
        glGetInternalformativ(GL_RENDERBUFFER, GL_RGBA16F, GL_SAMPLES, 1, &value);
        info.max_samples = value;
        if (epoxy_has_gl_extension("GL_ARB_texture_filter_anisotropic") ||
            epoxy_has_gl_extension("GL_EXT_texture_filter_anisotropic")) {
            GLfloat most = 1;
            glGetFloatv(GL_MAX_TEXTURE_MAX_ANISOTROPY, &most);
            info.max_anisotropy = most;
        }
        if (debug) {
            glEnable(GL_DEBUG_OUTPUT);
            glEnable(GL_DEBUG_OUTPUT_SYNCHRONOUS);
            glDebugMessageCallback(&Impl::on_message, this);
            // Performance chatter and labels' push and pop say nothing of correctness.
            glDebugMessageControl(GL_DONT_CARE, GL_DEBUG_TYPE_PUSH_GROUP, GL_DONT_CARE, 0, nullptr,
                                  GL_FALSE);
            glDebugMessageControl(GL_DONT_CARE, GL_DEBUG_TYPE_POP_GROUP, GL_DONT_CARE, 0, nullptr,
                                  GL_FALSE);
        }
        if (epoxy_has_gl_extension("GL_KHR_parallel_shader_compile"))
            glMaxShaderCompilerThreadsKHR(~GLuint{0});  // as many as the driver likes
        glClipControl(GL_LOWER_LEFT, GL_ZERO_TO_ONE);
        glPixelStorei(GL_UNPACK_ALIGNMENT, 1);
        glPixelStorei(GL_PACK_ALIGNMENT, 1);
    }
};

std::string fall_back_notice(std::span<const RefusedDevice> refused, const DeviceInfo& chosen) {
    const auto hardware = std::ranges::find_if(refused, [](const RefusedDevice& each) {
        return each.device.platform == "device" && !each.device.software;
    });
    if (hardware == refused.end() || !chosen.device.software) return "";
    return fmt::format("gl: {} draws, on the processor, as device {} ({}) {}", chosen.renderer,
                       hardware->device.index, hardware->device.description, hardware->reason);
}

namespace {

void tell_of_fall_back(std::span<const RefusedDevice> refused, const DeviceInfo& chosen) {
    static std::once_flag once;
    if (const std::string notice = fall_back_notice(refused, chosen); !notice.empty())
        std::call_once(once, [&] { log::warning(notice); });
}

}  // namespace

Context::Context(const ContextOptions& options) : impl_(std::make_unique<Impl>()) {
    const std::vector<Candidate> all = candidates();
    const std::string wanted = lower(options.device.empty() ? "auto" : options.device);
    const std::optional<double> index = parse_number(wanted);
    std::vector<RefusedDevice> refused;
    for (const Candidate& candidate : all) {
        const Device& device = candidate.device;
        if (index && device.index != static_cast<int>(*index)) continue;
        // What surfaceless is shows when it is open.
        if (wanted == "software" && !device.software && candidate.egl_device) continue;
        std::string reason = impl_->open(candidate, options.debug);
        if (reason.empty() && wanted == "software" && !impl_->info.device.software)
            reason = fmt::format("is {}", impl_->info.renderer);
        const bool by_name = wanted != "auto" && wanted != "software" && !index;
        if (reason.empty() && by_name &&
            lower(impl_->info.renderer + " " + impl_->info.vendor).find(wanted) ==
                std::string::npos)
            reason = fmt::format("is {}", impl_->info.renderer);
        if (reason.empty()) {
            impl_->start(options.debug);
            log::debug(fmt::format("gl: {} draws", impl_->info.renderer));
            if (wanted == "auto") tell_of_fall_back(refused, impl_->info);
            return;
        }
        impl_->close();
        refused.push_back({device, reason});
    }
    if (const std::string missing = missing_library(); !missing.empty())
        throw Error(
            ErrorCode::NoDevice,
            fmt::format("gl: no GL device: there is no {}; install Mesa's software renderer "
                        "(libegl1, libopengl0, libegl-mesa0, libgl1-mesa-dri)",
                        missing));
    if (all.empty())
        throw Error(ErrorCode::NoDevice,
                    "gl: no GL device: EGL offers none; install Mesa's software renderer "
                    "(libegl1, libegl-mesa0, libgl1-mesa-dri)");
    std::string tried;
    for (const auto& [device, reason] : refused)
        tried += fmt::format("\n  {}: {} ({}) {}", device.index, device.platform,
                             device.description, reason);
    throw Error(ErrorCode::NoDevice,
                fmt::format("gl: no GL device: none of the {} found is \"{}\" and can draw with "
                            "OpenGL 4.5 core{}; see `relevo doctor`",
                            all.size(), printable(options.device), tried));
}

Context::Context(std::unique_ptr<Impl> impl) : impl_(std::move(impl)) {}

Context Context::of_others(std::function<void()> make_current) {
    auto impl = std::make_unique<Impl>();
    impl->make_current = std::move(make_current);
    impl->make_current();
    constexpr int kVersion = 45;
    if (epoxy_gl_version() < kVersion)
        throw Error(ErrorCode::NoDevice,
                    fmt::format("gl: expected a window that draws with OpenGL 4.5 core but got {}",
                                gl_string(GL_VERSION)));
    impl->display = eglGetCurrentDisplay();
    impl->context = eglGetCurrentContext();
    GLint strategy = 0;
    glGetIntegerv(GL_RESET_NOTIFICATION_STRATEGY, &strategy);
    impl->reports_loss = strategy == GL_LOSE_CONTEXT_ON_RESET;
    impl->name({.index = -1, .platform = "window", .description = "the window's"});
    impl->start(/*debug=*/false);
    return Context(std::move(impl));
}

Context Context::sharing(const Context& other) {
    const Impl& from = *other.impl_;
    auto impl = std::make_unique<Impl>();
    impl->display = from.display;
    impl->reports_loss = from.reports_loss;
    std::string reason;
    EGLint id = 0;
    EGLConfig config = nullptr;
    EGLint count = 0;
    if (from.context == EGL_NO_CONTEXT ||
        !eglQueryContext(from.display, from.context, EGL_CONFIG_ID, &id))
        reason = "is not of EGL";
    else if (!epoxy_has_egl_extension(from.display, "EGL_KHR_surfaceless_context"))
        reason = "has no EGL_KHR_surfaceless_context";
    else if (!eglBindAPI(EGL_OPENGL_API))
        reason = "has no desktop OpenGL";
    else {
        const EGLint wanted[] = {EGL_CONFIG_ID, id, EGL_NONE};
        if (!eglChooseConfig(from.display, wanted, &config, 1, &count) || count == 0)
            config = EGL_NO_CONFIG_KHR;
        reason = impl->create(config, from.context, /*debug=*/false);
    }
    if (!reason.empty())
        throw Error(ErrorCode::NoDevice,
                    fmt::format("gl: the window's display, {}, shares no context: it {}",
                                from.info.renderer, reason));
    impl->name(from.info.device);
    impl->start(/*debug=*/false);
    return Context(std::move(impl));
}

bool Context::is_on_device_of(const Context& other) const {
    const auto device_of = [](EGLDisplay display) -> EGLAttrib {
        EGLAttrib device = 0;
        if (display == EGL_NO_DISPLAY || !client_extension("EGL_EXT_device_query") ||
            !eglQueryDisplayAttribEXT(display, EGL_DEVICE_EXT, &device))
            return 0;
        return device;
    };
    if (impl_->display != EGL_NO_DISPLAY && impl_->display == other.impl_->display) return true;
    const EGLAttrib device = device_of(impl_->display);
    return device != 0 && device == device_of(other.impl_->display);
}

Context::Context(Context&&) noexcept = default;
Context& Context::operator=(Context&&) noexcept = default;
Context::~Context() = default;

const DeviceInfo& Context::info() const {
    return impl_->info;
}

void Context::check_errors() {
    throw_if_lost();
    const GLenum error = glGetError();
    if (impl_->errors.empty() && error != GL_NO_ERROR) impl_->errors.push_back(error_name(error));
    if (impl_->errors.empty()) return;
    const std::string message = fmt::format("gl: {}", fmt::join(impl_->errors, "; "));
    impl_->errors.clear();
    failed(message);
}

void Context::make_current() {
    if (impl_->make_current) return impl_->make_current();
    if (eglGetCurrentContext() == impl_->context) return;
    if (!eglMakeCurrent(impl_->display, EGL_NO_SURFACE, EGL_NO_SURFACE, impl_->context))
        failed(fmt::format("gl: the context cannot be made current, {}", egl_error()));
}

void Context::finish() {
    glFinish();
}

}  // namespace relevo::gl
