// A line through the tree of a sweep.
#include <algorithm>
#include <bit>
#include <cmath>
#include <limits>

#include "raymo/math/tolerance.hpp"
#include "raymo/solids/sweep/chords.hpp"
#include "raymo/solids/sweep/sweep.hpp"

namespace raymo::solids {
namespace {

/// Error of a place on the line, of a centre and of a radius, in the canonical frame, where all numbers are below 4: the cuts
/// of the path (3 roundings a halving of numbers below 2, for each coordinate and the radius), the line's frame (4 relative
/// ones), coordinates in it (5) and their values at a place (9), and lengths along the line (3).
constexpr double kOwnError = 64.0 * kUnitRoundoff;

/// Slabs in floats, for boxes that are larger than need be by kBoxMargin [KayKajiya86].
class Slabs {
public:
    explicit Slabs(const SweepLine& line) {
        const auto margin = static_cast<float>(line.error * (1.0 + 0x1p-20));
        for (int a = 0; a < 3; ++a) {
            const auto i = static_cast<std::size_t>(a);
            const auto d = static_cast<float>(line.along[a]);
            const auto o = static_cast<float>(line.o[a]);
            // 1e-15 moves no place by more than the margin.
            inverse_[i] = 1.0F / std::copysign(std::max(std::fabs(d), 1e-15F), d);
            from_first_[i] = o + std::copysign(margin, d);
            from_last_[i] = o - std::copysign(margin, d);
        }
    }
    /// Bit c: child c may be met.
    [[nodiscard]] unsigned met(const SweptNode& node) const {
        constexpr std::size_t kWidth = SweptNode::kWidth;
        // Boxes without content have their ends the wrong way round, and so have their slabs.
        float near[3][kWidth];
        float far[3][kWidth];
        for (std::size_t a = 0; a < 3; ++a) {
            const float* first = inverse_[a] > 0.0F ? node.lo[a] : node.hi[a];
            const float* last = inverse_[a] > 0.0F ? node.hi[a] : node.lo[a];
            for (std::size_t c = 0; c < kWidth; ++c) {
                near[a][c] = (first[c] - from_first_[a]) * inverse_[a];
                far[a][c] = (last[c] - from_last_[a]) * inverse_[a];
            }
        }
        std::uint32_t missed[kWidth];
        for (std::size_t c = 0; c < kWidth; ++c) {
            const float begin = near[0][c] > near[1][c] ? near[0][c] : near[1][c];
            const float end = far[0][c] < far[1][c] ? far[0][c] : far[1][c];
            const float enter = begin > near[2][c] ? begin : near[2][c];
            const float exit = end < far[2][c] ? end : far[2][c];
            missed[c] = std::bit_cast<std::uint32_t>(exit - enter) >> 31;
        }
        unsigned bits = 0;
        for (std::size_t c = 0; c < kWidth; ++c) bits |= (1U - missed[c]) << c;
        return bits;
    }

private:
    /// The line's place, moved by the margin against the line for the planes that are met first, and on for the last.
    std::array<float, 3> inverse_, from_first_, from_last_;
};

}  // namespace

void Sweep::Kernel::spans(const LocalRay<double>& ray, SpanList& out) const {
    const SweptSpheres& spheres = *spheres_;
    const double length = std::sqrt(ray.dd);
    SweepLine line;
    line.o = {ray.ox, ray.oy, ray.oz};
    line.error = ray.ex + ray.ey + ray.ez + kOwnError;
    line.along = Vec3{ray.dx, ray.dy, ray.dz} / length;
    const Slabs slabs(line);
    bool framed = false;
    ChordUnion found;

    struct Todo {
        std::uint32_t level, node;
    };
    // Of each level but the first at most seven wait, of 2^32 pieces at most.
    std::array<Todo, 8 * 11> open;
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
                continue;
            }
            if (!framed) make_frame(line.along, line.side, line.up);
            framed = true;
            add_chords(line, spheres, spheres.pieces[child], found);
        }
    }
    if (!framed) return;
    const double e = ray.ex + ray.ey + ray.ez;
    found.finish(length, kDegenerate + 1024.0 * e, out);
}

}  // namespace raymo::solids
