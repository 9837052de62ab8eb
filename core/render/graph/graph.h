#pragma once

#include <array>
#include <functional>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include "base/pixel_format.h"

/// The frame graph: textures and buffers of a frame, and the passes that read and write them,
/// declared as data. plan() in plan.h derives the order of passes, unused passes, shared memory and
/// barriers. Does not call OpenGL.
/// @source  after Filament's FrameGraph and Frostbite's (Y. O'Donnell, GDC 2017)
namespace relevo::render {

enum class ResourceKind { Texture2D, Texture2DArray, Texture3D, Buffer };

/// Lifetime of a resource's contents, and its origin.
enum class Lifetime {
    Frame,    ///< from its writer to its last reader, or to the next frame if it is an output;
              ///< may share memory with another one
    Kept,     ///< across frames; zero at first and after a change of frame size
    Provided  ///< created outside of the graph, which allocates nothing
};

/// Size of a texture or buffer. A texture's sides are fixed or a fraction of the frame's.
struct ResourceSize {
    double share = 1;           ///< fraction of the frame's width and height; 0: fixed
    int width = 1, height = 1;  ///< fixed size [px]
    int depth = 1;              ///< layers of an array, or depth of a 3-D texture
    std::size_t bytes = 0;      ///< of a buffer
    bool operator==(const ResourceSize&) const = default;

    /// Sides for a frame size, rounded up, at least 1 [px].
    std::array<int, 2> sides_px(int frame_width_px, int frame_height_px) const;
};

struct Resource {
    std::string name;  ///< also the name of its sampler in GLSL
    ResourceKind kind = ResourceKind::Texture2D;
    PixelFormat format = PixelFormat::RGBA8;
    ResourceSize size{};
    Lifetime lifetime = Lifetime::Frame;
    bool linear = false;  ///< linear instead of nearest filtering
    /// Read by the caller after the frame, so that its writers run. Other passes run only if an
    /// output depends on them. A pass with external effects writes a Provided output.
    bool output = false;
};

/// Depth test. Depth is reversed: 0 is the far plane.
enum class DepthTest {
    Nearer,    ///< nearer than the stored depth
    Covered,   ///< full-screen passes: stored depth is not 0
    Uncovered  ///< full-screen passes: stored depth is 0
};

/// A colour target.
struct Colour {
    std::string resource;
    std::optional<std::array<float, 4>> clear{};  ///< before the pass
    bool updates = false;  ///< draws over earlier contents; otherwise these are undefined
};

/// A depth target.
struct Depth {
    std::string resource;  ///< possibly a version: "depth@geometry"
    DepthTest test = DepthTest::Nearer;
    bool writes = false;
    std::optional<float> clear{};  ///< before the pass; requires `writes`
};

/// A stencil target.
struct Stencil {
    std::string resource;
    /// True: clears the stencil and sets it to 1 where the program draws, without colours. false:
    /// draws only where it is 1.
    bool marks = false;
};

enum class PassKind {
    Fullscreen,  ///< one triangle over all targets
    Geometry,    ///< the body draws, with program and targets bound
    Compute,  ///< dispatches the program, whose image or storage block 0 is what it writes; that is
              ///< zero before. Barriers follow only these
    Host      ///< the body may do anything with the resources that it declares
};

/// When a pass runs. Passes that do not run in every frame may use only Kept and Provided
/// resources. They also run if another such pass has changed their inputs.
enum class When {
    Frame,       ///< in every frame
    Sun,         ///< when the sun has moved
    Parameters,  ///< when one of Pass::parameters has changed
    Dem          ///< once for each DEM
};

/// The work groups of a compute pass.
struct Dispatch {
    ResourceSize over{};  ///< has an invocation for each of its texels, or `width` for a buffer
    std::array<int, 3> local_size{1, 1, 1};   ///< invocations of a work group
    std::array<int, 3> work_groups{0, 0, 0};  ///< a fixed number instead of `over`; 0: none

    /// Number of work groups along each axis for a frame size [px].
    std::array<int, 3> groups(int frame_width_px, int frame_height_px) const;
};

struct PassContext;  // render/pass_context.h
class PictureParts;  // render/picture_parts.h

/// A smaller program of a full-screen pass, for parts of the picture that need no more: there it
/// draws the same.
struct PlainProgram {
    std::string name;
    std::function<PictureParts(PassContext&)> parts;  ///< marked are those that need the whole one
};

/// A step of a frame.
///
/// A write replaces a resource's contents; each resource has at most one writer. An update draws
/// over existing contents; several updates of a resource are ordered by `after`. A read sees the
/// contents after the last update, or as "depth@geometry" those after the pass `geometry`, or as
/// "history@before" those of the previous frame.
struct Pass {
    std::string name;
    PassKind kind = PassKind::Fullscreen;
    When when = When::Frame;
    std::vector<std::string> parameters{};  ///< addresses, for When::Parameters
    std::string program{};                  ///< name of a program; empty: none
    std::string program_at_night{};         ///< replaces `program` at night, unless empty
    std::optional<PlainProgram> plain{};    ///< in addition to `program`, but for nights
    std::vector<std::string> reads{};       ///< including the program's samplers
    std::vector<Colour> colours{};          ///< in the order of the program's outputs
    std::optional<Depth> depth{};
    std::optional<Stencil> stencil{};
    /// Written otherwise than as targets: buffers, images, provided textures. One of a compute
    /// pass.
    std::vector<std::string> writes{};
    /// Updated otherwise than as targets.
    std::vector<std::string> updates{};
    std::vector<std::string> after{};  ///< names of earlier passes; unknown names are ignored
    bool clips_voids = false;          ///< enables GL_CLIP_DISTANCE0 if the DEM has voids
    bool culls = false;                ///< triangles that wind otherwise than the ground from above
    /// False in frames that do not read what it writes; empty: all of them do.
    std::function<bool(const PassContext&)> is_needed{};
    std::optional<Dispatch> dispatch{};        ///< of a compute pass, and only there
    std::function<void(PassContext&)> body{};  ///< of a geometry or host pass, and only there
};

struct FrameGraph {
    std::vector<Resource> resources;
    std::vector<Pass> passes;

    /// Null if there is none of that name.
    const Resource* find(std::string_view resource) const;
};

/// A reference to a resource: "depth@geometry" is `depth` after the pass `geometry`.
struct Version {
    std::string resource;
    std::string pass;  ///< empty: after the last pass; "before": of the previous frame
    bool operator==(const Version&) const = default;
    static Version of(std::string_view text);
    bool is_before() const { return pass == "before"; }
};

/// A pass's use of a resource.
struct Access {
    enum class Mode { Read, Write, Update } mode;
    Version version;
    bool operator==(const Access&) const = default;
};

/// All accesses of a pass, including targets.
std::vector<Access> accesses(const Pass& pass);

}  // namespace relevo::render
