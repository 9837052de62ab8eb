#pragma once

#include <array>
#include <bitset>
#include <cstdint>
#include <filesystem>
#include <string>
#include <vector>

namespace relevo::climate {

/// Classes of a map of land cover, 0 to 255.
using Classes = std::bitset<256>;

/// What the classes of a map of land cover are: shares of the ground that is trees, low plants and
/// ice; what is left is bare.
class LandCoverTable {
  public:
    /// Reads a table's file. Each line is `CLASS,TREES,PLANTS,ICE,name`. Shares are 0 to 1; all
    /// three are `?` if nothing is known of the class. The name is optional. Lines that begin with
    /// # are skipped.
    /// @throws Error (BadInput) `land cover: FILE:LINE: ...`
    static LandCoverTable read(const std::filesystem::path& file);

    /// Names of the tables that the program has: worldcover, nlcd, corine.
    static const std::vector<std::string>& names();
    /// One of them. @throws Error (BadInput) for another name
    static LandCoverTable named(const std::string& name);
    /// The names of those that have all of a map's classes.
    static std::vector<std::string> fitting(const Classes& in_map);

    const Classes& classes() const { return classes_; }
    /// By class from 0: shares of trees (low byte), low plants and ice, 0 to 255. The high byte is
    /// 255, or 0 if nothing is known of the class.
    std::vector<std::uint32_t> texels() const { return {texels_.begin(), texels_.end()}; }

  private:
    Classes classes_;
    std::array<std::uint32_t, 256> texels_{};
};

/// "3, 17, 200", with no more than `most` of them.
std::string text_of(const Classes& classes, int most = 8);

}  // namespace relevo::climate
