#pragma once

#include <array>
#include <cstdint>
#include <optional>
#include <string>
#include <vector>

#include <glm/vec2.hpp>

#include "base/array2d.h"
#include "base/window.h"
#include "dem/interpret.h"

// Pixels of an image file. Inside of the layer only.

namespace relevo::overlay {

/// An image of red, green and blue or of a palette, as premultiplied 0xAABBGGRR. Serves one thread
/// at a time.
class PhotoPixels {
  public:
    /// @param dataset  of a PhotoKind that is drawn; must outlive this
    /// @param palette  of the first band, as Photo::open_classes(); empty: as the file says
    PhotoPixels(const std::string& path, void* dataset, std::vector<std::uint32_t> palette = {});

    int columns() const { return columns_; }
    int rows() const { return rows_; }

    /// A part of the image at a coarser resolution.
    struct Part {
        Array2d<std::uint32_t> rgba;
        glm::dvec2 first{0};    ///< the image's pixels before its own first one
        glm::dvec2 reduced{1};  ///< pixels of the image to one of its own, along each axis
    };
    /// @param first, end  pixels to include, clamped to the image
    /// @param most        pixels to one of the part, at most; 1 and more
    /// @throws Error (BadInput) for a damaged file
    Part read(const glm::dvec2& first, const glm::dvec2& end, double most);

  private:
    /// A resolution that the file has.
    struct Level {
        std::array<void*, 3> bands{};  // of a palette the first alone
        void* mask = nullptr;          // alpha or a mask of 8 bits; null: none
        int columns = 0, rows = 0;
    };
    Level level_of(int overview) const;
    const Level& level_for(double most) const;
    Part read_level(const Level& level, const Window& window, int times);
    void read_rows(const Level& level, const Window& rows, std::vector<std::uint32_t>& rgba);
    void read_bytes(void* band, const Window& rows, std::uint8_t* bytes);
    std::uint32_t texel(const std::uint8_t* bytes, std::size_t at, std::size_t count,
                        bool masked) const;
    void keep_reduced();

    std::string path_;
    void* dataset_;
    int columns_, rows_;
    std::array<int, 3> numbers_{1, 2, 3};  // of the bands
    int alpha_ = 0;                        // the number of its band; 0: none
    bool has_mask_ = false;                // of the dataset
    std::array<std::optional<int>, 3> nodata_{};
    std::vector<std::uint32_t> palette_;  // empty: none
    bool is_classes_;                     // the palette is not the file's own
    std::vector<Level> levels_;           // finest first
    std::optional<Part> reduced_;         // of a large file without overviews
};

}  // namespace relevo::overlay
