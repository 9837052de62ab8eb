#include "session/classic_netcdf.h"

#include <bit>
#include <cstdint>
#include <fstream>
#include <utility>

namespace relevo::test {
namespace {

constexpr double kVoid = 9.969209968386869e36;  // NetCDF's own fill value

/// Big-endian fields of the format.
struct Bytes {
    std::string text;

    void number(std::uint32_t value) {
        for (int shift = 24; shift >= 0; shift -= 8)
            text += static_cast<char>(value >> shift & 0xFF);
    }
    void number(double value) {
        const auto bits = std::bit_cast<std::uint64_t>(value);
        number(static_cast<std::uint32_t>(bits >> 32));
        number(static_cast<std::uint32_t>(bits));
    }
    void padded(const std::string& word) {
        number(static_cast<std::uint32_t>(word.size()));
        text += word;
        text.append((4 - word.size() % 4) % 4, '\0');
    }
};

struct Variable {
    std::string name;
    std::vector<std::uint32_t> dimensions;
    std::vector<std::pair<std::string, std::string>> attributes;
    std::vector<double> values;
};

/// @param begins  of each variable's values in the file
std::string header(const std::vector<std::pair<std::string, std::size_t>>& dimensions,
                   const std::vector<Variable>& variables,
                   const std::vector<std::uint32_t>& begins) {
    constexpr std::uint32_t kDimensions = 10, kVariables = 11, kAttributes = 12, kChar = 2,
                            kDouble = 6;
    Bytes bytes{std::string("CDF\1", 4)};
    bytes.number(0U);  // records
    bytes.number(kDimensions);
    bytes.number(static_cast<std::uint32_t>(dimensions.size()));
    for (const auto& [name, length] : dimensions) {
        bytes.padded(name);
        bytes.number(static_cast<std::uint32_t>(length));
    }
    bytes.number(0U);  // no global attributes
    bytes.number(0U);
    bytes.number(kVariables);
    bytes.number(static_cast<std::uint32_t>(variables.size()));
    for (std::size_t i = 0; i < variables.size(); ++i) {
        const Variable& variable = variables[i];
        bytes.padded(variable.name);
        bytes.number(static_cast<std::uint32_t>(variable.dimensions.size()));
        for (const std::uint32_t dimension : variable.dimensions)
            bytes.number(dimension);
        bytes.number(kAttributes);
        bytes.number(static_cast<std::uint32_t>(variable.attributes.size()));
        for (const auto& [name, value] : variable.attributes) {
            bytes.padded(name);
            bytes.number(kChar);
            bytes.padded(value);
        }
        bytes.number(kDouble);
        bytes.number(static_cast<std::uint32_t>(8 * variable.values.size()));
        bytes.number(begins[i]);
    }
    return bytes.text;
}

}  // namespace

void write_netcdf(const std::string& path, const std::string& time_unit,
                  const std::vector<double>& times, const std::vector<NetcdfVariable>& variables) {
    constexpr int kColumns = 12, kRows = 10;
    std::vector<double> lats, lons;
    for (int row = 0; row < kRows; ++row)
        lats.push_back(49.25 - 0.5 * row);
    for (int column = 0; column < kColumns; ++column)
        lons.push_back(6.25 + 0.5 * column);
    std::vector<Variable> all = {
        {"time", {0}, {{"units", time_unit}}, times},
        {"latitude", {1}, {{"units", "degrees_north"}, {"standard_name", "latitude"}}, lats},
        {"longitude", {2}, {{"units", "degrees_east"}, {"standard_name", "longitude"}}, lons}};
    for (const NetcdfVariable& variable : variables) {
        Variable& one =
            all.emplace_back(Variable{variable.name, {0, 1, 2}, {{"units", variable.unit}}, {}});
        for (const double value : variable.at_times)
            for (int row = 0; row < kRows; ++row)
                for (const double lon : lons)
                    one.values.push_back(variable.is_void && variable.is_void(lon) ? kVoid : value);
    }
    const std::vector<std::pair<std::string, std::size_t>> dimensions = {
        {"time", times.size()}, {"latitude", lats.size()}, {"longitude", lons.size()}};
    std::vector<std::uint32_t> begins(all.size());
    auto at = static_cast<std::uint32_t>(header(dimensions, all, begins).size());
    Bytes values;
    for (std::size_t i = 0; i < all.size(); ++i) {
        begins[i] = at;
        at += static_cast<std::uint32_t>(8 * all[i].values.size());
        for (const double value : all[i].values)
            values.number(value);
    }
    std::ofstream(path, std::ios::binary) << header(dimensions, all, begins) << values.text;
}

}  // namespace relevo::test
