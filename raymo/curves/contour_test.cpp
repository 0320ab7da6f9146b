#include "raymo/curves/contour.hpp"

#include <doctest/doctest.h>

#include <cmath>

#include "raymo/curves/build_contour.hpp"

namespace raymo::curves {
namespace {

Contour disc(double r) { return contour_of(*circle(r)); }

std::size_t count_nodes(const Contour& contour) {
    std::size_t nodes = 0;
    visit(contour, [&](const ContourNode&) { ++nodes; });
    return nodes;
}

TEST_CASE(
    "a chain of a million Booleans is visited, mapped, compared and freed without recursion") {
    constexpr std::size_t kMany = 1000000;
    Contour chain = disc(1);
    const Contour other = disc(2);
    for (std::size_t i = 0; i < kMany; ++i) chain = combined(ContourOp::unite, {chain, other});
    CHECK(count_nodes(chain) == kMany + 2);
    CHECK(!is_open(chain));
    const Contour image = mapped(chain, {1, 0, 5, 0, 1, 0});
    CHECK(count_nodes(image) == kMany + 2);
    CHECK(!is_equal(chain, image));
    CHECK(is_equal(image, mapped(chain, {1, 0, 5, 0, 1, 0})));
    std::size_t freed = 0;
    let_go(std::move(chain), [&](const ContourNode&) { ++freed; });
    CHECK(freed == kMany + 1);  // `other` is still held here
}

TEST_CASE("nodes that are reached on 2^100 paths are taken once") {
    Contour sum = disc(1);
    for (int i = 0; i < 100; ++i) sum = combined(ContourOp::difference, {sum, sum});
    CHECK(count_nodes(sum) == 101);
    const Contour image = mapped(sum, {0, -1, 0, 1, 0, 0});
    CHECK(count_nodes(image) == 101);
    CHECK(!is_equal(sum, image));
    CHECK(is_equal(sum, mapped(image, {0, 1, 0, -1, 0, 0})));
    CHECK(bytes_of(sum) < 101 * 200 + 1000);
}

TEST_CASE("outlines keep their pointer through Booleans, and are mapped once") {
    const Contour a = disc(1);
    const Contour b = disc(2);
    const Contour c = combined(ContourOp::unite, {combined(ContourOp::difference, {b, a}),
                                                  combined(ContourOp::intersection, {a, b})});
    std::vector<const Outline*> outlines;
    visit(c, [&](const ContourNode& n) {
        if (n.outline != nullptr) outlines.push_back(n.outline.get());
    });
    CHECK(outlines == std::vector<const Outline*>{b->outline.get(), a->outline.get()});
    CHECK(combined(ContourOp::unite, {a}) == a);
}

TEST_CASE(
    "a contour that is moved keeps its outline; one that is turned as well shares the turned one") {
    const Contour a = disc(1);
    const Contour row = combined(ContourOp::unite, {a, mapped(a, {1, 0, 3, 0, 1, 0.5})});
    CHECK(row->operands[1]->outline == a->outline);
    CHECK(row->operands[1]->at == Vec2{3, 0.5});
    const Affine2 quarter{0, -1, 10, 1, 0, 20};
    const Contour turned = mapped(row, quarter);
    CHECK(turned->operands[0]->outline == turned->operands[1]->outline);
    CHECK(turned->operands[1]->at == quarter({3, 0.5}));
    CHECK(bytes_of_image(row, {1, 0, 7, 0, 1, 0}) < bytes_of(row) - 4 * sizeof(Span2));
    CHECK(bytes_of_image(row, quarter) == bytes_of(row));
    // The same place, however it came there.
    const Contour placed = contour_of(*placed_outline(*row->operands[1]));
    CHECK(placed->at == Vec2{});
    CHECK(is_equal(placed, row->operands[1]));
    CHECK(box_of(placed) == box_of(row->operands[1]));
    CHECK(extent_of(placed) == extent_of(row->operands[1]));
}

TEST_CASE("contours are equal when they are the same Booleans of the same curves") {
    CHECK(is_equal(disc(1), disc(1)));
    CHECK(!is_equal(disc(1), disc(2)));
    const auto pair = [](ContourOp op, double r, double s) {
        return combined(op, {disc(r), disc(s)});
    };
    CHECK(is_equal(pair(ContourOp::unite, 1, 2), pair(ContourOp::unite, 1, 2)));
    CHECK(!is_equal(pair(ContourOp::unite, 1, 2), pair(ContourOp::difference, 1, 2)));
    CHECK(!is_equal(pair(ContourOp::unite, 1, 2), pair(ContourOp::unite, 2, 1)));
}

TEST_CASE("boxes are exact, and follow the Booleans") {
    const Box2 disc_box = box_of(mapped(disc(5), {1, 0, 3, 0, 1, -2}));
    CHECK(max_norm(disc_box.lo - Vec2{-2, -7}) < 1e-14);
    CHECK(max_norm(disc_box.hi - Vec2{8, 3}) < 1e-14);
    // Turned, a circle's extremes lie within its arcs.
    const double c = std::sqrt(0.5);
    const Box2 turned = box_of(mapped(disc(5), {c, -c, 0, c, c, 0}));
    CHECK(max_norm(turned.lo - Vec2{-5, -5}) < 1e-14);
    CHECK(max_norm(turned.hi - Vec2{5, 5}) < 1e-14);
    Outline bump;
    bump.curves.push_back({{cubic({0, 0}, {0, 4}, {3, 4}, {3, 0}), segment({3, 0}, {0, 0})}, true});
    CHECK(box_of(bump).hi == Vec2{3, 3});
    const Contour right = mapped(disc(5), {1, 0, 8, 0, 1, 0});
    CHECK(box_of(combined(ContourOp::unite, {disc(5), right})).hi.x == 13.0);
    CHECK(box_of(combined(ContourOp::intersection, {disc(5), right})).lo.x == 3.0);
    CHECK(box_of(combined(ContourOp::difference, {disc(5), right})).hi.x == 5.0);
    const Contour away = mapped(disc(5), {1, 0, 80, 0, 1, 0});
    CHECK(box_of(combined(ContourOp::intersection, {disc(5), away})).empty());
}

TEST_CASE("a contour is open when one of its curves is") {
    const Contour open = contour_of(*arc_curve(1, 0, 90, {}));
    CHECK(is_open(open));
    CHECK(is_open(combined(ContourOp::unite, {disc(1), open})));
    CHECK(!is_open(disc(1)));
}

}  // namespace
}  // namespace raymo::curves
