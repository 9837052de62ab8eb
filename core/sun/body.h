#pragma once

namespace relevo::sun {

/// What a position, a table of positions or a rule of rising is of.
enum class Body { Sun, Moon };

/// "sun", "moon".
constexpr const char* name_of(Body body) {
    return body == Body::Sun ? "sun" : "moon";
}

}  // namespace relevo::sun
