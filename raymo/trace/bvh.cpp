#include "raymo/trace/bvh.hpp"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstddef>
#include <cstring>
#include <limits>

namespace raymo::trace {
namespace {

constexpr float kInf = std::numeric_limits<float>::infinity();
constexpr int kBins = 16;
/// Cost of one leaf test in box tests: a leaf costs about as much as four nodes' share of one
/// child.
constexpr float kLeafCost = 4.0F;

/// x, y, z, and something that nobody asks for. (The compilers' own vectors: what is needed here is in every processor.)
using Four = float __attribute__((vector_size(16)));
using FourWhole = std::int32_t __attribute__((vector_size(16)));

/// A box to be put into the tree.
struct Ref {
    Four lo;  ///< and its number, in the fourth place
    Four hi;

    /// The fourth place of `hi` keeps sums away from numbers too small to be computed with fast.
    Ref(const Boxf& box, std::uint32_t id)
        : lo{box.lo[0], box.lo[1], box.lo[2], std::bit_cast<float>(id)},
          hi{box.hi[0], box.hi[1], box.hi[2], 1.0F} {}
    [[nodiscard]] std::uint32_t id() const { return std::bit_cast<std::uint32_t>(float{lo[3]}); }
    [[nodiscard]] Four centre2() const { return lo + hi; }
};

struct Bounds {
    Four lo{kInf, kInf, kInf, kInf};
    Four hi{-kInf, -kInf, -kInf, -kInf};

    void add(Four l, Four h) {
        lo = l < lo ? l : lo;
        hi = h > hi ? h : hi;
    }
    void add(const Bounds& other) { add(other.lo, other.hi); }
    [[nodiscard]] float half_area() const {
        const float x = hi[0] - lo[0];
        const float y = hi[1] - lo[1];
        const float z = hi[2] - lo[2];
        return x < 0.0F ? 0.0F : x * y + y * z + z * x;
    }
};

/// A run of refs, with the box around them and the box around their centres (times 2).
struct Range {
    std::uint32_t begin = 0;
    std::uint32_t end = 0;
    Bounds bounds;
    Bounds centres;
    bool divisible = true;  ///< false once splitting was found not to pay

    [[nodiscard]] std::uint32_t size() const { return end - begin; }
};

/// The bins of one axis.
struct Bins {
    std::array<Bounds, kBins> bounds;
    std::array<std::uint32_t, kBins> count;
    std::uint32_t used;  ///< a bit for each bin that holds refs

    void clear() {
        bounds.fill({});
        count.fill(0);
        used = 0;
    }
    void add(std::size_t b, Four lo, Four hi) {
        bounds[b].add(lo, hi);
        ++count[b];
        used |= 1U << b;
    }
};

class Builder {
public:
    explicit Builder(const std::vector<Boxf>& boxes) {
        refs_.reserve(boxes.size());
        aside_.resize(boxes.size(), Ref({}, 0));
        for (std::size_t i = 0; i < boxes.size(); ++i) {
            refs_.emplace_back(boxes[i], static_cast<std::uint32_t>(i));
        }
    }

    Bvh build() {
        Bvh out;
        out.nodes.reserve(refs_.size() * 2 / 5 + 1);
        out.nodes.emplace_back();
        std::vector<std::pair<std::uint32_t, Range>> todo;
        todo.emplace_back(0U, measure(0, static_cast<std::uint32_t>(refs_.size())));
        while (!todo.empty()) {
            const auto [index, range] = todo.back();
            todo.pop_back();
            const int count = divide(range);
            BvhNode node;
            for (int c = 0; c < BvhNode::kWidth; ++c) {
                const bool used = c < count && pieces_[static_cast<std::size_t>(c)].size() > 0;
                const Range& piece = pieces_[static_cast<std::size_t>(used ? c : 0)];
                for (std::size_t a = 0; a < 3; ++a) {
                    node.lo[a][c] = used ? piece.bounds.lo[a] : kInf;
                    node.hi[a][c] = used ? piece.bounds.hi[a] : -kInf;
                }
                node.ref[c] = 0;
                node.count[c] = 0;
                if (!used) continue;
                if (!piece.divisible || piece.size() == 1) {
                    node.ref[c] = piece.begin;
                    node.count[c] = static_cast<std::uint8_t>(piece.size());
                } else {
                    node.ref[c] = static_cast<std::uint32_t>(out.nodes.size());
                    out.nodes.emplace_back();
                    todo.emplace_back(node.ref[c], piece);
                }
            }
            out.nodes[index] = node;
        }
        out.order.reserve(refs_.size());
        for (const Ref& ref : refs_) out.order.push_back(ref.id());
        return out;
    }

private:
    [[nodiscard]] Range measure(std::uint32_t begin, std::uint32_t end) const {
        Range r;
        r.begin = begin;
        r.end = end;
        for (std::uint32_t i = begin; i < end; ++i) {
            const Ref& ref = refs_[i];
            r.bounds.add(ref.lo, ref.hi);
            const Four centre = ref.centre2();
            r.centres.add(centre, centre);
        }
        return r;
    }

    /// Fills pieces_ with up to eight pieces of `range`; returns how many.
    int divide(const Range& range) {
        pieces_[0] = range;
        int count = 1;
        while (count < BvhNode::kWidth) {
            int widest = -1;
            float area = -1.0F;
            for (int i = 0; i < count; ++i) {
                const Range& p = pieces_[static_cast<std::size_t>(i)];
                if (p.divisible && p.size() > 1 && p.bounds.half_area() > area) {
                    area = p.bounds.half_area();
                    widest = i;
                }
            }
            if (widest < 0) break;
            Range& piece = pieces_[static_cast<std::size_t>(widest)];
            Range right;
            if (!split(piece, right)) {
                piece.divisible = false;
                continue;
            }
            pieces_[static_cast<std::size_t>(count++)] = right;
        }
        return count;
    }

    /// Splits `range` in two; false when it is better left whole.
    bool split(Range& range, Range& right) {
        const std::uint32_t n = range.size();
        if (n == 2) return split_pair(range, right);
        float best = kInf;
        std::size_t best_axis = 0;
        int best_plane = 0;
        const Four to_bin = fill_bins(range);
        for (std::size_t axis = 0; axis < 3; ++axis) {
            if (to_bin[axis] == 0.0F) continue;
            const Bins& bins = bins_[axis];
            // Planes beside an empty bin cost what their neighbours cost.
            std::array<std::uint8_t, kBins> order;
            std::size_t bin_count = 0;
            for (std::uint32_t left = bins.used; left != 0; left &= left - 1) {
                order[bin_count++] = static_cast<std::uint8_t>(std::countr_zero(left));
            }
            std::array<float, kBins> right_cost;
            Bounds acc;
            std::uint32_t count = 0;
            for (std::size_t i = bin_count - 1; i > 0; --i) {
                acc.add(bins.bounds[order[i]]);
                count += bins.count[order[i]];
                right_cost[i] = acc.half_area() * static_cast<float>(count);
            }
            acc = {};
            count = 0;
            for (std::size_t i = 0; i + 1 < bin_count; ++i) {
                acc.add(bins.bounds[order[i]]);
                count += bins.count[order[i]];
                const float cost = acc.half_area() * static_cast<float>(count) + right_cost[i + 1];
                if (cost < best) {
                    best = cost;
                    best_axis = axis;
                    best_plane = order[i];
                }
            }
        }
        const bool fits = n <= static_cast<std::uint32_t>(kMaxRange);
        if (fits) {
            // Splitting costs one more box test for the halves; leaving whole costs testing all
            // leaves.
            const float area = range.bounds.half_area();
            if (!(kLeafCost * best + area < kLeafCost * area * static_cast<float>(n))) return false;
        }
        std::uint32_t middle = range.begin;
        if (best < kInf) {
            const float lo = range.centres.lo[best_axis];
            const float scale = to_bin[best_axis];
            // Where a ref goes can not be foretold, so it is written to both sides, and one of them moves on.
            for (std::uint32_t i = range.begin; i < range.end; ++i) {
                const Ref ref = refs_[i];
                const auto bin = static_cast<int>((ref.centre2()[best_axis] - lo) * scale);
                refs_[middle] = ref;
                aside_[i - middle] = ref;
                middle += static_cast<std::uint32_t>(bin - best_plane - 1) >> 31U;
            }
            std::copy_n(aside_.begin(), range.end - middle, refs_.begin() + middle);
        }
        if (middle == range.begin || middle == range.end)
            middle = range.begin + n / 2;  // all centres equal
        right = measure(middle, range.end);
        range = measure(range.begin, middle);
        return true;
    }

    /// The same for two refs, half of all that is split: their only cut needs no bins.
    bool split_pair(Range& range, Range& right) {
        Ref* const pair = &refs_[range.begin];
        const auto is_apart = [&](std::size_t axis) {
            return range.centres.hi[axis] > range.centres.lo[axis];
        };
        const auto around = [](const Ref& ref) { return Bounds{ref.lo, ref.hi}; };
        const std::size_t axis = is_apart(0) ? 0 : is_apart(1) ? 1 : 2;
        const float area = range.bounds.half_area();
        const float best = around(pair[0]).half_area() + around(pair[1]).half_area();
        if (!is_apart(axis) || !(kLeafCost * best + area < kLeafCost * area * 2.0F)) return false;
        if (pair[1].centre2()[axis] < pair[0].centre2()[axis]) std::swap(pair[0], pair[1]);
        right = measure(range.begin + 1, range.end);
        range = measure(range.begin, range.begin + 1);
        return true;
    }

    /// Puts the refs of a range into the bins of all axes. Gives the bins per length of each axis; 0: all refs stand at
    /// one place of it.
    Four fill_bins(const Range& range) {
        Four to_bin{};
        for (std::size_t axis = 0; axis < 3; ++axis) {
            const float extent = range.centres.hi[axis] - range.centres.lo[axis];
            const float scale = static_cast<float>(kBins) * 0.99999F / extent;
            if (extent > 0.0F && std::isfinite(scale)) to_bin[axis] = scale;
            bins_[axis].clear();
        }
        for (std::uint32_t i = range.begin; i < range.end; ++i) {
            const Four lo = refs_[i].lo;
            const Four hi = refs_[i].hi;
            const auto place =
                __builtin_convertvector((lo + hi - range.centres.lo) * to_bin, FourWhole);
            for (std::size_t axis = 0; axis < 3; ++axis) {
                bins_[axis].add(static_cast<std::size_t>(place[axis]), lo, hi);
            }
        }
        return to_bin;
    }

    std::vector<Ref> refs_;
    std::vector<Ref> aside_;  ///< room for the right side of a split
    std::array<Range, BvhNode::kWidth> pieces_;
    std::array<Bins, 3> bins_;
};

/// Without a branch, which would go either way as often.
float round_down(double v) {
    const auto f = static_cast<float>(v);
    const auto bits = std::bit_cast<std::int32_t>(f);
    const std::int32_t next = bits < 0 ? bits + 1 : bits - 1;  // towards -infinity; f is not +0
    return std::bit_cast<float>(static_cast<double>(f) > v ? next : bits);
}
float round_up(double v) { return -round_down(-v); }

}  // namespace

Boxf outward(const Aabb& box, double margin) {
    Boxf out{};
    for (int i = 0; i < 3; ++i) {
        out.lo[static_cast<std::size_t>(i)] = round_down(box.lo[i] - margin);
        out.hi[static_cast<std::size_t>(i)] = round_up(box.hi[i] + margin);
    }
    return out;
}

Boxf hull(const Boxf& a, const Boxf& b) {
    Boxf out = a;
    for (std::size_t i = 0; i < 3; ++i) {
        out.lo[i] = std::min(a.lo[i], b.lo[i]);
        out.hi[i] = std::max(a.hi[i], b.hi[i]);
    }
    return out;
}

Bvh build_bvh(const std::vector<Boxf>& boxes) { return Builder(boxes).build(); }

}  // namespace raymo::trace
