// Corners of more than three faces: the volumes of rounded polyhedra by Steiner's formula.
#include "raymo/blends/test_polyhedra.hpp"

namespace raymo::blends {
namespace {

using namespace test;

/// The volume of all that is no farther than r from a polyhedron about the z axis: by its slices, whose areas are found by
/// rays from the axis within [0, sector], so many times. The pieces in which a slice's outline is analytic end where the
/// faces' contacts and the balls' arcs between two contacts are met.
double measured(Traced& solid, const Polyhedron& inner, double r, double sector) {
    // A path between contacts: from `at` + r a to `to` + r b, straight or an arc about `at`.
    struct Path {
        Vec3 at, to, a, b;
    };
    std::vector<Path> paths;
    std::vector<double> levels;
    double top = -1e9;
    double bottom = 1e9;
    for (const Vec3 p : inner.points) {
        top = std::max(top, p.z + r);
        bottom = std::min(bottom, p.z - r);
    }
    for (const Polyhedron::Edge& edge : inner.edges()) {
        const Vec3 p = inner.points[edge.from];
        const Vec3 q = inner.points[edge.to];
        for (const Vec3 n : {edge.left, edge.right}) {
            paths.push_back({p, q, n, n});
            levels.push_back(p.z + r * n.z);
            levels.push_back(q.z + r * n.z);
        }
        for (const Vec3 v : {p, q}) {
            paths.push_back({v, v, edge.left, edge.right});
            // Where the arc is highest or lowest.
            const Vec3 along = unit(cross(edge.left, edge.right));
            const Vec3 up = unit(Vec3{0, 0, 1} - along * along.z);
            levels.push_back(v.z + r * up.z);
            levels.push_back(v.z - r * up.z);
        }
    }
    const auto sorted = [](std::vector<double> values, double lo, double hi) {
        std::erase_if(values, [&](double x) { return !(x > lo && x < hi); });
        values.push_back(lo);
        values.push_back(hi);
        std::sort(values.begin(), values.end());
        const auto is_same = [&](double a, double b) { return b - a < 1e-9 * (hi - lo); };
        values.erase(std::unique(values.begin(), values.end(), is_same), values.end());
        return values;
    };
    const auto area = [&](double z) {
        std::vector<double> turns;
        const auto add = [&](Vec3 p) { turns.push_back(std::atan2(p.y, p.x)); };
        for (const Path& path : paths) {
            if (path.a == path.b) {
                const double from = path.at.z + r * path.a.z;
                const double to = path.to.z + r * path.a.z;
                if ((from < z) != (to < z)) {
                    const double s = (z - from) / (to - from);
                    add(path.at * (1 - s) + path.to * s + path.a * r);
                }
                continue;
            }
            // u cos t + w sin t, at an angle t from `a` on to `b`.
            const Vec3 u = path.a;
            const Vec3 w = unit(path.b - u * dot(path.b, u));
            const double most = std::hypot(u.z, w.z) * r;
            if (!(std::fabs(z - path.at.z) < most)) continue;
            const double middle = std::atan2(w.z, u.z);
            const double half = std::acos((z - path.at.z) / most);
            for (const double t : {middle - half, middle + half})
                add(path.at + (u * std::cos(t) + w * std::sin(t)) * r);
        }
        const std::vector<double> breaks = sorted(turns, 0.0, sector);
        double sum = 0.0;
        for (std::size_t i = 1; i < breaks.size(); ++i) {
            sum += integral(breaks[i - 1], breaks[i], [&](double turn) {
                const auto& spans = solid.along({0, 0, z}, {std::cos(turn), std::sin(turn), 0});
                const double out = spans.empty() ? 0.0 : spans.back().exit.t;
                return 0.5 * out * out;
            });
        }
        return sum;
    };
    const std::vector<double> breaks = sorted(levels, bottom, top);
    double sum = 0.0;
    for (std::size_t i = 1; i < breaks.size(); ++i) sum += integral(breaks[i - 1], breaks[i], area);
    return sum * 2.0 * kPi / sector;
}

/// A pyramid by its corners, the tip last.
Polyhedron pointed(const std::vector<Vec2>& base, double z, double high) {
    Polyhedron out;
    const std::size_t n = base.size();
    std::vector<std::size_t> floor;
    for (std::size_t i = 0; i < n; ++i) {
        out.points.push_back({base[i].x, base[i].y, z});
        out.faces.push_back({i, (i + 1) % n, n});
        floor.insert(floor.begin(), i);
    }
    out.points.push_back({0, 0, high});
    out.faces.push_back(floor);
    return out;
}

TEST_CASE("corners: the volume of rounded regular pyramids") {
    const double r = 0.6, wide = 3.0, high = 4.0;
    for (const int count : {4, 5, 6, 8}) {
        CAPTURE(count);
        const std::vector<Vec2> base = regular(count, wide);
        const Polyhedron sharp = pointed(base, 0.0, high);
        // The ball that touches all faces shrinks to its centre, and all is similar about that.
        double area = 0.0;
        for (const auto& face : sharp.faces) area += 0.5 * norm(sharp.area(face));
        const double most = 3.0 * sharp.volume() / area;
        const double k = 1.0 - r / most;
        Polyhedron inner = sharp;
        for (Vec3& p : inner.points) p = Vec3{0, 0, most} + (p - Vec3{0, 0, most}) * k;
        Traced solid(blended(pyramid(base, high), Edges::convex, ball(r),
                             static_cast<std::size_t>(2 * count)));
        CHECK(measured(solid, inner, r, kPi / count) == near(inner.volume_around(r)));
    }
}

TEST_CASE("corners: the volume of a rounded octahedron") {
    const double r = 0.7, wide = 3.0;
    std::vector<Plane> planes;
    for (const double x : {-1.0, 1.0}) {
        for (const double y : {-1.0, 1.0}) {
            for (const double z : {-1.0, 1.0})
                planes.push_back({unit({x, y, z}), wide / std::sqrt(3.0)});
        }
    }
    // With |x| + |y| + |z| <= s for the centres.
    const double s = wide - r * std::sqrt(3.0);
    const double expected = 4.0 / 3.0 * s * s * s + 4.0 * std::sqrt(3.0) * s * s * r +
                            6.0 * std::sqrt(2.0) * s * std::acos(1.0 / 3.0) * r * r +
                            4.0 / 3.0 * kPi * r * r * r;
    Polyhedron inner;
    inner.points = {{s, 0, 0}, {0, s, 0}, {-s, 0, 0}, {0, -s, 0}, {0, 0, s}, {0, 0, -s}};
    for (std::size_t i = 0; i < 4; ++i) {
        inner.faces.push_back({i, (i + 1) % 4, 4});
        inner.faces.push_back({(i + 1) % 4, i, 5});
    }
    CHECK(inner.volume_around(r) == near(expected));
    Traced solid(blended(within(planes, 4), Edges::convex, ball(r), 12));
    CHECK(measured(solid, inner, r, kPi / 4) == near(expected));
}

TEST_CASE("corners: the volume of a rounded pyramid over a rectangle, with two balls in its tip") {
    const double r = 0.5, high = 4.0;
    for (const double wide : {3.0, 2.001, 2.0 + 1e-9}) {
        CAPTURE(wide);
        const double deep = 2.0;
        // Half the sides of the centres' floor, and of their ridge.
        const auto inset = [&](double side, double z) {
            return side * (1.0 - z / high) - r * std::hypot(1.0, side / high);
        };
        const double x = inset(wide, r);
        const double y = inset(deep, r);
        const double ridge = high * (1.0 - r * std::hypot(1.0 / deep, 1.0 / high));
        const double end = inset(wide, ridge);
        CHECK(end > 0.0);
        Polyhedron inner;
        inner.points = {{-x, -y, r}, {x, -y, r},       {x, y, r},
                        {-x, y, r},  {-end, 0, ridge}, {end, 0, ridge}};
        inner.faces = {{3, 2, 1, 0}, {0, 1, 5, 4}, {1, 2, 5}, {2, 3, 4, 5}, {3, 0, 4}};
        const std::vector<Vec2> base{{-wide, -deep}, {wide, -deep}, {wide, deep}, {-wide, deep}};
        Traced solid(blended(pyramid(base, high), Edges::convex, ball(r), 8));
        CHECK(measured(solid, inner, r, kPi / 2) == near(inner.volume_around(r)));
    }
}

}  // namespace
}  // namespace raymo::blends
