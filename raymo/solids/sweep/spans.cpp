// A line through the tree of a sweep.
#include <algorithm>
#include <cmath>

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
            from_low_[i] = o + margin;
            from_high_[i] = o - margin;
        }
    }
    /// Bit c: child c may be met.
    [[nodiscard]] unsigned met(const SweptNode& node) const {
        constexpr std::size_t kWidth = SweptNode::kWidth;
        std::array<float, kWidth> near;
        std::array<float, kWidth> far;
        near.fill(-std::numeric_limits<float>::max());
        far.fill(std::numeric_limits<float>::max());
        for (std::size_t a = 0; a < 3; ++a) {
            for (std::size_t c = 0; c < kWidth; ++c) {
                const float low = (node.lo[a][c] - from_low_[a]) * inverse_[a];
                const float high = (node.hi[a][c] - from_high_[a]) * inverse_[a];
                near[c] = std::max(near[c], std::min(low, high));
                far[c] = std::min(far[c], std::max(low, high));
            }
        }
        unsigned bits = 0;
        for (std::size_t c = 0; c < kWidth; ++c) {
            // Boxes without content have their ends the wrong way round.
            bits |= (near[c] <= far[c] && node.lo[0][c] <= node.hi[0][c] ? 1U : 0U) << c;
        }
        return bits;
    }

private:
    std::array<float, 3> inverse_, from_low_, from_high_;
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
