#pragma once

#include <algorithm>
#include <array>
#include <cstddef>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "image/image.h"
#include "scene/scene.h"
#include "sun/zone.h"
#include "viewer/translation.h"

/// What the export sheet asks for, and the file that follows. Needs no device and no panels.
namespace relevo::viewer {

struct ExportFormat {
    const char* name;
    const char* ending;
    int bits = 8;
    bool has_quality = false;
    bool has_alpha = true;
};
inline constexpr std::array<ExportFormat, 7> kExportFormats = {
    {{"PNG", "png"},
     {tr_later("PNG, 16 bits"), "png", 16},
     {"JPEG", "jpg", 8, true, false},
     {"WebP", "webp", 8, true},
     {"AVIF", "avif", 8, true},
     {"TIFF", "tif"},
     {tr_later("EXR, linear light"), "exr"}}};
inline constexpr int kPng = 0, kJpeg = 2, kTiff = 5;  // indices of kExportFormats
inline constexpr std::array<int, 4> kExportSamples = {1, 4, 8, 16};

using scene::Panorama, scene::Stereo;

struct ExportKind {
    const char* name;
    const char* ending = "";  ///< of what has one format only
    glm::ivec2 size_px{0};
    bool is_ortho = false;
    Panorama panorama = Panorama::None;
    Stereo stereo = Stereo::None;
    bool is_sheet = false;  ///< a map on paper

    bool is_picture() const { return ending[0] == '\0' || is_sheet; }
    bool is_panorama() const { return panorama != Panorama::None; }
    /// Whether it is seen through one lens, so that it has one scale and direction.
    bool has_lens() const { return is_picture() && !is_panorama() && stereo == Stereo::None; }
};
inline constexpr std::array<ExportKind, 10> kExportKinds = {
    {{tr_later("picture"), "", {1920, 1080}},
     {tr_later("map of all of the DEM, with georeference"), "", {2048, 2048}, true},
     {.name = tr_later("map sheet on paper, PDF"),
      .ending = "pdf",
      .is_ortho = true,
      .is_sheet = true},
     {tr_later("panorama"), "", {8192, 1024}, false, Panorama::Cylindrical},
     {tr_later("sphere (equirectangular)"), "", {4096, 2048}, false, Panorama::Equirectangular},
     {tr_later("stereo pair"), "", {2560, 1024}, false, Panorama::None, Stereo::Parallel},
     {tr_later("anaglyph"), "", {1920, 1080}, false, Panorama::None, Stereo::Anaglyph},
     {tr_later("mesh of the ground, glTF"), "glb"},
     {tr_later("solid for a 3D printer, STL"), "stl"},
     {tr_later("figures of the overlay, as GeoTIFF"), "tif"}}};
/// Indices of kExportKinds.
inline constexpr int kPicture = 0, kMap = 1, kSheet = 2, kMesh = 7, kSolid = 8, kFigures = 9;

inline constexpr std::array<const char*, 5> kExportPapers = {{"A4", "A3", "A2", "A1", "A0"}};

inline constexpr double kLeastError_m = 0.001, kMostError_m = 10000;

/// What is exported, and where to. Remembered.
struct ExportChoice {
    int kind = kPicture;  ///< index of kExportKinds
    glm::ivec2 size_px{1920, 1080};
    int format = kPng;  ///< index of kExportFormats
    int samples = 4, quality = image::kQuality;
    bool is_transparent = false, is_centred = true;
    double error_m = 1;  ///< of a mesh
    int paper = 0;       ///< index of kExportPapers
    /// n of a sheet's scale 1 : n; 0: the roundest at which all of the DEM fits.
    double map_scale = 0;
    std::string folder;  ///< empty: the working folder
    std::string name = "{dem}_{time:%Y%m%dT%H%M}";

    bool operator==(const ExportChoice&) const = default;
    const ExportKind& of() const { return kExportKinds[static_cast<std::size_t>(kind)]; }
    const ExportFormat& file_format() const {
        return kExportFormats[static_cast<std::size_t>(format)];
    }
    bool can_be_transparent() const {
        return file_format().has_alpha && of().stereo != Stereo::Anaglyph;
    }
    /// @param n  of a sheet's 1 : n; below 1: as large as fits
    void set_map_scale(double n) { map_scale = n >= 1 ? std::min(n, 1e9) : 0; }
    /// The paper of a sheet.
    scene::Sheet sheet() const;
    /// Another kind, with a size and a format that suit it.
    void set_kind(int index);
    /// Width over height, of a stereo pair of each of its two.
    double aspect() const;
};

/// Size, format and stamps that suit a use.
struct ExportUse {
    const char* name;
    int kind;
    glm::ivec2 size_px;  ///< 0: the window's
    int format, samples;
    bool is_stamped = false;

    bool is_of(const ExportChoice& choice) const;
    void apply_to(ExportChoice& choice, scene::Stamps& stamps, glm::ivec2 window_px) const;
};
inline constexpr std::array<ExportUse, 5> kExportUses = {
    {{tr_later("as the window"), kPicture, {0, 0}, kPng, 4},
     {tr_later("web"), kPicture, {1920, 1080}, kJpeg, 4},
     {tr_later("print, A4 at 300 dpi"), kPicture, {3508, 2480}, kPng, 8, true},
     {tr_later("poster, A2 at 300 dpi"), kPicture, {7016, 4961}, kPng, 8, true},
     {tr_later("data"), kMap, {2048, 2048}, kTiff, 4}}};

/// A file to be written.
struct ExportOrder {
    scene::Scene scene;  ///< of a picture with size, samples, transparency and stamps
    std::string path;
    image::Encoding encoding{};
    int kind = kPicture;  ///< index of kExportKinds
    double error_m = 1;   ///< of a mesh
    bool overwrite = false;

    bool is_picture() const { return kExportKinds[static_cast<std::size_t>(kind)].is_picture(); }
};

/// The order of a choice for a scene.
/// @param utc, zone  the scene's time, for the name
/// @throws Error (BadInput) for names, formats and sizes that cannot be, and folders that are not
ExportOrder order_of(const ExportChoice& choice, const scene::Stamps& stamps,
                     const scene::Scene& scene, sun::Instant utc, const sun::Zone& zone);
/// The files that an order writes, its own first.
std::vector<std::string> files_of(const ExportOrder& order);
/// A file in a folder. @param folder  empty: the working folder; "~/" is the user's home
std::string path_in(const std::string& folder, const std::string& name);
/// The command line that makes the file.
std::string command_of(const ExportOrder& order);

}  // namespace relevo::viewer
