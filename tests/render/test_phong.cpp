#include <algorithm>
#include <cmath>

#include <fmt/format.h>
#include <glm/geometric.hpp>

#include "base/units.h"
#include "support/gpu_snippet.h"
#include "support/support.h"

namespace relevo::render::test_phong {
namespace {

TEST(Phong, OnTheGpuIsTheReference) {
    // Columns: the sun 0 to 120 degrees from the normal; rows: the eye, -90 to 90 degrees from it
    // in the same plane. Shininess 1 to 1000, the range a material may have.
    test::GpuSnippet gpu("");
    std::vector<double> errors;
    for (const double shininess : {1.0, 8.0, 60.0, 1000.0}) {
        const auto results =
            gpu.run(fmt::format("Surface s;\n"
                                "s.normal = vec3(0.0, 0.0, 1.0);\n"
                                "s.diffuse = vec3(0.5, 0.3, 0.1);\n"
                                "s.specular = vec3(0.2, 0.4, 0.8);\n"
                                "s.shininess = {:.1f};\n"
                                "float sun = radians(float(x)), eye = radians(float(y - 90));\n"
                                "result = vec4(hook_brdf(s, vec3(sin(sun), 0.0, cos(sun)),\n"
                                "                        vec3(sin(eye), 0.0, cos(eye))), 0.0);",
                                shininess),
                    121, 181);
        for (int y = 0; y <= 180; ++y) {
            for (int x = 0; x <= 120; ++x) {
                if (x == 90) continue;  // whether it faces the sun is the last bit of a cosine's
                const double facing = std::max(std::cos(radians(x)), 0.0);
                // The mirrored sun lies as far on the other side of the normal.
                const double away = std::max(std::cos(radians(y - 90.0 + x)), 0.0);
                const double highlight = facing > 0 ? std::pow(away, shininess) : 0;
                const glm::vec4 found = results[static_cast<std::size_t>(y * 121 + x)];
                errors.push_back(std::abs(found.r - (0.5 * facing + 0.2 * highlight)));
                errors.push_back(std::abs(found.g - (0.3 * facing + 0.4 * highlight)));
                errors.push_back(std::abs(found.b - (0.1 * facing + 0.8 * highlight)));
            }
        }
    }
    test::print_accuracy("Phong, GPU against double", errors, "", 1e-3);
    EXPECT_LT(*std::max_element(errors.begin(), errors.end()), 1e-3);
}

}  // namespace
}  // namespace relevo::render::test_phong
