#pragma once

#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "gl/handle.h"
#include "gl/texture.h"

namespace relevo::gl {

/// A linked program: vertex and fragment, or compute.
class Program {
    static void destroy(unsigned name);

  public:
    Program() = default;

    /// What the driver said of a text it refused.
    struct Failure {
        enum class Stage { Vertex, Fragment, Compute, Link } stage;
        std::string
            log;  ///< as the driver wrote it; shader::driver_log turns it into the author's lines
    };

    /// A program that the driver may still be compiling, on threads of its own.
    class Pending {
      private:
        friend class Program;
        static void destroy_shader(unsigned name);
        using Shader = Handle<&Pending::destroy_shader>;
        void begin_link(std::string_view label);
        Shader vertex_, fragment_;  // or
        Shader compute_;
        Handle<&Program::destroy> program_;
    };
    /// Begins to compile and link.
    static Pending begin(std::string_view vertex, std::string_view fragment,
                         std::string_view label);
    static Pending begin_compute(std::string_view text, std::string_view label);
    /// Waits for it. @returns nothing and fills `failure` where the driver refuses the text.
    static std::optional<Program> finish(Pending pending, Failure& failure);
    static std::optional<Program> build(std::string_view vertex, std::string_view fragment,
                                        std::string_view label, Failure& failure) {
        return finish(begin(vertex, fragment, label), failure);
    }

    void use() const;

    /// What the text reads textures by.
    struct Sampler {
        std::string name;
        int unit = 0;
        std::optional<TextureKind> kind;  ///< none: of a kind that no Texture is
    };
    std::vector<Sampler> samplers() const;

    unsigned name() const { return handle_.name(); }

  private:
    Handle<&Program::destroy> handle_;
};

/// A linked compute program.
class ComputeProgram {
  public:
    ComputeProgram() = default;
    /// Compiles and links.
    /// @throws Error (Failed) `GL program: LABEL: ` and what the driver says
    ComputeProgram(std::string_view text, std::string_view label);

    void use() const;
    /// Sets the uniform of a location; of this program, whichever is in use.
    void set(int location, int value) const;

  private:
    static void destroy(unsigned name);
    Handle<&ComputeProgram::destroy> handle_;
};

}  // namespace relevo::gl
