// Expressions that mean the same solid: each is traced, and judged by the simpler of the two.
#include "raymo/query/locate.hpp"
#include "tests/laws/rays.hpp"

namespace raymo::laws {
namespace {

/// Two expressions for one solid; `plain` is the judge. A null judge means nothing at all.
struct Pair {
    ModelPtr tested;
    ModelPtr plain;
};
using MakePair = std::function<Pair(Random& random)>;

/// A map for both sides: none, axis-parallel, or anything.
Affine common_map(Random& random) {
    switch (random.below(4)) {
        case 0:
            return {};
        case 1:
            return rotation(random.axis(), 90.0 * random.below(4)) * translation({1, 2, 3});
        case 2:
            return rotation(random.direction(), random.uniform(0, 360));
        default:
            return random_map(random, 5);
    }
}

void judge_empty(Traced& traced, const Ray& ray, Tally& tally) {
    ++tally.rays;
    ++tally.samples;
    const auto& spans = traced.spans(ray);
    if (!spans.empty()) {
        tally.exception("phantom: nothing should be there: " + describe(*traced.model(), ray));
        return;
    }
    trace::RayQuery query;
    query.ray = ray;
    trace::Hit hit;
    if (traced.tracer().first_hit(query, hit) || traced.tracer().occluded(query)) {
        tally.exception("phantom hit on nothing: " + describe(*traced.model(), ray));
    }
}

void judge_pairs(const MakePair& make, std::uint64_t rays, Random& random, Tally& tally) {
    while (tally.rays < rays) {
        const Pair pair = make(random);
        const Affine map = common_map(random);
        Traced traced(moved(pair.tested, map));
        const ModelPtr plain = pair.plain == nullptr ? nullptr : moved(pair.plain, map);
        if (!traced.ok()) {
            tally.exception(traced.error() + ": " + text(*traced.model()));
            continue;
        }
        query::Locator locator(build(traced.model()));
        for (int i = 0; i < 20; ++i) {
            AimedRay aimed = any_ray(random, kGridSize, 0.5);
            const Ray ray{map(aimed.ray.origin), map.linear * aimed.ray.direction};
            if (plain == nullptr) {
                judge_empty(traced, ray, tally);
            } else {
                judge_ray(traced, *plain, ray, 3.0 * kGridSize, aimed.rounding, random, tally);
            }
            // Points say the same.
            const Vec3 p = ray.at(random.uniform(-1, 4));
            const query::Where where = locator.where(p);
            const Side truth =
                plain == nullptr ? Side::out : classify(*plain, {p.x, p.y, p.z}, 1e-11L);
            ++tally.samples;
            if ((truth == Side::in && where != query::Where::in) ||
                (truth == Side::out && where != query::Where::out)) {
                tally.exception("point: " + describe(*traced.model(), {p, {}}));
            }
        }
    }
}

ModelPtr any(Random& random) { return grid_tree(random, random.below(3)); }

/// All that the grid models reach.
ModelPtr room() { return block({64, 64, 64}, true); }

}  // namespace

void add_identity_laws(std::vector<Law>& laws) {
    const auto add = [&](std::string name, MakePair make) {
        laws.push_back(
            {std::move(name), 200000, [make](std::uint64_t rays, Random& random, Tally& tally) {
                 judge_pairs(make, rays, random, tally);
             }});
    };
    add("a - a is empty", [](Random& r) {
        const ModelPtr a = any(r);
        return Pair{cut(a, a), nullptr};
    });
    add("a - a is empty, a written twice", [](Random& r) {
        const ModelPtr a = grid_leaf(r);
        const ModelPtr copy = std::make_shared<Model>(*a);
        return Pair{cut(a, copy), nullptr};
    });
    add("a - (a + b) is empty", [](Random& r) {
        const ModelPtr a = any(r);
        return Pair{cut(a, join(a, any(r))), nullptr};
    });
    add("(a - b) & b is empty", [](Random& r) {
        const ModelPtr b = any(r);
        return Pair{meet(cut(any(r), b), b), nullptr};
    });
    add("a & a is a", [](Random& r) {
        const ModelPtr a = any(r);
        return Pair{meet(a, a), a};
    });
    add("a + a is a", [](Random& r) {
        const ModelPtr a = any(r);
        return Pair{join(a, a), a};
    });
    add("absorption: a + (a & b) is a", [](Random& r) {
        const ModelPtr a = any(r);
        return Pair{join(a, meet(a, any(r))), a};
    });
    add("absorption: a & (a + b) is a", [](Random& r) {
        const ModelPtr a = any(r);
        return Pair{meet(a, join(a, any(r))), a};
    });
    add("De Morgan: u - (a + b) is (u - a) & (u - b)", [](Random& r) {
        const ModelPtr a = any(r), b = any(r);
        return Pair{meet(cut(room(), a), cut(room(), b)), cut(room(), join(a, b))};
    });
    add("De Morgan: u - (a & b) is (u - a) + (u - b)", [](Random& r) {
        const ModelPtr a = any(r), b = any(r);
        return Pair{join(cut(room(), a), cut(room(), b)), cut(room(), meet(a, b))};
    });
    add("a - (a - b) is a & b", [](Random& r) {
        const ModelPtr a = any(r), b = any(r);
        return Pair{cut(a, cut(a, b)), meet(a, b)};
    });
    add("(a - b) + (a & b) is a", [](Random& r) {
        const ModelPtr a = any(r), b = any(r);
        return Pair{join(cut(a, b), meet(a, b)), a};
    });
    add("abutting blocks are one", [](Random& r) {
        const double x = 0.5 * (1 + r.below(8)), y = 0.5 * (1 + r.below(8)),
                     h = 0.5 * (1 + r.below(8));
        return Pair{join(block({x, 2, h}), moved(block({y, 2, h}), Vec3{x, 0, 0})),
                    block({x + y, 2, h})};
    });
    add("abutting blocks of odd sizes are one, each moved by itself", [](Random& r) {
        const double x = r.uniform(0.1, 4), y = r.uniform(0.1, 4);
        const Affine map = rotation(r.direction(), r.uniform(0, 360));
        return Pair{join(moved(block({x, 2, 3}), map),
                         moved(block({y, 2, 3}), map * translation({x, 0, 0}))),
                    moved(block({x + y, 2, 3}), map)};
    });
    add("abutting blocks share nothing", [](Random& r) {
        const double x = r.uniform(0.1, 4);
        const Affine map = rotation(r.direction(), r.uniform(0, 360));
        return Pair{meet(moved(block({x, 2, 3}), map),
                         moved(block({1, 2, 3}), map * translation({x, 0, 0}))),
                    nullptr};
    });
    add("a flush cut leaves no skin", [](Random& r) {
        const double depth = r.uniform(0.1, 2);
        // A pocket from the top, flush with it; and the same cut straight through.
        const ModelPtr body = block({6, 6, 3});
        return Pair{cut(body, moved(block({2, 2, depth}), Vec3{2, 2, 3 - depth})),
                    cut(body, moved(block({2, 2, depth + 1}), Vec3{2, 2, 3 - depth}))};
    });
    add("a flush drill leaves no skin", [](Random& r) {
        const double radius = r.uniform(0.1, 2);
        const ModelPtr body = block({6, 6, 3});
        return Pair{cut(body, moved(cylinder(radius, 3), Vec3{3, 3, 0})),
                    cut(body, moved(cylinder(radius, 5), Vec3{3, 3, -1}))};
    });
    add("stacked cylinders are one", [](Random& r) {
        const double radius = r.uniform(0.1, 3), h = 0.5 * (1 + r.below(8));
        return Pair{join(cylinder(radius, h), moved(cylinder(radius, 2), Vec3{0, 0, h})),
                    cylinder(radius, h + 2)};
    });
    add("a frustum and its tip are a cone", [](Random& r) {
        const double h = 0.5 * (1 + r.below(6));
        return Pair{join(cone(2, 1, h), moved(cone(1, 0, h), Vec3{0, 0, h})), cone(2, 0, 2 * h)};
    });
    add("nested tangent spheres: the larger wins", [](Random& r) {
        const double big = r.uniform(1, 5), small = r.uniform(0.1, 0.9) * big;
        return Pair{join(sphere(big), moved(sphere(small), r.axis() * (big - small))), sphere(big)};
    });
    add("nested tangent spheres: small - big is empty", [](Random& r) {
        const double big = 4, small = 0.5 * (1 + r.below(7));
        return Pair{cut(moved(sphere(small), r.axis() * (big - small)), sphere(big)), nullptr};
    });
    add("nested tangent cylinders: the larger wins", [](Random& r) {
        const double big = r.uniform(1, 4), small = r.uniform(0.1, 0.9) * big;
        return Pair{join(cylinder(big, 4), moved(cylinder(small, 4), Vec3{big - small, 0, 0})),
                    cylinder(big, 4)};
    });
    add("nested tangent cylinders: small - big is empty", [](Random& r) {
        const double big = 4, small = 0.5 * (1 + r.below(7));
        return Pair{cut(moved(cylinder(small, 4), Vec3{0, big - small, 0}), cylinder(big, 4)),
                    nullptr};
    });
    add("nested tangent cylinders, turned one by one: small - big is empty", [](Random& r) {
        const double big = 4, small = 0.5 * (1 + r.below(7));
        const Affine map = rotation(r.direction(), r.uniform(0, 360));
        return Pair{cut(moved(cylinder(small, 4), map * translation({0, big - small, 0})),
                        moved(cylinder(big, 4), map)),
                    nullptr};
    });
    add("a ball as sphere and as quadric", [](Random& r) {
        const double radius = 0.5 * (1 + r.below(8));
        const ModelPtr other =
            quadric({1, 0, 0, 0, 0, 1, 0, 0, 0, 0, 1, 0, 0, 0, 0, -radius * radius});
        return Pair{cut(sphere(radius), other), nullptr};
    });
    add("a block as block and as half-spaces", [](Random& r) {
        const double x = 0.5 * (1 + r.below(8));
        const ModelPtr walls = meet(meet(halfspace({1, 0, 0}, x), halfspace({-1, 0, 0}, 0)),
                                    meet(halfspace({0, 2, 0}, 4), halfspace({0, -1, 0}, 0)));
        return Pair{cut(block({x, 2, 3}), walls), nullptr};
    });
}

}  // namespace raymo::laws
