#pragma once

#include <string>
#include <string_view>
#include <vector>

#include "json/object_reader.h"
#include "shader/param_store.h"

namespace relevo::effect {

/// A value of plugin.json: given there, or that of one of the plugin's parameters.
struct MarkValue {
    shader::ParamValue constant{};  ///< a word is its index
    std::string address;            ///< "labels.size_px"; empty: `constant`

    shader::ParamValue of(const shader::ParamStore& values) const {
        return address.empty() ? constant : values.value(address);
    }
};

/// Texts and symbols at places of a file or of a native module, or at summits that Relevo brings,
/// which core draws over the picture.
struct MarksSpec {
    enum class Symbol { None, Dot, Triangle };
    enum class Order { Rank, Nearest, Highest };

    std::string name;      ///< "places"
    std::string from;      ///< "labels.file": a text of kind file; empty: not from a file
    bool summits = false;  ///< those that Relevo brings; else, without a file, the module sets them
    MarkValue size_px;     ///< height of the letters, in pixels of the picture
    MarkValue colour;      ///< sRGB, 0 to 1
    MarkValue halo;        ///< the same, around letters and symbols
    MarkValue symbol;      ///< index of a Symbol
    MarkValue leader_px;   ///< least length of the line up to the letters; 0: letters beside
    MarkValue above_m;     ///< height of the marks above the ground, in the DEM's heights
    MarkValue distance_px;  ///< least distance between letters or symbols of two marks
    MarkValue repeat_px;    ///< least distance between two marks with the same text
    MarkValue order;        ///< index of an Order: which marks are drawn where room is short
    MarkValue most;         ///< at most so many are drawn
    int line = 0;           ///< in plugin.json
};

/// What a key of `marks` takes. The table is the format: reader, check and documentation follow it.
struct MarkKey {
    enum class Kind { Number, Colour, Word };

    std::string_view key;  ///< "size"
    MarkValue MarksSpec::*member;
    Kind kind;
    double initial, min, max;             ///< of numbers
    std::string_view colour{};            ///< the default of a colour, "#202020"
    std::vector<std::string> words = {};  ///< of a word; the first one is the default
};
const std::vector<MarkKey>& mark_keys();

/// Reads an entry of `marks`.
/// @param object  the entry
/// @param id      of the plugin
/// @throws Error (BadInput) as json::ObjectReader
MarksSpec read_marks(json::ObjectReader& object, const std::string& id, const std::string& name);

/// The first mistake in what an entry refers to, such as a parameter that the plugin lacks; empty
/// without one.
/// @param has_module  the plugin has one, which sets marks without `from`
std::string fault_of(const MarksSpec& marks, const std::vector<shader::Param>& params,
                     const std::vector<shader::TextParam>& texts, bool has_module);

}  // namespace relevo::effect
