// What of a line is inside a closed surface.
//
// A search (search.cpp) gives the crossings that are certain for all lines within an error e of the given one, and intervals
// of the line (doubts) that hold all others: at borders of patches, and where the line is tangent. For nearly all lines there
// are no doubts, and the crossings are all there is.
//
// Otherwise other lines decide, each within e of the given one, and searched with no error but that of the arithmetic. Where
// such a neighbour has no doubt, its crossings are, one for one, those of a true line with a true closed surface: their
// number is right without any rule for borders, corners, poles and tangents, whether seen edge-on or not, or whether
// patches beside each other are halved alike. As it is a line within e, they lie in the intervals that were found. Intervals
// that overlap are taken together. From one neighbour to another, moved gradually, no crossing leaves its interval, so what
// crossings in an interval add up to is the same for all: each interval may ask another neighbour. If nothing changes there,
// there is no surface, but a touch.
//
// Neighbours lie in directions that are turned by the golden angle, in a disc of radius e, at least 15 errors of the
// arithmetic, of which borders take a strip of 4 such errors. Eight in a row fail hardly ever but next to tangents; then e is
// made larger, up to the degenerate.
#include "raymo/solids/freeform/spans.hpp"

#include <algorithm>
#include <cmath>
#include <limits>

#include "raymo/math/tolerance.hpp"
#include "raymo/solids/freeform/freeform.hpp"

namespace raymo::solids {
namespace {

/// How often the error is made larger, and by how much.
constexpr int kMostRounds = 6;
constexpr double kLarger = 4.0;
/// Neighbours that are searched in each round.
constexpr int kNeighbours = 8;

constexpr double kUnknown = std::numeric_limits<double>::infinity();

/// An interval of the line, and by how much the winding number changes in it, most likely at s.
struct Change {
    double s, lo, hi;
    double width;  ///< of the narrowest crossing that this one is made of, about s; or kUnknown
    int turn;
    std::uint16_t in, out;  ///< patches that are crossed, inwards and outwards, last
};
using Changes = SmallList<Change, 16>;

std::uint16_t face_of(const FreeformHit& hit) {
    return static_cast<std::uint16_t>(2 * (hit.patch % kPatchNumbers));
}

void put_hits(const FreeformFound& found, Changes& changes) {
    for (const FreeformHit& hit : found.hits) {
        changes.push_back({hit.s, hit.s - hit.reach, hit.s + hit.reach, hit.reach, hit.turn,
                           face_of(hit), face_of(hit)});
    }
}

/// Sorts, and joins what overlaps.
void join(Changes& changes) {
    std::sort(changes.begin(), changes.end(),
              [](const Change& a, const Change& b) { return a.lo < b.lo; });
    std::size_t count = 0;
    for (std::size_t i = 0; i < changes.size(); ++i) {
        const Change next = changes[i];
        if (count == 0 || next.lo > changes[count - 1].hi) {
            changes[count++] = next;
            continue;
        }
        Change& last = changes[count - 1];
        last.hi = std::max(last.hi, next.hi);
        if (next.width < last.width) {
            last.width = next.width;
            last.s = next.s;
        }
        last.turn += next.turn;
        if (next.turn > 0) last.in = next.in;
        if (next.turn < 0) last.out = next.out;
    }
    changes.shrink(count);
}

bool closes(const Changes& changes) {
    int winding = 0;
    for (const Change& c : changes) winding += c.turn;
    return winding == 0;
}

struct End {
    const Change* at;
    std::uint16_t face;

    [[nodiscard]] double middle() const { return 0.5 * (at->lo + at->hi); }
    [[nodiscard]] double half() const { return 0.5 * (at->hi - at->lo); }
    [[nodiscard]] double error() const { return std::max(at->s - at->lo, at->hi - at->s); }
};

/// Errors are told to both sides alike; where they would overlap, the middles of the intervals are told instead, whose errors
/// do not.
void push(const End& enter, const End& exit, double unit, double limit, SpanList& out) {
    const bool thin = !(exit.at->s - enter.at->s > enter.error() + exit.error());
    const auto end = [&](const End& e) {
        const double error = thin ? e.half() : e.error();
        if (!(error <= limit)) out.set_degenerate();
        return SpanEnd{(thin ? e.middle() : e.at->s) / unit, error / unit, e.face};
    };
    const Span span{end(enter), end(exit)};
    if (span.exit.s - span.enter.s > span.enter.error + span.exit.error) {
        out.push(span);
    } else {
        out.set_touch(enter.at->lo / unit, exit.at->hi / unit);
    }
}

/// Spans in s = lengths / unit. `limit`: the largest error that is not degenerate.
void tell(const Changes& changes, double unit, double limit, SpanList& out) {
    int winding = 0;
    End open{};
    bool touched = false;
    for (const Change& c : changes) {
        const bool before = winding != 0;
        winding += c.turn;
        const bool after = winding != 0;
        if (before == after) {
            // A crossing within the solid is none at all.
            if (c.turn != 0) continue;
            if (touched || c.hi - c.lo > 2.0 * limit) out.set_degenerate();
            out.set_touch(c.lo / unit, c.hi / unit);
            touched = true;
            continue;
        }
        // Where it winds the other way, a patch that is crossed outwards leads into the solid.
        const std::uint16_t face = c.turn > 0 ? c.in : c.out;
        const bool inside_out = (c.turn > 0) != after;
        const End end{&c, static_cast<std::uint16_t>(inside_out ? face | kInsideOut : face)};
        if (after) {
            open = end;
        } else {
            push(open, end, unit, limit, out);
        }
    }
}

/// The intervals of a line with doubts; what changes in them is not known yet.
void put_unknown(const FreeformFound& found, Changes& changes) {
    for (const FreeformHit& hit : found.hits)
        changes.push_back({hit.s, hit.s - hit.reach, hit.s + hit.reach, hit.reach, 0, 0, 0});
    for (const FreeformDoubt& doubt : found.doubts) {
        const double middle = 0.5 * (doubt.lo + doubt.hi);
        const double width = doubt.is_border ? doubt.hi - middle : kUnknown;
        changes.push_back({middle, doubt.lo, doubt.hi, width, 0, 0, 0});
    }
}

/// Puts in what a neighbour tells of the intervals in which it has no doubts. False: some are still not known.
bool learn(const FreeformFound& neighbour, Changes& changes, SmallList<std::uint8_t, 16>& known) {
    bool all = true;
    for (std::size_t i = 0; i < changes.size(); ++i) {
        if (known[i] != 0) continue;
        Change& c = changes[i];
        bool clear = true;
        for (const FreeformDoubt& doubt : neighbour.doubts)
            clear = clear && (doubt.lo > c.hi || doubt.hi < c.lo);
        all = all && clear;
        if (!clear) continue;
        known[i] = 1;
        for (const FreeformHit& hit : neighbour.hits) {
            if (hit.s < c.lo || hit.s > c.hi) continue;
            c.turn += hit.turn;
            if (c.width == kUnknown) c.s = hit.s;
            (hit.turn > 0 ? c.in : c.out) = face_of(hit);
        }
    }
    return all;
}

/// The largest error of an end that is not degenerate.
double most_error(const LocalRay<double>& ray) {
    return kDegenerate + 1024.0 * (ray.ex + ray.ey + ray.ez);
}

}  // namespace

FreeformLine line_of(const LocalRay<double>& ray) {
    FreeformLine line;
    line.o = {ray.ox, ray.oy, ray.oz};
    line.along = Vec3{ray.dx, ray.dy, ray.dz} / std::sqrt(ray.dd);
    make_frame(line.along, line.side, line.up);
    line.error = (ray.ex + ray.ey + ray.ez) + 4.0 * kFreeformOwnError;
    return line;
}

bool tell_certain(const FreeformFound& found, const LocalRay<double>& ray, SpanList& out) {
    Changes changes;
    put_hits(found, changes);
    join(changes);
    if (!closes(changes)) return false;
    tell(changes, std::sqrt(ray.dd), most_error(ray), out);
    return true;
}

void Freeform::spans(const LocalRay<double>& ray, SpanList& out) const {
    const double length = std::sqrt(ray.dd);
    const double limit = most_error(ray);
    FreeformLine line = line_of(ray);
    Changes changes;
    double angle_cos = 0.8, angle_sin = 0.6;
    for (int round = 0; round < kMostRounds; ++round) {
        FreeformFound found;
        FreeformSearch(*surface_, line, found).run();
        if (found.doubts.empty() && tell_certain(found, ray, out)) return;
        if (line.error < 16.0 * kFreeformOwnError) {
            line.error = 16.0 * kFreeformOwnError;
            continue;
        }
        put_unknown(found, changes);
        join(changes);
        SmallList<std::uint8_t, 16> known;
        for (std::size_t i = 0; i < changes.size(); ++i) known.push_back(0);
        for (int i = 0; i < kNeighbours; ++i) {
            FreeformLine near = line;
            const double aside = (line.error - kFreeformOwnError) * (kNeighbours - i) / kNeighbours;
            near.o += line.side * (aside * angle_cos) + line.up * (aside * angle_sin);
            near.error = kFreeformOwnError;
            // The golden angle, nearly.
            constexpr double kCos = -0.737368878078320, kSin = 0.675490294261524;
            const double turned = angle_cos * kCos - angle_sin * kSin;
            angle_sin = angle_cos * kSin + angle_sin * kCos;
            angle_cos = turned;
            FreeformFound there;
            FreeformSearch(*surface_, near, there).run();
            if (!learn(there, changes, known)) continue;
            if (!closes(changes)) break;
            tell(changes, length, limit, out);
            return;
        }
        changes.shrink(0);
        line.error *= kLarger;
    }
    out.set_degenerate();
}

}  // namespace raymo::solids
