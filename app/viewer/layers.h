#pragma once

#include <cstddef>
#include <optional>
#include <string>
#include <vector>

#include "viewer/document.h"
#include "viewer/file_place.h"

/// What lies on the ground, for the panel Layers.
namespace relevo::viewer {

/// Something that is drawn on the ground: the overlay, or an effect with a raster, lines, marks or
/// the hook display. Effects are found by what their manifests and GLSL declare. Those for a
/// feature of the DEM, such as its voids, are none.
struct Layer {
    /// In the order in which they cover each other.
    enum class Group {
        Lit,    ///< colours of the ground, in the light of the sun
        Flat,   ///< in their own colours
        Marks,  ///< names and symbols, over the image
    };
    Group group = Group::Flat;
    std::string id;       ///< of the effect, or effect::kOverlay
    std::string name;     ///< "Photograph"
    std::string source;   ///< name of its file; empty: none
    bool is_on = true;    ///< drawn
    std::string opacity;  ///< address of the parameter; empty: none
    std::string light;    ///< address of the parameter that makes it lit or flat; empty: none
    std::string file;     ///< address of the text with its file; empty: none

    bool is_overlay() const { return id == effect::kOverlay; }
};

/// The layers, from top to bottom. Layers that are off come last: effects that were switched off by
/// name or have a file, and a hidden overlay.
std::vector<Layer> layers_of(const EffectsModel& effects, const Document& document);

/// The files of effects in the list, with what they hold.
std::vector<std::pair<FileKind, std::string>> files_of_layers(const EffectsModel& effects,
                                                              const Document& document);

/// Ids of installed effects that draw on the ground and are not among `layers`.
std::vector<std::string> further_layers(const EffectsModel& effects,
                                        const std::vector<Layer>& layers);

/// Whether a layer can change places with the one above (-1) or below (+1): one of its group, which
/// is on.
bool can_move(const std::vector<Layer>& layers, std::size_t layer, int by);
/// Switches with an order in which they have changed places. @pre can_move()
effect::Switches moved(effect::Switches switches, std::vector<Layer> layers, std::size_t layer,
                       int by);

/// Effects without a layer: switched off, with default values and no place in the order.
/// @param is_default  on by default
scene::Effects without_layer(scene::Effects effects, const std::string& id, bool is_default);

/// The value of a light parameter that makes a layer lit or flat.
/// @param light  address, as Layer::light
std::string light_value(const EffectsModel& effects, const std::string& light, bool lit);
bool is_lit(const EffectsModel& effects, const std::string& light);

}  // namespace relevo::viewer
