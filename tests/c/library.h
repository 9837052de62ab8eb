#pragma once

#include <memory>
#include <string>
#include <vector>

#include <relevo/relevo.h>

/// What tests of the C interface share.
namespace relevo::test {

struct CloseHandle {
    void operator()(relevo_dem* dem) const { relevo_dem_close(dem); }
    void operator()(relevo_session* session) const { relevo_close(session); }
};
using DemHandle = std::unique_ptr<relevo_dem, CloseHandle>;
using SessionHandle = std::unique_ptr<relevo_session, CloseHandle>;

/// A struct of the interface with its size.
template <typename T>
T sized() {
    T value{};
    value.size = sizeof value;
    return value;
}

/// Expects RELEVO_RESULT_OK.
void expect_ok(relevo_result result);
/// Expects a code and this message.
void expect_error(relevo_result result, relevo_result code, const std::string& message);

/// The DEM that comes along.
DemHandle open_bundled();
relevo_grid grid_of(relevo_dem* dem);
std::size_t posts_of(relevo_dem* dem);

/// A session on the software device.
SessionHandle open_session(relevo_dem* dem, const std::string& scene);

struct Colours {
    int columns = 0, rows = 0;
    std::vector<std::uint8_t> rgba;
};
Colours draw(relevo_session* session);

}  // namespace relevo::test
