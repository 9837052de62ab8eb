#pragma once

#include <cstdint>
#include <filesystem>
#include <optional>
#include <string>
#include <string_view>
#include <vector>

#include <glm/vec3.hpp>

#include "geo/geodetic.h"

/// The place and summit names that Relevo brings. data/README.md has sources, terms and quality.
namespace relevo::names {

enum class Kind { Place, Summit };

/// A row of the lists. Texts are UTF-8 and belong to the Gazetteer.
struct Entry {
    Kind kind = Kind::Place;
    std::string_view name;
    std::string_view others;   ///< other names, separated by '|'; empty: none
    std::string_view country;  ///< ISO 3166 alpha-2; empty: unknown
    geo::Geodetic place;       ///< height 0
    std::optional<int> size;   ///< inhabitants; of summits the height [m]; nullopt: unknown
    char source = 0;           ///< of summits: a letter of data/README.md
};

/// The ground that searches prefer.
struct Near {
    geo::Geodetic centre;
    double radius_m = 0;  ///< half the diagonal of a DEM
};

/// Both lists, in memory. Reading takes 0.3 s, a search 1 to 6 ms (tests/names/test_gazetteer.cpp).
class Gazetteer {
  public:
    /// @param places  empty: none
    /// @throws Error (BadInput) `names: path: ...` for a file that is missing, damaged or another
    ///     kind of file
    Gazetteer(const std::filesystem::path& places, const std::filesystem::path& summits);
    Gazetteer(const Gazetteer&) = delete;
    Gazetteer& operator=(const Gazetteer&) = delete;
    /// The lists that Relevo brings, read at the first call. Safe on several threads at once.
    /// @throws Error as the constructor, at every call
    static const Gazetteer& shipped();
    /// Summits alone, which are read in a quarter of the time.
    static const Gazetteer& summits();

    /// Entries with a name in which `text` begins a word, by fold(). First those within `near`,
    /// then those with exactly this name, then those that begin with it; among equals the nearest
    /// to its centre, without `near` the largest, where a summit counts as its metres.
    /// @param text  of any script; without a letter or digit nothing is found
    std::vector<const Entry*> find(std::string_view text, const std::optional<Near>& near,
                                   std::size_t most) const;

    /// The place nearest to another one. @returns null: none within the distance
    const Entry* nearest_place(const Near& near) const;
    /// Entries within a distance of a place, in the order of the files.
    std::vector<const Entry*> within(Kind kind, const Near& near) const;

  private:
    struct Hit;
    void read(const std::filesystem::path& path, Kind kind);
    /// @returns false: it is not such a row
    bool add_row(std::string_view row, Kind kind);
    void add_key(std::string_view name);
    std::vector<Hit> hits(const std::string& key) const;

    std::vector<std::string> texts_;    // of the files
    std::vector<Entry> entries_;        // places, then summits
    std::vector<glm::vec3> positions_;  // on a unit sphere
    std::string keys_ = "\n";           // "innsbruck\nparis\n..."
    std::vector<std::uint32_t> key_ends_, key_entries_;
};

}  // namespace relevo::names
