#pragma once

#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "geo/local_frame.h"
#include "image/image.h"
#include "render/readback.h"
#include "scene/camera.h"

/// What the pixels of a picture show, as layers of an EXR.
namespace relevo::session {

struct LoadedDem;

/// Each is of the middle of a pixel and not smoothed.
enum class DataLayer {
    Depth,     ///< depth.Z: from the eye along the optical axis [m]; infinite without ground
    Normal,    ///< normal.X, .Y, .Z: unit normal in the local frame, as shaded; 0 on walls
    Position,  ///< position.X, .Y, .Z: in the local frame as drawn, exaggeration included [m]
    Shadow,    ///< shadow.Y: visible fraction of the sun, 0 in shadow, 1 in light; 0 on walls
    Albedo,    ///< albedo.R, .G, .B: diffuse colour by effects, linear, without light; 0 on walls
    Ids,       ///< ids.kind, whole: 0 nothing, 1 ground, 2 water, 3 wall of the DEM
};

/// "depth", "normal" ...
const std::string& word_of(DataLayer layer);
/// Reads "depth,normal" or "all". @throws Error (BadInput) for other words
/// @param who  what an error begins with
std::vector<DataLayer> parse_layers(const std::vector<std::string>& words, const std::string& who);

/// Where pixels of a picture are.
struct LayerView {
    const scene::Camera& camera;
    glm::ivec2 picture_px;  ///< size of the whole picture
    /// Of the image from the lower left corner of the picture [px].
    glm::ivec2 corner_px, size_px;
};

/// The channels of an image.
std::vector<image::Channel> channels_of(const std::vector<DataLayer>& layers,
                                        const render::PixelData& data, const LayerView& view,
                                        const LoadedDem& dem, const geo::LocalFrame& frame);

}  // namespace relevo::session
