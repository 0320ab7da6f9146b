// Models and rays for the laws: the general, and the awkward.
#pragma once

#include <cmath>

#include "raymo/math/ray.hpp"
#include "tests/laws/judge.hpp"

namespace raymo::laws {

/// A ray and how well its answers can be known (kTight or kLoose).
struct AimedRay {
    Ray ray;
    double rounding;
};

/// Any ray through the ball of radius `size` about the origin, with a direction of any length.
inline AimedRay general_ray(Random& random, double size) {
    const Vec3 target = random.in_cube(0.6 * size);
    const Vec3 d = random.direction();
    const double speed = std::exp(random.uniform(-3, 3)) * size;
    return {{target - d * (size * random.uniform(-1, 4)), d * speed}, kTight};
}

/// A ray along an axis or a diagonal of planes through points of a grid: it runs along the faces, edges and generators of
/// models whose sizes are multiples of `step`, or hits their edges and corners.
inline AimedRay aimed_ray(Random& random, double size, double step) {
    const auto grid = [&] {
        const int n = static_cast<int>(size / step) + 1;
        return step * (random.below(2 * n + 1) - n);
    };
    const Vec3 p{grid(), grid(), grid()};
    Vec3 d;
    switch (random.below(3)) {
        case 0:
            d = random.axis();
            break;
        case 1:
            d = random.axis() + random.axis() * 0.5 + random.axis();
            break;
        default:
            d = Vec3{grid(), grid(), grid()} - p;
    }
    if (!(max_norm(d) > 0.0)) d = {1, 0, 0};
    return {{p - d * random.uniform(0, 3), d}, kLoose};
}

inline AimedRay any_ray(Random& random, double size, double step) {
    return random.chance(0.5) ? general_ray(random, size) : aimed_ray(random, size, step);
}

/// An invertible map with a translation of at most `reach`: turned, scaled, mirrored, skewed or all of these.
inline Affine random_map(Random& random, double reach) {
    Affine map = translation(random.in_cube(reach));
    const int kinds = 1 + random.below(31);
    if ((kinds & 1) != 0) map = map * rotation(random.direction(), random.uniform(0, 360));
    if ((kinds & 2) != 0) map = map * rotation(random.axis(), 90.0 * random.below(4));
    if ((kinds & 4) != 0) {
        map =
            map * scaling({random.uniform(0.3, 2), random.uniform(0.3, 2), random.uniform(0.3, 2)});
    }
    if ((kinds & 8) != 0)
        map = map * reflection(random.chance(0.5) ? random.axis() : random.direction());
    if ((kinds & 16) != 0) {
        Affine skew;
        skew.linear.row[static_cast<std::size_t>(random.below(3))] += random.in_cube(0.4);
        map = map * skew;
    }
    return map;
}

/// The first so many kinds of grid_leaf: convex ones, ones that packets compute side by side, all.
inline constexpr int kConvexLeaves = 5, kLaneLeaves = 8, kAllLeaves = 9;

/// A swept or turned contour, or a swept ball, of that size.
[[nodiscard]] ModelPtr grid_sweep(Random& random);

/// A smoothed box or a cushion of that size, with flat faces or without.
[[nodiscard]] ModelPtr grid_smooth(Random& random);

/// A primitive of size about 1..6 with sizes and places on the half-integer grid, so that faces often coincide.
inline ModelPtr grid_leaf(Random& random, int kinds = kAllLeaves) {
    const auto n = [&](int most) { return 0.5 * (1 + random.below(2 * most)); };
    ModelPtr leaf;
    switch (random.below(kinds)) {
        case 0:
        case 1:
            leaf = block({n(4), n(4), n(4)}, random.chance(0.3));
            break;
        case 2:
            leaf = sphere(n(3));
            break;
        case 3:
            leaf = cylinder(n(2), n(4), random.chance(0.3));
            break;
        case 4:
            leaf = cone(n(3), random.chance(0.5) ? 0.0 : n(3), n(4), random.chance(0.3));
            break;
        case 5:
            leaf = torus(n(2), n(2));
            break;
        case 6:
        case 7:
            leaf = grid_sweep(random);
            break;
        default: {
            if (random.chance(0.5)) {
                leaf = grid_smooth(random);
                break;
            }
            // an ellipsoid
            const double a = n(3), b = n(3), c = n(3);
            leaf = quadric(
                {1 / (a * a), 0, 0, 0, 0, 1 / (b * b), 0, 0, 0, 0, 1 / (c * c), 0, 0, 0, 0, -1});
        }
    }
    if (random.chance(0.6)) {
        leaf = moved(leaf, Vec3{0.5 * random.below(9) - 2, 0.5 * random.below(9) - 2,
                                0.5 * random.below(9) - 2});
    }
    if (random.chance(0.15)) leaf = moved(leaf, rotation(random.axis(), 90.0 * random.below(4)));
    if (random.chance(0.15)) leaf = moved(leaf, random_map(random, 2));
    return leaf;
}

/// A bounded Boolean of up to 2^depth leaves.
inline ModelPtr grid_tree(Random& random, int depth) {
    if (depth == 0 || random.chance(0.15)) return grid_leaf(random);
    const ModelPtr a = grid_tree(random, depth - 1);
    // Now and then the same solid twice, or a half-space.
    const ModelPtr b = random.chance(0.1) ? a : grid_tree(random, depth - 1);
    ModelPtr tree;
    switch (random.below(4)) {
        case 0:
            tree = meet(a, b);
            break;
        case 1:
            tree = join(a, b);
            break;
        default:
            tree = cut(a, b);
    }
    if (random.chance(0.1)) {
        const ModelPtr half = halfspace(random.chance(0.5) ? random.axis() : random.direction(),
                                        0.5 * random.below(5) - 1);
        tree = random.chance(0.5) ? meet(tree, half) : cut(tree, half);
    }
    if (random.chance(0.1)) tree = moved(tree, random_map(random, 2));
    return tree;
}

/// Differences of many leaves, side by side: of up to 40 that are taken away from one, or from a union.
inline ModelPtr drilled(Random& random) {
    ModelPtr all;
    for (int parts = 1 + random.below(3); parts > 0; --parts) {
        ModelPtr part = grid_leaf(random, random.chance(0.2) ? kLaneLeaves : kConvexLeaves);
        if (random.chance(0.2)) part = meet(part, grid_leaf(random, kLaneLeaves));
        for (int more = random.chance(0.4) ? random.below(5) : 0; more > 0; --more) {
            ModelPtr other = grid_leaf(random, random.chance(0.3) ? kLaneLeaves : kConvexLeaves);
            // A product in the union, now and then.
            if (random.chance(0.2)) other = meet(other, grid_leaf(random, kLaneLeaves));
            if (random.chance(0.2)) other = cut(other, grid_leaf(random, kLaneLeaves));
            part = join(part, other);
        }
        for (int tools = random.below(random.chance(0.5) ? 5 : 40); tools > 0; --tools) {
            ModelPtr tool = grid_leaf(random, kLaneLeaves);
            // Mostly small, so that something is left.
            if (random.chance(0.7)) tool = moved(tool, scaling({0.25, 0.25, 0.25}));
            if (random.chance(0.5)) tool = moved(tool, random.in_cube(2));
            part = cut(part, tool);
        }
        all = all ? join(all, part) : part;
    }
    return all;
}

/// Largest coordinate that grid_tree's models reach, about.
inline constexpr double kGridSize = 12.0;

}  // namespace raymo::laws
