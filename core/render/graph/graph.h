#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/pixel_format.h"

/// The frame graph: which textures and buffers a frame needs, and which passes read and write them,
/// declared as data. plan() of plan.h derives the order of the passes, the passes that nobody
/// needs, the memory that textures share, and barriers. Nothing here calls OpenGL.
/// @source  the idea is that of Filament's FrameGraph and of Frostbite's (Y. O'Donnell, GDC 2017)
namespace relevo::render {

enum class ResourceKind { Texture2D, Texture2DArray, Texture3D, Buffer };

/// How long the contents of a resource are needed, and who makes it.
enum class Lifetime {
    Frame,    ///< from its writer to its last reader, or to the next frame if it is an output;
              ///< may share memory with another one
    Kept,     ///< from frame to frame; 0 at first and when frames get another size
    Provided  ///< made by a pass's own code or by the caller: the graph allocates nothing
};

/// Size of a texture or a buffer. The sides of a texture are a share of the frame's, or fixed.
struct ResourceSize {
    double share = 1;           ///< of the frame's width and height; 0: fixed
    int width = 1, height = 1;  ///< [px], of a fixed size
    int depth = 1;              ///< layers of an array, or depth of a 3-D texture
    std::size_t bytes = 0;      ///< of a buffer
    bool operator==(const ResourceSize&) const = default;

    /// The sides in a frame of a size, rounded up and at least 1 [px].
    std::array<int, 2> sides_px(int frame_width_px, int frame_height_px) const;
};

struct Resource {
    std::string name;  ///< also the name of the sampler that reads it in GLSL
    ResourceKind kind = ResourceKind::Texture2D;
    PixelFormat format = PixelFormat::RGBA8;
    ResourceSize size{};
    Lifetime lifetime = Lifetime::Frame;
    bool linear = false;  ///< sampled with linear filtering instead of nearest
    /// Read by the caller after the frame: the passes that write it are executed. Of other passes
    /// only those are that one of these needs. A pass with an effect outside the frame writes a
    /// Provided output.
    bool output = false;
};

/// Which pixels a draw reaches, by the stored depth. Depth is reversed: 0 is the far end.
enum class DepthTest {
    Nearer,    ///< where it is nearer than what is stored
    Covered,   ///< of a full-screen pass: where the stored depth is not 0
    Uncovered  ///< of a full-screen pass: where it is 0
};

/// A colour target of a pass.
struct Colour {
    std::string resource;
    std::optional<std::array<float, 4>> clear{};  ///< before the pass
    bool updates = false;  ///< needs what an earlier pass has written; else that is undefined
};

/// The depth target of a pass.
struct Depth {
    std::string resource;  ///< may be a version: "depth@geometry"
    DepthTest test = DepthTest::Nearer;
    bool writes = false;
    std::optional<float> clear{};  ///< before the pass; requires `writes`
};

/// The stencil target of a pass.
struct Stencil {
    std::string resource;
    /// Clears the stencil and sets 1 where the program draws, without colours; else draws only
    /// where it is 1.
    bool marks = false;
};

enum class PassKind {
    Fullscreen,  ///< one triangle over all targets
    Geometry,    ///< its body draws, with the program and the targets bound
    Compute,     ///< its body dispatches, with the program bound; only after these are barriers
    Host         ///< its body does what it likes with the resources that it declares
};

/// When a pass is executed. A pass that is not executed in every frame may use Kept and Provided
/// resources only. It is also executed when such a pass has changed what it reads.
enum class When {
    Frame,       ///< in every frame
    Sun,         ///< when the sun has moved
    Parameters,  ///< when one of Pass::parameters has another value
    Dem          ///< once for each ground
};

struct PassContext;  // render/pass_context.h

/// A step of a frame.
///
/// A pass writes a resource if it needs nothing of what that held before; at most one pass does. It
/// updates a resource if it draws over what another has written; several updates of one resource
/// need an order by `after`. A pass reads what the last update leaves, or, as "depth@geometry",
/// what the pass `geometry` leaves, or, as "history@before", what the frame before has left.
struct Pass {
    std::string name;
    PassKind kind = PassKind::Fullscreen;
    When when = When::Frame;
    std::vector<std::string> parameters{};  ///< addresses, for When::Parameters
    std::string program{};                  ///< name of a program; empty: none
    std::string program_at_night{};         ///< takes its place while it is night; empty: none does
    std::vector<std::string> reads{};       ///< also what the program's samplers name
    std::vector<Colour> colours{};          ///< in the order of the program's outputs
    std::optional<Depth> depth{};
    std::optional<Stencil> stencil{};
    /// Written, but not as targets: buffers, images, provided textures.
    std::vector<std::string> writes{};
    /// Updated, but not as targets.
    std::vector<std::string> updates{};
    std::vector<std::string> after{};          ///< names of passes; a name of none is ignored
    bool clips_voids = false;                  ///< GL_CLIP_DISTANCE0, where the DEM has voids
    std::function<void(PassContext&)> body{};  ///< of all kinds but Fullscreen
};

struct FrameGraph {
    std::vector<Resource> resources;
    std::vector<Pass> passes;

    /// Null where there is none.
    const Resource* find(std::string_view resource) const;
};

/// A resource as a pass names it: "depth@geometry" is version `geometry` of `depth`.
struct Version {
    std::string resource;
    std::string pass;  ///< empty: the last one; "before": of the frame before
    bool operator==(const Version&) const = default;
    static Version of(std::string_view text);
    bool is_before() const { return pass == "before"; }
};

/// What a pass does to a resource.
struct Access {
    enum class Mode { Read, Write, Update } mode;
    Version version;
    bool operator==(const Access&) const = default;
};

/// Every access of a pass, targets included.
std::vector<Access> accesses(const Pass& pass);

}  // namespace relevo::render
