#include "gl/program.h"

#include <array>
#include <utility>

#include <epoxy/gl.h>
#include <fmt/format.h>

#include "base/error.h"
#include "base/text.h"
#include "gl/errors.h"

namespace relevo::gl {
namespace {

template <typename GetLength, typename GetLog>
std::string info_log(GLuint name, GetLength get_length, GetLog get_log) {
    GLint length = 0;
    get_length(name, GL_INFO_LOG_LENGTH, &length);
    std::string log(static_cast<std::size_t>(length > 0 ? length : 0), '\0');
    if (length > 0) {
        GLsizei written = 0;
        get_log(name, length, &written, log.data());
        log.resize(static_cast<std::size_t>(written));
    }
    return log;
}

void compile(GLuint shader, std::string_view text) {
    const char* lines = text.data();
    const GLint length = static_cast<GLint>(text.size());
    glShaderSource(shader, 1, &lines, &length);
    glCompileShader(shader);
}

/// Empty on success, else the driver's log.
std::optional<std::string> compile_error(GLuint shader) {
    GLint good = 0;
    glGetShaderiv(shader, GL_COMPILE_STATUS, &good);
    if (good) return std::nullopt;
    return info_log(shader, glGetShaderiv, glGetShaderInfoLog);
}

/// The same of a linked program.
std::optional<std::string> link_error(GLuint program) {
    GLint good = 0;
    glGetProgramiv(program, GL_LINK_STATUS, &good);
    if (good) return std::nullopt;
    return info_log(program, glGetProgramiv, glGetProgramInfoLog);
}

/// @param is_sampler  of the type of a uniform; the kind none where no Texture is of it
std::optional<TextureKind> kind_of(GLenum type, bool& is_sampler) {
    is_sampler = true;
    switch (type) {
        case GL_SAMPLER_2D:
        case GL_SAMPLER_2D_SHADOW:
        case GL_INT_SAMPLER_2D:
        case GL_UNSIGNED_INT_SAMPLER_2D:
            return TextureKind::D2;
        case GL_SAMPLER_2D_ARRAY:
        case GL_SAMPLER_2D_ARRAY_SHADOW:
        case GL_INT_SAMPLER_2D_ARRAY:
        case GL_UNSIGNED_INT_SAMPLER_2D_ARRAY:
            return TextureKind::D2Array;
        case GL_SAMPLER_3D:
        case GL_INT_SAMPLER_3D:
        case GL_UNSIGNED_INT_SAMPLER_3D:
            return TextureKind::D3;
        case GL_SAMPLER_1D:
        case GL_SAMPLER_1D_ARRAY:
        case GL_SAMPLER_2D_MULTISAMPLE:
        case GL_SAMPLER_2D_RECT:
        case GL_SAMPLER_BUFFER:
        case GL_SAMPLER_CUBE:
        case GL_SAMPLER_CUBE_MAP_ARRAY:
            return std::nullopt;
        default:
            is_sampler = false;
            return std::nullopt;
    }
}

}  // namespace

std::vector<Program::Sampler> Program::samplers() const {
    std::vector<Sampler> found;
    GLint uniforms = 0;
    glGetProgramiv(name(), GL_ACTIVE_UNIFORMS, &uniforms);
    for (GLint i = 0; i < uniforms; ++i) {
        std::array<char, 256> text{};
        GLint size = 0, unit = 0;
        GLenum type = 0;
        glGetActiveUniform(name(), static_cast<GLuint>(i), static_cast<GLsizei>(text.size()),
                           nullptr, &size, &type, text.data());
        bool is_sampler = false;
        const std::optional<TextureKind> kind = kind_of(type, is_sampler);
        if (!is_sampler) continue;
        glGetUniformiv(name(), glGetUniformLocation(name(), text.data()), &unit);
        found.push_back({text.data(), unit, kind});
    }
    return found;
}

void Program::destroy(unsigned name) {
    glDeleteProgram(name);
}

void Program::Pending::destroy_shader(unsigned name) {
    glDeleteShader(name);
}

Program::Pending Program::begin(std::string_view vertex, std::string_view fragment,
                                std::string_view label) {
    Pending pending;
    pending.vertex_ = Pending::Shader(glCreateShader(GL_VERTEX_SHADER));
    pending.fragment_ = Pending::Shader(glCreateShader(GL_FRAGMENT_SHADER));
    compile(pending.vertex_.name(), vertex);
    compile(pending.fragment_.name(), fragment);
    pending.begin_link(label);
    return pending;
}

Program::Pending Program::begin_compute(std::string_view text, std::string_view label) {
    Pending pending;
    pending.compute_ = Pending::Shader(glCreateShader(GL_COMPUTE_SHADER));
    compile(pending.compute_.name(), text);
    pending.begin_link(label);
    return pending;
}

void Program::Pending::begin_link(std::string_view label) {
    const GLuint name = glCreateProgram();
    program_ = Handle<&Program::destroy>(name);
    set_label(GL_PROGRAM, name, label);
    for (const Shader* shader : {&vertex_, &fragment_, &compute_})
        if (shader->name() != 0) glAttachShader(name, shader->name());
    glLinkProgram(name);
}

std::optional<Program> Program::finish(Pending pending, Failure& failure) {
    using Stage = Failure::Stage;
    for (const auto& [shader, stage] : {std::pair(&pending.vertex_, Stage::Vertex),
                                        std::pair(&pending.fragment_, Stage::Fragment),
                                        std::pair(&pending.compute_, Stage::Compute)}) {
        if (shader->name() == 0) continue;
        if (auto log = compile_error(shader->name())) {
            failure = {stage, *log};
            return std::nullopt;
        }
    }
    Program program;
    program.handle_ = std::move(pending.program_);
    const GLuint name = program.name();
    for (const auto* shader : {&pending.vertex_, &pending.fragment_, &pending.compute_})
        if (shader->name() != 0) glDetachShader(name, shader->name());
    if (auto log = link_error(name)) {
        failure = {Stage::Link, *log};
        return std::nullopt;
    }
    return program;
}

void Program::use() const {
    glUseProgram(name());
}

void ComputeProgram::destroy(unsigned name) {
    glDeleteProgram(name);
}

ComputeProgram::ComputeProgram(std::string_view text, std::string_view label) {
    const std::string ended(text);
    const char* const lines = ended.c_str();
    handle_ =
        Handle<&ComputeProgram::destroy>(glCreateShaderProgramv(GL_COMPUTE_SHADER, 1, &lines));
    set_label(GL_PROGRAM, handle_.name(), label);
    if (const auto log = link_error(handle_.name()))
        failed(fmt::format("GL program: {}: {}", label, trimmed(*log)));
}

void ComputeProgram::use() const {
    glUseProgram(handle_.name());
}

void ComputeProgram::set(int location, int value) const {
    glProgramUniform1i(handle_.name(), location, value);
}

}  // namespace relevo::gl
