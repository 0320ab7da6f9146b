// Swept and turned contours with sizes and places on the half-integer grid.
#include <array>
#include <cmath>

#include "raymo/curves/samples.hpp"
#include "tests/laws/rays.hpp"

namespace raymo::laws {
namespace {

curves::Curve rectangle(Vec2 lo, Vec2 hi) {
    return curves::closed_polygon(std::array<Vec2, 4>{lo, {hi.x, lo.y}, hi, {lo.x, hi.y}});
}

/// `beside_axis`: with x >= 0, some with an edge on x = 0.
curves::OutlinePtr grid_outline(Random& random, bool beside_axis) {
    const auto n = [&](int most) { return 0.5 * (1 + random.below(2 * most)); };
    curves::Outline outline;
    const double width = n(3), height = n(3);
    const Vec2 lo{beside_axis ? 0.5 * random.below(4) : 0.5 * random.below(5) - 2,
                  0.5 * random.below(5) - 2};
    const Vec2 hi = lo + Vec2{width, height};
    switch (random.below(5)) {
        case 0: {
            const double r = n(2);
            outline.curves.push_back(
                curves::full_circle({lo.x + (beside_axis ? r : 0.0), lo.y}, r));
            break;
        }
        case 1:
            outline.curves.push_back(rectangle(lo, hi));
            break;
        case 2:  // with a hole, a round one or one with edges along those of the outline
            outline.curves.push_back(rectangle(lo, hi));
            if (random.chance(0.5)) {
                outline.curves.push_back(
                    curves::full_circle((lo + hi) * 0.5, 0.25 * std::min(width, height)));
            } else {
                outline.curves.push_back(rectangle(lo + Vec2{0.25 * width, 0.25 * height},
                                                   hi - Vec2{0.25 * width, 0.0}));
            }
            break;
        case 3:
            outline.curves.push_back(curves::closed_polygon(
                std::array<Vec2, 6>{lo,
                                    {hi.x, lo.y},
                                    {hi.x, lo.y + 0.5 * height},
                                    {lo.x + 0.5 * width, lo.y + 0.5 * height},
                                    {lo.x + 0.5 * width, hi.y},
                                    {lo.x, hi.y}}));
            break;
        default:  // bent inwards on one side
            outline.curves.push_back(curves::closed_bspline(std::vector<Vec2>{
                lo, {hi.x, lo.y}, {lo.x + 0.5 * width, lo.y + 0.5 * height}, hi, {lo.x, hi.y}}));
    }
    return std::make_shared<const curves::Outline>(std::move(outline));
}

}  // namespace

ModelPtr grid_sweep(Random& random) {
    const auto n = [&](int most) { return 0.5 * (1 + random.below(2 * most)); };
    switch (random.below(4)) {
        case 0:
            return prism(grid_outline(random, false), n(4), random.chance(0.3));
        case 1:
            return conic(grid_outline(random, false), n(4), 0.5 * random.below(4));
        case 2: {
            constexpr std::array<double, 4> kAngles{360.0, 90.0, 180.0, 270.0};
            return revolve(
                grid_outline(random, true),
                random.chance(0.5) ? 360.0 : kAngles[static_cast<std::size_t>(random.below(4))]);
        }
        default: {
            std::vector<double> control;
            const double radius = n(2);
            const bool straight = random.chance(0.4);
            const Vec3 end{n(3), 0.5 * random.below(3), 0.5 * random.below(3)};
            for (int i = 0; i < 4; ++i) {
                const double part = i / 3.0;
                const Vec3 at =
                    straight ? end * part : Vec3{n(3), n(2), n(2)} * static_cast<double>(i > 0);
                control.insert(control.end(), {at.x, at.y, at.z, radius});
            }
            return sweep(std::move(control));
        }
    }
}

}  // namespace raymo::laws
