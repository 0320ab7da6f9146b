// Where balls rest in corners of planes: vertices that are as far as the radius from their planes, and a subdivision of the ring.
#include "raymo/blends/inner_corner.hpp"

#include <random>

#include "raymo/blends/test_blends.hpp"

namespace raymo::blends {
namespace {

using namespace test;

/// The planes of the cone from the origin down through a polygon at z = -1, counter-clockwise from above.
std::vector<CornerPlane> cone_over(const std::vector<Vec2>& polygon) {
    std::vector<CornerPlane> out;
    for (std::size_t i = 0; i < polygon.size(); ++i) {
        const Vec2 a = polygon[i];
        const Vec2 b = polygon[(i + 1) % polygon.size()];
        out.push_back({unit(cross(Vec3{a.x, a.y, -1}, Vec3{b.x, b.y, -1})), 0.0});
        if (out.back().normal.z < 0.0) out.back().normal = -out.back().normal;
    }
    return out;
}

/// The inner corner, of which all that must hold has been checked.
InnerCorner checked(const std::vector<Vec2>& polygon, double radius) {
    const std::vector<CornerPlane> planes = cone_over(polygon);
    const Vec2 p = polygon[1];
    const auto inner = inner_corner(planes, {p.x, p.y, -1}, radius, 0.0);
    REQUIRE(inner.has_value());
    std::size_t corners = 0;
    for (const InnerCorner::Vertex& vertex : inner->vertices) {
        CHECK(vertex.planes.size() >= 3);
        corners += vertex.planes.size() - 2;
        for (const CornerPlane& plane : planes)
            CHECK(dot(plane.normal, vertex.at) <= -radius * (1.0 - 1e-9));
        for (const std::size_t i : vertex.planes)
            CHECK(dot(planes[i].normal, vertex.at) == near(-radius));
    }
    // Polygons that fill the ring, with a bridge between each two.
    CHECK(corners == polygon.size() - 2);
    CHECK(inner->bridges.size() == inner->vertices.size() - 1);
    for (const InnerCorner::Bridge& bridge : inner->bridges) {
        for (const std::size_t vertex : bridge.vertices) {
            for (const std::size_t plane : bridge.planes) {
                const auto& has = inner->vertices[vertex].planes;
                CHECK(std::find(has.begin(), has.end(), plane) != has.end());
            }
        }
    }
    for (std::size_t i = 0; i < planes.size(); ++i) {
        for (const std::size_t plane : {i, (i + 1) % planes.size()}) {
            const auto& has = inner->vertices[inner->first[i]].planes;
            CHECK(std::find(has.begin(), has.end(), plane) != has.end());
        }
    }
    return *inner;
}

TEST_CASE("inner corners: regular ones have one ball") {
    for (const int count : {3, 4, 5, 8, 64, 1000}) {
        for (const double wide : {0.05, 1.0, 20.0}) {
            CAPTURE(count);
            CAPTURE(wide);
            std::vector<Vec2> polygon;
            for (int i = 0; i < count; ++i)
                polygon.push_back(
                    {wide * std::cos(2 * kPi * i / count), wide * std::sin(2 * kPi * i / count)});
            const InnerCorner inner = checked(polygon, 2.0);
            REQUIRE(inner.vertices.size() == 1);
            const double slope = wide * std::cos(kPi / count);
            CHECK(inner.vertices[0].at.z == near(-2.0 * std::hypot(1.0, slope) / slope));
        }
    }
}

TEST_CASE("inner corners: over a rectangle two balls and a bridge") {
    const InnerCorner inner = checked({{-2, -1}, {2, -1}, {2, 1}, {-2, 1}}, 1.0);
    REQUIRE(inner.vertices.size() == 2);
    // On the long sides' line: as deep as the ball between these.
    CHECK(inner.vertices[0].at.z == near(-std::sqrt(2.0)));
    CHECK(std::fabs(inner.vertices[0].at.x) == near(2.0 * std::sqrt(2.0) - std::sqrt(5.0)));
}

TEST_CASE("inner corners: a triangle of three bridges in the middle of six planes") {
    // Every second plane is much nearer to the axis.
    std::vector<Vec2> polygon;
    for (int i = 0; i < 3; ++i) {
        for (const double off : {-0.97, 0.97}) {
            const double turn = 2 * kPi * i / 3 + off;
            polygon.push_back({std::cos(turn), std::sin(turn)});
        }
    }
    const InnerCorner inner = checked(polygon, 1.0);
    CHECK(inner.vertices.size() == 4);
    CHECK(inner.bridges.size() == 3);
}

TEST_CASE("inner corners: any polygon, and regular ones that are off by anything") {
    std::mt19937_64 random(4);
    const auto number = [&](double lo, double hi) {
        return std::uniform_real_distribution<double>(lo, hi)(random);
    };
    for (int i = 0; i < 2000; ++i) {
        const int count = 4 + i % 9;
        const double off = std::pow(10.0, number(-17, -0.5));
        std::vector<Vec2> polygon;
        for (int k = 0; k < count; ++k) {
            const double turn = 2 * kPi * (k + number(-off, off)) / count;
            polygon.push_back({2.0 * std::cos(turn) + 0.3 * (i % 2), std::sin(turn)});
        }
        checked(polygon, 0.7);
    }
}

TEST_CASE("inner corners: planes that are no corner have none") {
    // The third plane contains the edge of the first two.
    const std::vector<CornerPlane> flat{{{0, 0, 1}, 0}, {{0, 1, 0}, 0}, {unit({0, 1, 1}), 0}};
    CHECK(!inner_corner(flat, {-1, 0, 0}, 1.0, 0.0).has_value());
    // Seen from the wrong side of their edge.
    const std::vector<CornerPlane> three{{{1, 0, 0}, 0}, {{0, 1, 0}, 0}, {{0, 0, 1}, 0}};
    CHECK(inner_corner(three, {0, 0, -1}, 1.0, 0.0).has_value());
    CHECK(!inner_corner(three, {0, 0, 1}, 1.0, 0.0).has_value());
}

}  // namespace
}  // namespace raymo::blends
