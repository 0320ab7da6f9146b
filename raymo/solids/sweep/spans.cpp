// A line through the tree of a sweep.
#include <cmath>
#include <limits>

#include "raymo/math/lanes.hpp"
#include "raymo/math/tolerance.hpp"
#include "raymo/solids/lane_kernels.hpp"
#include "raymo/solids/ray_block.hpp"
#include "raymo/solids/sweep/chords.hpp"
#include "raymo/solids/sweep/slabs.hpp"
#include "raymo/solids/sweep/sweep.hpp"

namespace raymo::solids {
namespace {

#include "raymo/math/triple.inl"
#include "raymo/solids/interval.inl"
//
#include "raymo/solids/sweep/kernel.inl"

/// Calls visit(piece) for the pieces of which the line meets the box.
template <class Visit>
void walk(const SweptSpheres& spheres, const Slabs& slabs, Visit&& visit) {
    struct Todo {
        std::uint32_t level, node;
    };
    std::array<Todo, kMostWaiting> open;
    std::size_t count = 0;
    open[count++] = {static_cast<std::uint32_t>(spheres.levels.size() - 1), 0};
    while (count > 0) {
        const Todo at = open[--count];
        unsigned met = slabs.met(spheres.levels[at.level][at.node]);
        for (; met != 0; met &= met - 1) {
            const auto child =
                at.node * SweptNode::kWidth + static_cast<std::uint32_t>(__builtin_ctz(met));
            if (at.level > 0) {
                open[count++] = {at.level - 1, static_cast<std::uint32_t>(child)};
            } else {
                visit(spheres.pieces[child]);
            }
        }
    }
}

}  // namespace

void Sweep::Kernel::spans(const LocalRay<double>& ray, SpanList& out) const {
    const double length = std::sqrt(ray.dd);
    LaneChords<double, bool> found(false);
    SweepLines<double, bool> lines = sweep_lines<double, bool>(ray, found);
    const Slabs slabs({ray.ox, ray.oy, ray.oz}, {lines.along.x, lines.along.y, lines.along.z},
                      lines.error, lines.past);
    walk(*spheres_, slabs, [&](const SweptPiece& piece) { lines.meet(piece, !found.rest); });
    LaneSpans<double, bool, kSweptSpans> lanes;
    const int count = found.rest ? 0 : found.spans(true, length, sweep_limit(ray), lanes);
    if (found.rest) {
        spans_in_full(ray, out);
    } else {
        append(lanes, count, out);
    }
}

void Sweep::Kernel::spans_in_full(const LocalRay<double>& ray, SpanList& out) const {
    const SweptSpheres& spheres = *spheres_;
    const double length = std::sqrt(ray.dd);
    SweepLine line;
    line.o = {ray.ox, ray.oy, ray.oz};
    line.error = ray.ex + ray.ey + ray.ez + kSweepOwnError;
    line.along = Vec3{ray.dx, ray.dy, ray.dz} / length;
    make_frame(line.along, line.side, line.up);
    ChordUnion found;
    walk(spheres, Slabs(line.o, line.along, line.error),
         [&](const SweptPiece& piece) { add_chords(line, spheres, piece, found); });
    found.finish(length, sweep_limit(ray), out);
}

void Sweep::Kernel::normals(PlaceBlock& places, std::uint32_t asked) const {
    for (; asked != 0; asked &= asked - 1) {
        const auto i = static_cast<std::size_t>(__builtin_ctz(asked));
        const Vec3 n = normal({places.p[0][i], places.p[1][i], places.p[2][i]},
                              static_cast<std::uint16_t>(places.face[i]));
        for (int a = 0; a < 3; ++a) places.p[a][i] = n[a];
    }
}

}  // namespace raymo::solids
