// Volumes by bundles of parallel rays against closed forms.
#include <cmath>
#include <numbers>

#include "tests/laws/rays.hpp"

namespace raymo::laws {
namespace {

struct Known {
    ModelPtr model;
    double volume;
};

Known known(int which, Random& random) {
    constexpr double kPi = std::numbers::pi;
    const double r = random.uniform(0.5, 3), h = random.uniform(0.5, 4);
    switch (which) {
        case 0:
            return {block({r, h, 2}), 2 * r * h};
        case 1:
            return {sphere(r), 4 * kPi / 3 * r * r * r};
        case 2:
            return {cylinder(r, h), kPi * r * r * h};
        case 3:
            return {cone(r, h, 2), 2 * kPi / 3 * (r * r + r * h + h * h)};
        case 4:
            return {torus(r + h, r), 2 * kPi * kPi * (r + h) * r * r};
        // a quarter of a sphere by half-spaces
        case 5:
            return {meet(sphere(r), meet(halfspace({1, 0, 0}, 0), halfspace({0, 1, 0}, 0))),
                    kPi / 3 * r * r * r};
        case 6:
            return {quadric({1 / (r * r), 0, 0, 0, 0, 1, 0, 0, 0, 0, 1 / (h * h), 0, 0, 0, 0, -1}),
                    4 * kPi / 3 * r * h};
        // a ball with a hole right through: what is left depends on its length only (the napkin ring)
        case 7: {
            const double big = 3, hole = random.uniform(0.5, 2.5);
            const double length = 2 * std::sqrt(big * big - hole * hole);
            return {cut(sphere(big), cylinder(hole, 10, true)), kPi / 6 * length * length * length};
        }
        // two crossing cylinders share 16/3 r^3 [Steinmetz]
        default: {
            const ModelPtr pipe = cylinder(r, 20, true);
            return {meet(pipe, moved(pipe, rotation({1, 0, 0}, 90))), 16.0 / 3 * r * r * r};
        }
    }
}

void volumes(std::uint64_t rays, Random& random, Tally& tally) {
    const int cells = 100;
    for (int which = 0; tally.rays < rays || which < 9; ++which) {
        const Known solid = known(which % 9, random);
        const Affine map = random_map(random, 3);
        Traced traced(moved(solid.model, map));
        const Aabb box = traced.scene().bounds();
        const double reach = 0.5 * norm(box.size());
        const Vec3 d = random.direction();
        Vec3 s, t;
        make_frame(d, s, t);
        double sum = 0.0;
        for (int i = 0; i < cells; ++i) {
            for (int j = 0; j < cells; ++j) {
                const double x = reach * (2.0 * (i + random.uniform(0, 1)) / cells - 1.0);
                const double y = reach * (2.0 * (j + random.uniform(0, 1)) / cells - 1.0);
                for (const auto& span : traced.spans({box.centre() + s * x + t * y, d})) {
                    sum += span.exit.t - span.enter.t;
                }
                ++tally.rays;
            }
        }
        const double found = sum * 4.0 * reach * reach / (1.0 * cells * cells);
        const double exact = solid.volume * std::fabs(determinant(map.linear));
        // Jittered sampling: the error is that of the cells on the outline, of which there are about 4 cells' rows; five
        // standard deviations, and no more than a twentieth for thin solids.
        const double spread = 4.0 * reach * reach / (cells * std::sqrt(1.0 * cells)) * reach;
        ++tally.samples;
        if (!(std::fabs(found - exact) <= std::min(1.5 * spread, 0.05 * exact + 0.2 * spread))) {
            char line[100];
            std::snprintf(line, sizeof line, "volume %g instead of %g, spread %g: ", found, exact,
                          spread);
            tally.exception(line + text(*traced.model()));
        }
    }
}

}  // namespace

void add_volume_laws(std::vector<Law>& laws) {
    laws.push_back({"volumes by ray bundles are the closed forms", 2000000, volumes});
}

}  // namespace raymo::laws
