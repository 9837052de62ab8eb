// A module that sets marks with the fault that the environment variable RELEVO_TEST_MARKS names,
// except in its trial.
#include <cmath>
#include <cstdlib>
#include <string>
#include <string_view>
#include <vector>

#include <relevo/plugin.hpp>

namespace {

using namespace relevo::plugin;

class Places : public Instance {
  public:
    explicit Places(const Host& host)
        : table_(host.service<relevo_marks_1>("relevo.marks", 1)), marks_(host) {}

    void prepare() override {
        const char* const given = std::getenv("RELEVO_TEST_MARKS");
        const std::string_view fault = given ? given : "";
        Mark good{.lat_deg = 36.3, .lon_deg = -84.2, .text = "good"};
        Mark mark = good;
        if (fault == "nan") mark.lat_deg = std::nan("");
        if (fault == "latitude") mark.lat_deg = 95;
        if (fault == "longitude") mark.lon_deg = 1e30;
        if (fault == "height") {
            mark.height_of = RELEVO_ABOVE_ZERO;
            mark.height_m = HUGE_VAL;
        }
        if (fault == "rank") mark.rank = std::nan("");
        if (fault == "azimuth") mark.azimuth_deg = std::nan("");
        if (fault == "symbol") mark.symbol = 77;
        if (fault == "kind") mark.height_of = -1;
        if (fault == "utf8") mark.text = "caf\xe9";
        if (fault == "long") mark.text = std::string(2000, 'x');
        if (fault == "many") {
            relevo_mark one{};
            one.size = sizeof one;
            return check(table_.set(table_.self, "places", &one, 10'000'000));
        }
        if (fault == "null") return check(table_.set(table_.self, "places", nullptr, 3));
        if (fault == "list") return marks_.set("huts", std::vector{mark});
        marks_.set("places", std::vector{good, mark});
    }

  private:
    const relevo_marks_1& table_;
    Marks marks_;
};

}  // namespace

RELEVO_PLUGIN("marks", Places)
