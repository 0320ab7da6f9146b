#include "raymo/csg/model.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <thread>
#include <vector>

namespace raymo::csg {
namespace {

std::uint32_t index_of(std::string_view name) {
    const auto rows = solids::inventory();
    for (std::uint32_t i = 0; i < rows.size(); ++i) {
        if (rows[i].schema->name == name) return i;
    }
    return 0;
}

Solid block(Vec3 size, bool centred = false) {
    return primitive(index_of("block"), std::vector<solids::Argument>{size, centred}).value();
}
Solid sphere(double r) {
    return primitive(index_of("sphere"), std::vector<solids::Argument>{r}).value();
}
Solid halfspace(Vec3 n, double offset) {
    return primitive(index_of("halfspace"), std::vector<solids::Argument>{n, offset}).value();
}

bool near(const Aabb& a, const Aabb& b) {
    return max_norm(a.lo - b.lo) < 1e-12 && max_norm(a.hi - b.hi) < 1e-12;
}

TEST_CASE("model: handles share nodes, and nodes live as long as a handle") {
    Solid a = sphere(2);
    const Solid copy = a;
    CHECK(copy == a);
    CHECK(&copy.node() == &a.node());
    const Solid both = boolean(Op::unite, {a, copy});
    a = Solid();
    CHECK_FALSE(static_cast<bool>(a));
    CHECK(as_boolean(both.node()).operands[0] == copy);
    CHECK(as_leaf(copy.node()).primitive == index_of("sphere"));
    Solid moved = std::move(a);
    moved = copy;
    moved = *&moved;
    CHECK(moved == copy);
}

TEST_CASE("model: spans, operations and counts are kept") {
    const SourceSpan span{3, 10, 20};
    const Solid leaf = sphere(1);
    const Solid cut = boolean(Op::difference, {leaf, leaf, leaf}, span);
    CHECK(cut.node().kind == NodeKind::boolean);
    CHECK(cut.node().op == Op::difference);
    CHECK(cut.node().span == span);
    CHECK(cut.node().leaf_count == 3.0);
    CHECK(cut.node().node_count == 4.0);
    const Solid painted = paint(cut, 7, span);
    CHECK(as_paint(painted.node()).material == 7);
    CHECK(painted.node().leaf_count == 3.0);
    // Sharing is counted as if it were copied: 2^200 leaves in 200 nodes.
    Solid many = leaf;
    for (int i = 0; i < 200; ++i) many = boolean(Op::unite, {many, many});
    CHECK(many.node().leaf_count == std::ldexp(1.0, 200));
}

TEST_CASE("model: chains of a million nodes are taken down without recursion") {
    Solid chain = sphere(1);
    for (int i = 0; i < 1000000; ++i) {
        switch (i % 3) {
            case 0:
                chain = transform(chain, translation({1, 0, 0})).value();
                break;
            case 1:
                chain = paint(chain, 1);
                break;
            default:
                chain = boolean(Op::unite, {chain, sphere(1)});
        }
    }
    CHECK(chain.node().node_count > 1e6);
    const Aabb box = bounds(chain);
    CHECK(box.lo.x == 0.0);  // the last ball, moved once
    CHECK(box.hi.x == doctest::Approx(333335));
    chain = Solid();
    CHECK_FALSE(static_cast<bool>(chain));
}

TEST_CASE("model: handles may be copied in several threads") {
    const Solid shared = boolean(Op::unite, {sphere(1), sphere(2)});
    std::vector<std::thread> threads;
    for (int i = 0; i < 4; ++i) {
        threads.emplace_back([&shared] {
            std::vector<Solid> copies;
            for (int k = 0; k < 10000; ++k) {
                copies.push_back(shared);
                if (k % 100 == 99) copies.clear();
            }
        });
    }
    for (std::thread& thread : threads) thread.join();
    CHECK(shared.node().references.load() == 1);
}

TEST_CASE("model: maps that can not be undone are refused") {
    CHECK(transform(sphere(1), scaling({1, 0, 1})).error().code == ErrorCode::singular);
    CHECK(transform(sphere(1), translation({std::nan(""), 0, 0})).error().code ==
          ErrorCode::singular);
    CHECK(transform(sphere(1), scaling({1, -1e-9, 1})).has_value());
}

TEST_CASE("model: what stands at the origin and has one owner is moved within its own node") {
    const Affine turn = rotation({0, 0, 1}, 30.0);
    const SourceSpan span{0, 3, 9};
    const auto moved = [&](Solid s, Vec3 by) {
        return transform(std::move(s), translation(by), span).value();
    };
    const Solid leaf = moved(sphere(2), {1, 2, 3});
    CHECK(leaf.node().kind == NodeKind::leaf);
    CHECK(as_leaf(leaf.node()).solid.to_object.offset == Vec3{1, 2, 3});

    const Solid turned = moved(transform(block({1, 2, 3}), turn).value(), {4, 5, 6});
    CHECK(turned.node().kind == NodeKind::transform);
    CHECK(turned.node().span == span);
    CHECK(as_transform(turned.node()).map == translation({4, 5, 6}) * turn);
    CHECK(as_transform(turned.node()).child.node().kind == NodeKind::leaf);

    // What stands elsewhere already, has another owner, or is turned keeps its node.
    const Solid twice = moved(moved(sphere(2), {1, 2, 3}), {0.1, 0.2, 0.3});
    CHECK(twice.node().kind == NodeKind::transform);
    CHECK(as_transform(twice.node()).map.offset == Vec3{0.1, 0.2, 0.3});
    const Solid owned = sphere(2);
    const Solid other = moved(owned, {1, 2, 3});
    CHECK(as_leaf(owned.node()).solid.to_object.offset == Vec3{});
    CHECK(as_transform(other.node()).child == owned);
    CHECK(transform(sphere(2), turn).value().node().kind == NodeKind::transform);
    CHECK(near(bounds(other), bounds(leaf)));
}

TEST_CASE("model: a primitive's own errors come through") {
    const auto wrong = primitive(index_of("sphere"), std::vector<solids::Argument>{-1.0});
    REQUIRE_FALSE(wrong.has_value());
    CHECK(wrong.error().message == "sphere: radius must be greater than 0");
    CHECK(wrong.error().label == "this is -1");
    CHECK(wrong.error().argument == 0);
    // So small that its map has no inverse.
    const auto tiny = primitive(index_of("sphere"), std::vector<solids::Argument>{1e-320});
    REQUIRE_FALSE(tiny.has_value());
    CHECK(tiny.error().code == ErrorCode::out_of_range);
}

TEST_CASE("bounds: Booleans of boxes") {
    const Solid a = block({10, 10, 10});
    const Solid b = transform(block({10, 10, 10}), translation({5, 5, 5})).value();
    CHECK(bounds(boolean(Op::unite, {a, b})) == Aabb{{0, 0, 0}, {15, 15, 15}});
    CHECK(bounds(boolean(Op::intersection, {a, b})) == Aabb{{5, 5, 5}, {10, 10, 10}});
    CHECK(bounds(boolean(Op::difference, {a, b})) == Aabb{{0, 0, 0}, {10, 10, 10}});
    const Solid far = transform(a, translation({100, 0, 0})).value();
    CHECK(bounds(boolean(Op::intersection, {a, far})).empty());
    CHECK(bounds(boolean(Op::unite, {boolean(Op::intersection, {a, far}), b})) == bounds(b));
    CHECK(bounds(boolean(Op::intersection, {a, far, b})).empty());
}

TEST_CASE("bounds: a union is not stretched by operands that are nothing") {
    const Solid a = block({1, 1, 1});
    const auto shifted = [](const Solid& s, double by) {
        return transform(s, translation({by, 0, 0})).value();
    };
    // Blocks that do not meet: an overlap with its sides exchanged, at places far from 0.
    const auto nothing = [&](double at) {
        return boolean(Op::intersection, {shifted(a, at), shifted(a, at + 50)});
    };
    Solid gone = boolean(Op::unite, {nothing(0), nothing(100), nothing(-300)});
    Solid some = boolean(Op::unite, {nothing(100), a, shifted(nothing(-300), -7)});
    CHECK(bounds(gone).empty());
    CHECK(bounds(some) == bounds(a));
    CHECK(bounds(boolean(Op::difference, {gone, a})).empty());
    CHECK(bounds(boolean(Op::intersection, {a, gone})).empty());
    // The same by nodes, as for graphs with very many paths.
    const Solid same = transform(a, {}).value();
    Solid many = same;
    for (int i = 0; i < 40; ++i) {
        gone = boolean(Op::unite, {gone, shifted(gone, 1)});
        many = boolean(Op::unite, {many, many});
    }
    CHECK(bounds(gone).empty());
    CHECK(bounds(boolean(Op::unite, {gone, many, shifted(gone, 1e6)})) == bounds(a));
}

TEST_CASE("bounds: leaves are exact under their whole map") {
    // A ball turned is the same ball; boxes of turned boxes would grow.
    const Solid turned = transform(transform(sphere(2), rotation({0, 0, 1}, 45)).value(),
                                   rotation(unit({1, 1, 0}), 45))
                             .value();
    CHECK(near(bounds(turned), {{-2, -2, -2}, {2, 2, 2}}));
    // A mirror and a scale, twice used under different maps.
    const Solid leg = block({1, 2, 3});
    const Solid both = boolean(
        Op::unite, {transform(leg, reflection({1, 0, 0})).value(),
                    transform(paint(leg, 1), translation({4, 0, 0}) * scaling({2, 1, 1})).value()});
    CHECK(bounds(both) == Aabb{{-1, 0, 0}, {6, 2, 3}});
}

TEST_CASE("bounds: half-spaces are infinite until they are cut") {
    const Solid half = halfspace({0, 0, 1}, 4);
    CHECK_FALSE(bounds(half).bounded());
    CHECK(bounds(half).hi.z == 4);
    CHECK(bounds(boolean(Op::intersection, {block({10, 10, 10}), half})) ==
          Aabb{{0, 0, 0}, {10, 10, 4}});
    CHECK(bounds(boolean(Op::difference, {block({10, 10, 10}), half})).bounded());
}

TEST_CASE("bounds: shared graphs with very many paths take one visit for each node") {
    Solid many = block({1, 1, 1});
    double step = 1.0;
    for (int i = 0; i < 60; ++i) {
        many = boolean(Op::unite, {many, transform(many, translation({step, 0, 0})).value()});
        step *= 2.0;
    }
    CHECK(bounds(many) == Aabb{{0, 0, 0}, {std::ldexp(1.0, 60), 1, 1}});
}

}  // namespace
}  // namespace raymo::csg
