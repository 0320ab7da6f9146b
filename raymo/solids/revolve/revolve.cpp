#include "raymo/solids/revolve/revolve.hpp"

#include <cmath>
#include <limits>
#include <numbers>

#include "raymo/curves/samples.hpp"
#include "raymo/math/lanes.hpp"
#include "raymo/math/tolerance.hpp"
#include "raymo/solids/lane_kernels.hpp"
#include "raymo/solids/revolve/profile_line.hpp"

namespace raymo::solids {
namespace {

#include "raymo/math/triple.inl"
#include "raymo/solids/swept_kernels.inl"
//
#include "raymo/solids/revolve/kernel.inl"

constexpr std::uint16_t kStart = 0;
constexpr std::uint16_t kEnd = 1;
constexpr Vec3 kStartNormal{0.0, -1.0, 0.0};  ///< of the cut where the turn starts, outwards

SpanEnd entry(const LaneSpans<double, bool, 1>& s) {
    return {s.enter[0], s.enter_error[0], static_cast<std::uint16_t>(s.enter_face[0])};
}
SpanEnd way_out(const LaneSpans<double, bool, 1>& s) {
    return {s.exit[0], s.exit_error[0], static_cast<std::uint16_t>(s.exit_face[0])};
}

/// Closed by lines to the axis and along it.
curves::Curve closed_along_axis(const curves::Curve& open) {
    curves::Curve out = open;
    const Vec2 first = open.spans.front().point(0);
    const Vec2 last = open.spans.back().point(3);
    Vec2 at = last;
    for (const Vec2 to : {Vec2{0.0, last.y}, Vec2{0.0, first.y}, first}) {
        if (to == at) continue;
        out.spans.push_back(curves::segment(at, to));
        at = to;
    }
    out.closed = true;
    return out;
}

}  // namespace

Revolve::Kernel::Kernel(curves::RegionPtr region, double angle)
    : region_(std::move(region)), angle_(angle) {
    const SinCos at = sin_cos_degrees(angle);
    end_ = {-at.sin, at.cos};
}

void Revolve::Kernel::spans(const LocalRay<double>& ray, SpanList& out) const {
    LaneSpans<double, bool, kSweptSpans> lanes;
    bool left_over = false;
    const int count = revolve_spans(*region_, angle_, end_normal(), ray, true, lanes, left_over);
    if (left_over) {
        spans_in_full(ray, out);
    } else {
        append(lanes, count, out);
    }
}

void Revolve::Kernel::spans_in_full(const LocalRay<double>& ray, SpanList& out) const {
    const double length = std::sqrt(ray.dd);
    Crossings crossings;
    ProfileLine line(*region_, ray, crossings);
    line.meet_all();
    if (crossings.degenerate()) out.set_degenerate();
    bool touched = false;
    const auto touch = [&](double lo, double hi) {
        if (touched || (hi - lo) * length > kDegenerate) out.set_degenerate();
        touched = true;
        out.set_touch(lo, hi);
    };
    const auto emit = [&](const Window<double>& w) {
        LaneSpans<double, bool, 1> lanes;
        close_window(w, ray, ray.dd > 0.0, 0, lanes);
        if (lanes.degenerate) out.set_degenerate();
        if (lanes.touched) touch(lanes.touch_lo, lanes.touch_hi);
        if (lanes.valid[0]) out.push({entry(lanes), way_out(lanes)});
    };
    const auto window_of = [](const SpanEnd& enter, const SpanEnd& exit) {
        Window<double> w;
        open_window(w);
        clip_enter<double>(w, enter.s, enter.error, enter.face);
        clip_exit<double>(w, exit.s, exit.error, exit.face);
        return w;
    };
    // What lies between the cuts on the outside, when the turn is more than a half.
    LaneSpans<double, bool, 1> gap;
    gap.valid[0] = gap.degenerate = false;
    const bool convex = angle_ <= 180.0;
    if (!is_whole() && !convex) {
        Window<double> w;
        open_window(w);
        // As far as the solid may reach: ends at infinity have no error to be computed with.
        clip_enter<double>(w, -4.0 / length, 0.0, kStart);
        clip_exit<double>(w, 4.0 / length, 0.0, kEnd);
        clip_side(w, ray, -kStartNormal.x, -kStartNormal.y, kStart);
        clip_side(w, ray, -end_.x, -end_.y, kEnd);
        close_window(w, ray, ray.dd > 0.0, 0, gap);
    }
    crossings.resolve(
        *region_, false,
        [&](const SpanEnd& enter, const SpanEnd& exit) {
            Window<double> w = window_of(enter, exit);
            if (!is_whole() && convex) {
                clip_side(w, ray, kStartNormal.x, kStartNormal.y, kStart);
                clip_side(w, ray, end_.x, end_.y, kEnd);
                emit(w);
                return;
            }
            if (gap.degenerate) out.set_degenerate();
            if (!gap.valid[0]) {
                emit(w);
                return;
            }
            const SpanEnd last = entry(gap);
            const SpanEnd first = way_out(gap);
            Window<double> before = w;
            Window<double> after = w;
            clip_exit<double>(before, last.s, last.error, last.face);
            emit(before);
            clip_enter<double>(after, first.s, first.error, first.face);
            emit(after);
        },
        touch);
}

Aabb Revolve::Kernel::bounds(const Affine& map) const {
    // Over all angles, and over those at the ends and where the direction itself lies.
    const auto most = [&](Vec3 n) {
        double c = std::hypot(n.x, n.y);
        if (!is_whole()) {
            const double toward = std::atan2(n.y, n.x) * (180.0 / std::numbers::pi);
            const double turned = toward < 0.0 ? toward + 360.0 : toward;
            const SinCos end = sin_cos_degrees(angle_);
            if (turned > angle_) c = std::max(n.x, n.x * end.cos + n.y * end.sin);
        }
        return region_->support({c, n.z});
    };
    Aabb box;
    for (int i = 0; i < 3; ++i) {
        const Vec3 n = map.linear.row[static_cast<std::size_t>(i)];
        box.lo[i] = map.offset[i] - most(-n);
        box.hi[i] = map.offset[i] + most(n);
    }
    return box;
}

Vec3 Revolve::Kernel::normal(Vec3 p, std::uint16_t face) const {
    Triple<double> n{p.x, p.y, p.z};
    if (revolve_normals(*region_, end_normal(), static_cast<double>(face), true, n))
        return normal_in_full(p, face);
    return {n.x, n.y, n.z};
}

Vec3 Revolve::Kernel::normal_in_full(Vec3 p, std::uint16_t face) const {
    if (face == kStart) return kStartNormal;
    if (face == kEnd) return end_normal();
    const std::uint32_t wall = face - kFirstWall;
    const double r = std::hypot(p.x, p.y);
    Vec2 n = region_->normal({r, p.z}, wall / 2, kMostWalls);
    if ((wall & 1U) != 0) n = -n;
    if (!(r > 0.0)) return n.y != 0.0 ? Vec3{0.0, 0.0, n.y} : Vec3{n.x, 0.0, 0.0};
    return {n.x * p.x / r, n.x * p.y / r, n.y};
}

Where Revolve::Kernel::where(Vec3 p, Vec3 e) const {
    const double r = std::hypot(p.x, p.y);
    const double off = std::hypot(e.x, e.y);
    const curves::Side side = region_->where({r, p.z}, {off, e.z});
    if (side == curves::Side::out) return Where::out;
    bool on = side == curves::Side::on;
    if (!is_whole()) {
        const double slack = off + 8.0 * kUnitRoundoff * r;
        const double a = dot(kStartNormal, p);
        const double b = dot(end_normal(), p);
        // Outside of one, or of both.
        const double depth = angle_ <= 180.0 ? std::max(a, b) : std::min(a, b);
        if (depth > slack) return Where::out;
        on = on || depth > -slack;
    }
    return on ? Where::on : Where::in;
}

std::span<const std::string_view> Revolve::Kernel::faces() const {
    static constexpr std::array<std::string_view, 3> kFaces{"start", "end", "side"};
    return is_whole() ? std::span(kFaces).subspan(2) : std::span(kFaces);
}

const Schema& Revolve::schema() {
    static const std::array<Param, 2> kParams{
        Param{.name = "contour",
              .words = "contour",
              .kind = ParamKind::profile,
              .doc = "curves of radius and height, (r, z), with r >= 0; an open one is closed by "
                     "lines to the axis and along it"},
        Param{.name = "angle",
              .words = "angle",
              .kind = ParamKind::angle,
              .doc = "how far it is turned, from the x axis on; at most 360",
              .min = 0.0,
              .fallback = 360.0}};
    static const Schema kSchema{"revolve", "A contour turned about the z axis.", kParams,
                                "let vase = bspline([(0, 0), (9, 0), (12, 8), (3, 15), (4, 22), "
                                "(7, 26)], ends: \"clamped\")\n"
                                "revolve(vase, angle: 270).paint(\"peru\")"};
    return kSchema;
}

Result<Placed<Revolve::Kernel>> Revolve::prepare(std::span<const Argument> arguments) {
    const double angle = std::get<double>(arguments[1]);
    if (angle > 360.0) {
        Failure failure = fail(ErrorCode::out_of_range, "revolve: angle must be at most 360",
                               "leave it out for a whole turn");
        failure.value().argument = 1;
        return failure;
    }
    const auto refuse = [](Failure failure) {
        failure.value().message = "revolve: " + failure.value().message;
        failure.value().argument = 0;
        return failure;
    };
    curves::Outline outline = *std::get<curves::OutlinePtr>(arguments[0]);
    Box2 box;
    for (curves::Curve& curve : outline.curves) {
        if (!curve.closed) curve = closed_along_axis(curve);
        for (const curves::Span2& span : curve.spans) box.include(curves::box_of(span));
    }
    const double reach = std::max({std::fabs(box.lo.x), std::fabs(box.hi.x), 0.5 * box.size().y});
    if (!(reach >= 1e-90 && reach <= 1e90) || !is_finite(box.centre())) {
        return refuse(fail(ErrorCode::out_of_range, "the contour is too large or too small",
                           "keep its points between 1e-90 and 1e90, and apart"));
    }
    const double size = std::ldexp(1.0, std::ilogb(reach) + 1);
    const Vec2 centre{0.0, box.centre().y};
    auto region = curves::Region::make_beside_axis(outline, centre, 1.0 / size);
    if (!region) return refuse(Failure(std::move(region).error()));
    const double least = -(*region)->support({-1.0, 0.0});
    // Splines that should touch the axis may pass it by a rounding.
    if (least < -64.0 * kUnitRoundoff) {
        return refuse(fail(ErrorCode::out_of_range,
                           "the contour reaches to the other side of its axis",
                           "its radius, the first coordinate, must not be negative"));
    }
    Affine map = scaling({size, size, size});
    map.offset.z = centre.y;
    return Placed<Kernel>{Kernel(std::move(*region), angle), map};
}

std::span<const std::vector<Argument>> Revolve::examples() {
    static const std::array<std::vector<Argument>, 8> kExamples{
        {{curves::sample_goblet(), 270.0},
         {curves::sample_half_disc(), 360.0},
         {curves::sample_rectangle(), 360.0},
         {curves::sample_rectangle(), 90.0},
         {curves::sample_goblet(), 360.0},
         {curves::sample_rosette(), 360.0},
         {curves::sample_rosette(), 1.0},
         {curves::sample_half_disc(), 180.0}}};
    return kExamples;
}

}  // namespace raymo::solids
