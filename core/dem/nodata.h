#pragma once

#include <optional>
#include <span>

namespace relevo::dem {

/// What a sample of stored numbers says about holes that the file does not declare.
struct Undeclared {
    std::optional<double> nodata;  ///< the stored value that marks holes
    bool beyond = false;           ///< some are further from zero than no_height_beyond()
};

/// Numbers further from zero are no heights in any unit: 10 000 km. In stored numbers.
/// @param metres  in one step of the stored number
double no_height_beyond(double metres);

/// Looks for a value that marks holes among those that programs write for that: -32768, -32767,
/// -9999, -99999, -999999, 32767, 65535, and 0.
///
/// One is taken where it occurs and nothing else is near: no other stored number within 500 of it
/// (a sea floor at -9999 m has neighbours); for 0, all else at least 100 m from it on one side (a
/// coast has all heights down to 0, and so has a river plain). Never more than one: the first of
/// that order which occurs.
/// @param stored  of at least some hundred posts; NaN and infinities do not count
/// @param metres  in one step of the stored number
Undeclared find_undeclared(std::span<const double> stored, double metres);

}  // namespace relevo::dem
