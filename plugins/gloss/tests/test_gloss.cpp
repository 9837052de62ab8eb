#include <algorithm>
#include <cmath>

#include <fmt/format.h>

#include "support/gpu_snippet.h"
#include "support/support.h"

namespace relevo::test_gloss {
namespace {

TEST(Gloss, TheMapMultipliesTheHighlight) {
    std::vector<double> errors;
    for (const double amount : {0.0, 0.4, 1.0}) {
        test::GpuSnippet gpu("gloss");
        gpu.values().set("gloss.amount", fmt::format("{}", amount));
        const auto results = gpu.run(
            "Surface s;\n"
            "s.gloss = float(x) / 100.0;\n"
            "s.specular = vec3(0.1, 0.5, 1.0);\n"
            "gloss_on_material(s);\n"
            "result = vec4(s.specular, 0.0);",
            101, 1);
        for (int x = 0; x <= 100; ++x) {
            const double factor = 1 - amount + amount * x / 100.0;
            const glm::vec4 found = results[static_cast<std::size_t>(x)];
            errors.push_back(std::abs(found.r - 0.1 * factor));
            errors.push_back(std::abs(found.g - 0.5 * factor));
            errors.push_back(std::abs(found.b - 1.0 * factor));
        }
    }
    test::print_accuracy("gloss, GPU against double", errors, "", 1e-3);
    EXPECT_LT(*std::max_element(errors.begin(), errors.end()), 1e-3);
}

}  // namespace
}  // namespace relevo::test_gloss
