#include "raymo/solids/ray_block.hpp"

#include <doctest/doctest.h>

#include <cmath>
#include <numbers>

#include "raymo/solids/conformance.hpp"
#include "raymo/solids/inventory.hpp"

namespace raymo::solids {
namespace {

using conformance::Random;

LocalRay<double> any_ray(Random& random) {
    const Vec3 through = random.in_cube(0.7);
    Vec3 direction = random.direction();
    // Along an axis, or nearly, as rays of plans and sections are.
    if (random.below(8) == 0) direction[static_cast<int>(random.below(3))] *= 1e-9;
    const Vec3 o = through - direction * (dot(through, direction) / dot(direction, direction));
    const double e = 1e-14;
    const double dd = dot(direction, direction);
    const double from =
        random.below(2) == 0 ? kFromTheBeginning : random.uniform(-1.8, 1.8) / std::sqrt(dd);
    return {o.x, o.y, o.z, direction.x, direction.y, direction.z, e, e, e, dd, from};
}

void put(const LocalRay<double>& ray, std::size_t i, RayBlock& out) {
    const double o[3] = {ray.ox, ray.oy, ray.oz};
    const double d[3] = {ray.dx, ray.dy, ray.dz};
    const double e[3] = {ray.ex, ray.ey, ray.ez};
    for (std::size_t a = 0; a < 3; ++a) {
        out.o[a][i] = o[a];
        out.d[a][i] = d[a];
        out.e[a][i] = e[a];
    }
    out.dd[i] = ray.dd;
    out.from[i] = ray.from;
}

SpanEnd end_of(const SpanBlock::End& ends, std::size_t span, std::size_t ray) {
    return {ends.s[span][ray], ends.error[span][ray],
            static_cast<std::uint16_t>(ends.face[span][ray])};
}

bool same(const SpanEnd& a, const SpanEnd& b) {
    return a.s == b.s && a.error == b.error && a.face == b.face;
}
bool near(const SpanEnd& a, const SpanEnd& b) {
    return a.s == b.s || std::fabs(a.s - b.s) <= a.error + b.error;
}

/// Whether spans tell what `full` does from `from` on. What ends before is not asked for, and what begins before may begin
/// anywhere else before it.
bool agree(const std::vector<Span>& spans, const SpanList& full, double from) {
    std::size_t k = 0;
    for (std::size_t i = 0; i < full.size(); ++i) {
        const Span& truth = full[i];
        if (truth.exit.s + truth.exit.error < from) continue;
        while (k < spans.size() && spans[k].exit.s + spans[k].exit.error < from) ++k;
        const bool may_be_past = truth.exit.s - truth.exit.error < from;
        if (k == spans.size() || !near(spans[k].exit, truth.exit)) {
            if (may_be_past) continue;
            return false;
        }
        const bool begins_before = truth.enter.s - truth.enter.error < from &&
                                   spans[k].enter.s - spans[k].enter.error < from;
        if (!begins_before && !near(spans[k].enter, truth.enter)) return false;
        ++k;
    }
    for (; k < spans.size(); ++k) {
        if (!(spans[k].exit.s - spans[k].exit.error < from)) return false;
    }
    return true;
}

struct Count {
    int rays = 0, left_over = 0, ends = 0;
};

template <class K>
void compare(const K& kernel, Random& random, Count& count) {
    RayBlock block{};
    std::array<LocalRay<double>, 8> rays;
    for (std::size_t i = 0; i < 8; ++i) {
        rays[i] = any_ray(random);
        put(rays[i], i, block);
    }
    const auto asked = static_cast<std::uint32_t>(random.below(256));
    SpanBlock spans;
    kernel.spans(block, asked, spans);
    REQUIRE((spans.left_over & ~asked) == 0);
    PlaceBlock places{};
    std::array<SpanEnd, 8> first{};
    std::uint32_t met = 0;
    for (std::size_t i = 0; i < 8; ++i) {
        std::vector<Span> found;
        for (std::size_t k = 0; k < static_cast<std::size_t>(spans.count); ++k) {
            if ((spans.valid[k] >> i & 1U) != 0)
                found.push_back({end_of(spans.enter, k, i), end_of(spans.exit, k, i)});
        }
        if ((asked >> i & 1U) == 0 || (spans.left_over >> i & 1U) != 0) {
            REQUIRE(found.empty());
            count.left_over += static_cast<int>(asked >> i & 1U);
            continue;
        }
        ++count.rays;
        SpanList alone, full;
        kernel.spans(rays[i], alone);
        kernel.spans_in_full(rays[i], full);
        REQUIRE_FALSE(alone.degenerate());
        REQUIRE_FALSE(alone.touched());
        REQUIRE(alone.size() == found.size());
        for (std::size_t k = 0; k < found.size(); ++k) {
            REQUIRE(same(found[k].enter, alone[k].enter));
            REQUIRE(same(found[k].exit, alone[k].exit));
        }
        if (!full.degenerate() && !full.touched()) REQUIRE(agree(found, full, rays[i].from));
        if (found.empty() || !std::isfinite(found[0].enter.s)) continue;
        met |= 1U << i;
        first[i] = found[0].enter;
        for (int a = 0; a < 3; ++a) {
            const auto axis = static_cast<std::size_t>(a);
            places.p[axis][i] = block.o[axis][i] + first[i].s * block.d[axis][i];
        }
        places.face[i] = static_cast<double>(first[i].face);
    }
    const PlaceBlock asked_about = places;
    kernel.normals(places, met);
    for (std::size_t i = 0; i < 8; ++i) {
        if ((met >> i & 1U) == 0) continue;
        ++count.ends;
        const Vec3 n = kernel.normal(
            {asked_about.p[0][i], asked_about.p[1][i], asked_about.p[2][i]}, first[i].face);
        REQUIRE(n.x == places.p[0][i]);
        REQUIRE(n.y == places.p[1][i]);
        REQUIRE(n.z == places.p[2][i]);
    }
}

}  // namespace

TEST_CASE(
    "a block of rays gets the bits of its rays alone, and answers that agree with the full "
    "method") {
    Inventory::for_each([]<class P>() {
        if constexpr (BlockKernel<typename P::Kernel>) {
            CAPTURE(P::schema().name);
            Count all;
            for (const auto& arguments : P::examples()) {
                const auto placed = P::prepare(arguments);
                REQUIRE(placed.has_value());
                Random random(5);
                for (int i = 0; i < 400; ++i) compare(placed->kernel, random, all);
            }
            CHECK(all.rays > 5000);
            CHECK(all.ends > 1000);
            CHECK(all.left_over < all.rays);
        }
    });
}

TEST_CASE("sweep: of a ring of many short cubics hardly a ray is left over") {
    // A ball nearly as large as the ring that it runs along: the inner side bends sharply.
    curves::Path path;
    path.closed = true;
    constexpr int kSpans = 60;
    const auto at = [](double angle) {
        return Vec3{2.0 * std::cos(angle), 2.0 * std::sin(angle), 0.0};
    };
    const double turn = 2.0 * std::numbers::pi / kSpans;
    const double handle = 4.0 / 3.0 * std::tan(0.25 * turn);
    for (int i = 0; i < kSpans; ++i) {
        const Vec3 from = at(i * turn);
        const Vec3 to = at((i + 1) % kSpans * turn);
        const Vec3 p = from + Vec3{-from.y, from.x, 0.0} * handle;
        const Vec3 q = to - Vec3{-to.y, to.x, 0.0} * handle;
        path.spans.push_back({{from.x, p.x, q.x, to.x},
                              {from.y, p.y, q.y, to.y},
                              {0, 0, 0, 0},
                              {1.6, 1.6, 1.6, 1.6}});
    }
    const auto placed = Sweep::prepare(
        std::vector<Argument>{std::make_shared<const curves::Path>(path), std::size_t{0}});
    REQUIRE(placed.has_value());
    Random random(7);
    Count count;
    for (int i = 0; i < 2000; ++i) compare(placed->kernel, random, count);
    CHECK(count.ends > 2000);
    CHECK(count.left_over * 100 < count.ends);
}

TEST_CASE("revolve: errors hold where one of Newton's steps lands near a zero by luck") {
    const auto placed = Revolve::prepare(Revolve::examples()[1]);  // a half-disc: a sphere
    REQUIRE(placed.has_value());
    const Vec3 o{0.06997323389964058, 0.13181544560363195, 0.42376733905041638};
    const Vec3 d{0.56636200082802457, 0.75580736615901678, -0.32861726868478247};
    const double e = 1e-15;
    const LocalRay<double> ray{o.x, o.y, o.z, d.x, d.y, d.z, e, e, e, dot(d, d), kFromTheBeginning};
    SpanList plain, full;
    placed->kernel.spans(ray, plain);
    placed->kernel.spans_in_full(ray, full);
    REQUIRE(plain.size() == 1);
    REQUIRE(full.size() == 1);
    CHECK(near(plain[0].enter, full[0].enter));
    CHECK(near(plain[0].exit, full[0].exit));
}

}  // namespace raymo::solids
