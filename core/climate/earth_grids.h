#pragma once

#include <filesystem>
#include <optional>
#include <span>
#include <string>
#include <string_view>
#include <vector>

namespace relevo::climate {

/// Grids of the whole Earth in one file: rows from north to south, columns from 180 degrees west, a
/// cell an area. Cut into bands of latitude, of which each is unpacked when it is first needed.
/// tools/make_climate.py has the file's layout.
class EarthGrids {
  public:
    struct Layer {
        std::string_view name;
        int planes;
        int bits;  ///< of a cell: 1, 8 or 16
    };

    /// @param title   of the file's first line, after "relevo"
    /// @param layers  in the file's order
    /// @throws Error (BadInput) `climate: path: ...` where it is missing or damaged
    EarthGrids(const std::filesystem::path& path, std::string_view title,
               std::span<const Layer> layers);

    int columns(std::size_t layer) const { return grids_[layer].columns; }
    int rows(std::size_t layer) const { return grids_[layer].rows; }
    /// Not safe on several threads at once. @throws Error (BadInput) if the band is damaged
    int cell(std::size_t layer, int plane, int column, int row);

  private:
    /// Where the bands of a grid are, and those that have been unpacked.
    struct Grid {
        int columns = 0, rows = 0, planes = 0, bits = 0, band_rows = 0;
        std::vector<std::string_view> packed;                  // of the file's bytes
        std::vector<std::optional<std::vector<short>>> bands;  // plane after plane, row after row;
                                                               // of single bits eight a value
        std::size_t cells(int band) const;
    };

    [[noreturn]] void damaged(const char* what = "damaged") const;
    std::string_view line(std::string_view& rest) const;
    Grid read_grid(std::string_view line, const Layer& layer) const;
    void read_bands(std::string_view rest);
    std::vector<unsigned char> inflated(std::string_view packed, std::size_t size) const;
    std::vector<short> unpacked(const Grid& grid, int band) const;

    std::string path_, bytes_;
    std::vector<Grid> grids_;
};

}  // namespace relevo::climate
