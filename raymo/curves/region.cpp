#include "raymo/curves/region.hpp"

#include <algorithm>
#include <cmath>
#include <utility>

#include "raymo/core/assert.hpp"
#include "raymo/curves/roots.hpp"
#include "raymo/math/tolerance.hpp"

namespace raymo::curves {
namespace {

/// Cuts that are nearer to each other, or to an end, are left out: what turns back between them does so by less than the
/// rounding of the points.
constexpr double kNearestCuts = 0x1p-30;

constexpr std::uint32_t kLeafPieces = 1;

/// Pieces that are nearer to each other than this may be taken for one another at a point that was computed, which lies within
/// 2^-40 of its curve (lane_normals.inl).
constexpr double kTogether = 0x1p-38;

/// Boxes that are looked at, at most, to find what a piece may meet.
constexpr int kMostBoxes = 512;

/// x' w - x w': zero where x / w is stationary.
Bernstein<5> turning(const std::array<double, 4>& x, const std::array<double, 4>& w) {
    return sum_of(product(derivative(x), w), product(x, derivative(w)), -1.0);
}

/// The determinant of P, P' and P'': zero where the curve bends the other way.
Bernstein<6> bending(const Span2& s) {
    const auto part = [](const auto& a, const auto& b, const auto& c) {
        const auto b1 = derivative(b);
        const auto c1 = derivative(c);
        return product(a, sum_of(product(b1, derivative(c1)), product(derivative(b1), c1), -1.0));
    };
    return sum_of(sum_of(part(s.x, s.y, s.w), part(s.y, s.w, s.x), 1.0), part(s.w, s.x, s.y), 1.0);
}

template <int N>
void add_cuts(const Bernstein<N>& p, double noise, std::vector<double>& cuts) {
    RootList<N> roots;
    find_roots<N>(p, noise, roots);
    for (const Root& root : roots) {
        if (root.crosses) cuts.push_back(root.u);
    }
}

/// Where a span must be cut, ascending.
std::vector<double> cuts_of(const Span2& s) {
    std::vector<double> cuts;
    const double size = std::max({size_of(s.x), size_of(s.y), 1e-300});
    const double weight = size_of(s.w);
    const double noise = 64.0 * kUnitRoundoff * size * weight;
    add_cuts<5>(turning(s.x, s.w), noise, cuts);
    add_cuts<5>(turning(s.y, s.w), noise, cuts);
    add_cuts<6>(bending(s), 256.0 * noise * size, cuts);
    std::sort(cuts.begin(), cuts.end());
    double last = 0.0;
    std::erase_if(cuts, [&](double u) {
        if (u - last < kNearestCuts || 1.0 - u < kNearestCuts) return true;
        last = u;
        return false;
    });
    return cuts;
}

/// Whether the hulls of both lie on different sides of the chord of one.
bool are_apart(const Span2& a, const Span2& b) {
    for (const Span2* const s : {&a, &b}) {
        const Vec2 chord = s->point(3) - s->point(0);
        const Vec2 n{chord.y, -chord.x};
        const double margin = kTogether * norm(n);
        double least[2], most[2];
        for (const std::size_t which : {0U, 1U}) {
            const Span2& span = which == 0 ? a : b;
            least[which] = most[which] = dot(n, span.point(0));
            for (const std::size_t k : {1U, 2U, 3U}) {
                const double height = dot(n, span.point(k));
                least[which] = std::min(least[which], height);
                most[which] = std::max(most[which], height);
            }
        }
        if (least[0] > most[1] + margin || least[1] > most[0] + margin) return true;
    }
    return false;
}

bool is_point(const Span2& s) {
    for (std::size_t i = 1; i < 4; ++i) {
        if (!(s.point(i) == s.point(0))) return false;
    }
    return true;
}

}  // namespace

Box2 box_of(const Span2& piece) {
    Box2 box;
    for (std::size_t i = 0; i < 4; ++i) box.include(piece.point(i));
    return box;
}

Vec2 point_at(const Span2& piece, double u) {
    const double inverse = 1.0 / jet_at(piece.w, u).value;
    return {jet_at(piece.x, u).value * inverse, jet_at(piece.y, u).value * inverse};
}

Vec2 tangent(const Span2& piece, double u) {
    const Jet x = jet_at(piece.x, u);
    const Jet y = jet_at(piece.y, u);
    const Jet w = jet_at(piece.w, u);
    const Vec2 t{x.slope * w.value - x.value * w.slope, y.slope * w.value - y.value * w.slope};
    const double across = std::fabs(piece.x[3] / piece.w[3] - piece.x[0] / piece.w[0]);
    const double up = std::fabs(piece.y[3] / piece.w[3] - piece.y[0] / piece.w[0]);
    if (max_norm(t) > 0x1p-26 * std::max(across, up) * w.value * w.value) return t;
    // Where the derivative (nearly) vanishes, at a cusp or where control points (nearly) coincide, a chord of the hull shows
    // the direction that the curve has beyond.
    const double size = max_norm(box_of(piece).size());
    const Vec2 p{x.value / w.value, y.value / w.value};
    for (const std::size_t i : {1U, 2U, 3U}) {
        const Vec2 chord = u < 0.5 ? piece.point(i) - p : p - piece.point(3 - i);
        if (max_norm(chord) > 0x1p-20 * size) return chord;
    }
    return t;
}

Result<RegionPtr> Region::make(const Outline& outline, Vec2 centre, double scale) {
    return make(outline, centre, scale, false);
}

Result<RegionPtr> Region::make_beside_axis(const Outline& outline, Vec2 centre, double scale) {
    return make(outline, centre, scale, true);
}

Result<RegionPtr> Region::make(const Outline& outline, Vec2 centre, double scale,
                               bool beside_axis) {
    auto region = std::make_shared<Region>();
    region->fill_ = outline.fill;
    for (const Curve& curve : outline.curves) {
        for (const Span2& span : curve.spans) {
            for (std::size_t i = 0; i < 4; ++i) {
                if (span.w[i] > 0.0 && std::isfinite(span.w[i]) && is_finite(span.point(i)))
                    continue;
                return fail(ErrorCode::bad_argument, "the contour has a point that is not finite");
            }
            RAYMO_ASSERT(span.w[0] == 1.0 && span.w[3] == 1.0);
        }
        if (!curve.closed) {
            return fail(ErrorCode::bad_argument, "the contour is not closed",
                        "close it with `closed: true`, or an arc with chain([...], closed: true)");
        }
        region->add_curve(curve, centre, scale, beside_axis);
    }
    if (region->pieces_.empty())
        return fail(ErrorCode::bad_argument, "the contour encloses nothing");
    region->nodes_.reserve(region->pieces_.size());
    region->add_node(0, static_cast<std::uint32_t>(region->pieces_.size()));
    if (region->is_flat()) {
        return fail(ErrorCode::bad_argument, "the contour encloses nothing",
                    "its points lie in a line, or its curves run back upon themselves");
    }
    region->number_runs();
    return RegionPtr(std::move(region));
}

void Region::add_curve(const Curve& curve, Vec2 centre, double scale, bool beside_axis) {
    const auto first = static_cast<std::uint32_t>(pieces_.size());
    const auto add = [&](const Span2& span) {
        if (is_point(span) || (beside_axis && size_of(span.x) == 0.0)) return;
        Piece piece;
        static_cast<Span2&>(piece) = span;
        pieces_.push_back(piece);
    };
    for (const Span2& written : curve.spans) {
        // Centred first: far from the origin the map's own product would round.
        Span2 span = written;
        for (std::size_t i = 0; i < 4; ++i) {
            span.x[i] = (written.x[i] - centre.x * written.w[i]) * scale;
            span.y[i] = (written.y[i] - centre.y * written.w[i]) * scale;
        }
        double begin = 0.0;
        for (const double cut : cuts_of(span)) {
            const double u = (cut - begin) / (1.0 - begin);
            Span2 left, right;
            split(span.x, u, left.x, right.x);
            split(span.y, u, left.y, right.y);
            split(span.w, u, left.w, right.w);
            add(left);
            span = right;
            begin = cut;
        }
        add(span);
    }
    const auto end = static_cast<std::uint32_t>(pieces_.size());
    for (std::uint32_t i = first; i < end; ++i) {
        Piece& piece = pieces_[i];
        piece.previous = i == first ? end - 1 : i - 1;
        piece.next = i + 1 == end ? first : i + 1;
    }
    for (std::uint32_t i = first; i < end; ++i) {
        Piece& piece = pieces_[i];
        const Piece& next = pieces_[piece.next];
        if (beside_axis && piece.x[3] == 0.0 && next.x[0] == 0.0) continue;
        piece.x[3] = next.x[0];
        piece.y[3] = next.y[0];
    }
    for (std::uint32_t i = first; i < end; ++i) {
        Piece& piece = pieces_[i];
        for (const auto& c : {piece.x, piece.y, piece.w}) {
            for (const std::size_t k : {0U, 1U})
                piece.bend = std::max(piece.bend, std::fabs(c[k] - 2.0 * c[k + 1] + c[k + 2]));
        }
    }
}

/// A corner is a joint at which the tangent turns by more than rounding explains. Pieces of one stretch that may meet, beside
/// at a joint between them, become stretches of their own: there the stretch tells which of them is meant.
void Region::number_runs() {
    std::vector<bool> borders;
    borders.reserve(pieces_.size());
    for (const Piece& piece : pieces_) {
        const Vec2 in = tangent(pieces_[piece.previous], 1.0);
        const Vec2 out = tangent(piece, 0.0);
        borders.push_back(std::fabs(cross(in, out)) > 0x1p-30 * norm(in) * norm(out) ||
                          dot(in, out) < 0.0);
        pieces_[piece.previous].ends_in_corner = borders.back();
    }
    number_runs(borders);
    bool any = false;
    for (std::uint32_t i = 0; i < pieces_.size(); ++i) {
        if (!meets_its_run(i)) continue;
        any = true;
        borders[i] = borders[pieces_[i].next] = true;
    }
    if (any) number_runs(borders);
}

void Region::number_runs(const std::vector<bool>& borders) {
    runs_ = 0;
    for (std::uint32_t first = 0; first < pieces_.size();) {
        std::uint32_t run = runs_;
        std::uint32_t end = first;
        do {
            if (end > first && borders[end]) ++run;
            pieces_[end].run = run;
            ++end;
        } while (pieces_[end - 1].next == end);
        // The last stretch of a curve that closes smoothly goes on in the first.
        if (run > runs_ && !borders[first]) {
            for (std::uint32_t i = end; pieces_[i - 1].run == run; --i) pieces_[i - 1].run = runs_;
            --run;
        }
        runs_ = run + 1;
        first = end;
    }
}

bool Region::meets_its_run(std::uint32_t i) const {
    const Piece& piece = pieces_[i];
    if (pieces_[piece.previous].run != piece.run && pieces_[piece.next].run != piece.run)
        return false;
    const Box2 box = box_of(piece);
    int boxes = 0;
    bool met = false;
    walk(
        [&](const Box2& other) {
            // Where there is so much about it, it may well be met.
            met = met || ++boxes > kMostBoxes;
            return !met && other.lo.x <= box.hi.x + kTogether &&
                   other.hi.x >= box.lo.x - kTogether && other.lo.y <= box.hi.y + kTogether &&
                   other.hi.y >= box.lo.y - kTogether;
        },
        [&](std::uint32_t k) {
            met = met || (k != i && k != piece.next && k != piece.previous &&
                          pieces_[k].run == piece.run && !are_apart(piece, pieces_[k]));
        });
    return met;
}

void Region::add_node(std::uint32_t first, std::uint32_t end) {
    const auto index = static_cast<std::uint32_t>(nodes_.size());
    nodes_.emplace_back();
    Box2 box;
    if (end - first <= kLeafPieces) {
        nodes_[index].first = first;
        nodes_[index].count = end - first;
        for (std::uint32_t i = first; i < end; ++i) box.include(box_of(pieces_[i]));
    } else {
        // Pieces that follow each other lie together, so halves of the list make a good tree.
        const std::uint32_t middle = first + (end - first) / 2;
        for (const auto& [from, to] : {std::pair{first, middle}, std::pair{middle, end}}) {
            const auto child = static_cast<std::uint32_t>(nodes_.size());
            add_node(from, to);
            box.include(nodes_[child].box);
        }
    }
    nodes_[index].box = box;
    nodes_[index].skip = static_cast<std::uint32_t>(nodes_.size());
}

bool operator==(const Region& a, const Region& b) {
    if (a.fill_ != b.fill_ || a.pieces_.size() != b.pieces_.size()) return false;
    for (std::size_t i = 0; i < a.pieces_.size(); ++i) {
        const Piece& p = a.pieces_[i];
        const Piece& q = b.pieces_[i];
        if (!(static_cast<const Span2&>(p) == q) || p.next != q.next) return false;
    }
    return true;
}

}  // namespace raymo::curves
