// Which of the five surfaces bound a leaf.
//
// A kernel's frame may be mapped to the body's by any affine map. Planes stay planes; a cylinder or a cone stays one where
// its two cross axes keep one length and all three stay at right angles, a sphere or a torus where all lengths are equal,
// too. How near to that a map has to be follows from the roundings of the maps it was made of, each some units of the last
// place: kShape allows for 2^12 of them, and a surface that differs so little differs by 2^-40 of its size.
#include <algorithm>
#include <array>
#include <cmath>

#include "raymo/blends/body.hpp"
#include "raymo/solids/crossings.hpp"

namespace raymo::blends {
namespace {

constexpr double kShape = 0x1p-40;

bool is_across(Vec3 a, Vec3 b) { return std::fabs(dot(a, b)) <= kShape * norm(a) * norm(b); }
bool is_as_long(Vec3 a, Vec3 b) {
    return std::fabs(norm(a) - norm(b)) <= kShape * std::max(norm(a), norm(b));
}

/// Whether circles about z stay circles at right angles to the image of z.
bool keeps_round(const Mat3& m) {
    return is_across(m.column(0), m.column(1)) && is_across(m.column(0), m.column(2)) &&
           is_across(m.column(1), m.column(2)) && is_as_long(m.column(0), m.column(1));
}
bool keeps_shape(const Mat3& m) { return keeps_round(m) && is_as_long(m.column(0), m.column(2)); }

class Faces {
public:
    Faces(Leaf& leaf, std::uint32_t index, std::vector<Face>& out)
        : leaf_(leaf),
          index_(index),
          out_(out),
          across_(0.5 * (norm(leaf.map.linear.column(0)) + norm(leaf.map.linear.column(1)))),
          axis_(unit(leaf.map.linear.column(2))) {}

    /// The plane through `at` with the outward normal `n`, both in the kernel's frame.
    void plane(Vec3 at, Vec3 n, std::string_view name) {
        Surface s;
        s.kind = SurfaceKind::plane;
        s.point = leaf_.map(at);
        s.axis = unit(transposed_times(leaf_.inverse.linear, n));
        add(s, 1.0, name);
    }
    void cylinder(Vec3 on_axis, double radius, double side, std::string_view name) {
        round(SurfaceKind::cylinder, on_axis, radius, 0.0, side, name);
    }
    /// About the z axis, through two points (radius, z) of it.
    void cone(Vec2 a, Vec2 b, double side, std::string_view name) {
        if (a.x == b.x) return cylinder({}, a.x, side, name);
        if (a.y == b.y) return;
        const double apex = a.y + a.x * (b.y - a.y) / (a.x - b.x);
        // Opening towards the wider end.
        const double up = (a.x > b.x) == (a.y > b.y) ? 1.0 : -1.0;
        const double rise = norm(leaf_.map.linear.column(2)) * std::fabs(b.y - a.y);
        const double run = across_ * std::fabs(b.x - a.x);
        Surface s;
        s.kind = SurfaceKind::cone;
        s.point = leaf_.map(Vec3{0, 0, apex});
        s.axis = axis_ * up;
        s.sine = run / std::hypot(rise, run);
        s.cosine = rise / std::hypot(rise, run);
        add(s, side, name);
    }
    void sphere(Vec3 centre, double radius, double side, std::string_view name) {
        round(SurfaceKind::sphere, centre, radius, 0.0, side, name);
    }
    void torus(double z, double ring, double tube, double side, std::string_view name) {
        round(SurfaceKind::torus, {0, 0, z}, ring, tube, side, name);
    }
    /// A run of the kernel's frame, with its left side solid if `left` > 0: swept along z, or turned about it.
    void swept(std::vector<curves::Span2> spans, bool is_closed, double left, std::string_view name,
               bool is_turned) {
        const Mat3& m = leaf_.map.linear;
        // Scaled to lengths of the body.
        const Affine2 scale{.xx = across_, .yy = is_turned ? norm(m.column(2)) : across_};
        for (curves::Span2& span : spans) span = curves::mapped(span, scale);
        if (left < 0.0) turn_round(spans);
        Surface s;
        s.kind = is_turned ? SurfaceKind::turned : SurfaceKind::wall;
        s.point = leaf_.map.offset;
        s.axis = axis_;
        s.across = unit(m.column(0));
        s.up = unit(m.column(1));
        s.run = std::make_shared<const Run>(std::move(spans), is_closed);
        add(s, 1.0, name);
    }
    /// The same, of the plane z = -1 of the kernel's frame, swept towards the point z = `apex` of the axis. Under any map.
    void leaning(std::vector<curves::Span2> spans, bool is_closed, double left, double apex,
                 std::string_view name) {
        const Mat3& m = leaf_.map.linear;
        Surface s;
        s.kind = SurfaceKind::leaning;
        s.across = unit(m.column(0));
        s.up = unit(m.column(1) - s.across * dot(m.column(1), s.across));
        const Vec3 base = leaf_.map(Vec3{0, 0, -1});
        const Vec3 top = leaf_.map(Vec3{0, 0, apex});
        s.axis = cross(s.across, s.up);
        if (dot(base - top, s.axis) < 0.0) s.axis = -s.axis;
        s.height = dot(base - top, s.axis);
        s.point = top + s.axis * s.height;
        const Vec3 origin = base - s.point;
        const Affine2 map{.xx = dot(m.column(0), s.across),
                          .xy = dot(m.column(1), s.across),
                          .x = dot(origin, s.across),
                          .yx = 0.0,
                          .yy = dot(m.column(1), s.up),
                          .y = dot(origin, s.up)};
        for (curves::Span2& span : spans) span = curves::mapped(span, map);
        if (left < 0.0) turn_round(spans);
        s.run = std::make_shared<const Run>(std::move(spans), is_closed);
        add(s, 1.0, name);
    }
    void unknown(std::string_view why) { leaf_.unknown = why; }
    [[nodiscard]] bool is_round() const { return keeps_round(leaf_.map.linear); }
    [[nodiscard]] bool is_similar() const { return keeps_shape(leaf_.map.linear); }

    void add(const Surface& surface, double side, std::string_view name) {
        out_.push_back({surface, side, index_, name});
    }

private:
    static void turn_round(std::vector<curves::Span2>& spans) {
        std::reverse(spans.begin(), spans.end());
        for (curves::Span2& span : spans) span = curves::reversed(span);
    }
    void round(SurfaceKind kind, Vec3 at, double radius, double tube, double side,
               std::string_view name) {
        Surface s;
        s.kind = kind;
        s.point = leaf_.map(at);
        s.axis = axis_;
        s.radius = radius * across_;
        s.tube = tube * across_;
        add(s, side, name);
    }

    Leaf& leaf_;
    std::uint32_t index_;
    std::vector<Face>& out_;
    double across_;  ///< length of the images of x and y
    Vec3 axis_;
};

constexpr std::string_view kStretched = "it is stretched, so that its surface is none of those";

/// What a span of a contour is.
struct Shape {
    enum Kind : std::uint8_t { other, line, circle } kind = other;
    Vec2 centre;
    double radius = 0.0;
    double turn = 0.0;  ///< of a circle: +1 counter-clockwise
};

Shape shape_of(const curves::Piece& piece) {
    const Vec2 a = piece.point(0);
    const Vec2 d = piece.point(3);
    const Vec2 chord = d - a;
    const double length = norm(chord);
    if (!(length > 0.0)) return {};
    double bulge = 0.0;
    for (std::size_t i = 1; i < 3; ++i) {
        bulge = std::max(bulge, std::fabs(cross(chord, piece.point(i) - a)) / length);
    }
    const double noise = kShape * (length + max_norm(a) + max_norm(d));
    if (bulge <= noise) return {Shape::line, {}, 0.0, 0.0};
    const Vec2 b = curves::point_at(piece, 0.5);
    const Vec2 p = b - a;
    const double area = cross(p, chord);
    if (area == 0.0) return {};
    const Vec2 m = (dot(p, p) / (2.0 * area)) * chord - (dot(chord, chord) / (2.0 * area)) * p;
    const Vec2 centre = a - Vec2{-m.y, m.x};
    const double radius = norm(a - centre);
    for (const double u : {0.125, 0.25, 0.375, 0.625, 0.75, 0.875}) {
        // The centre is as uncertain as the radius is long for the chord.
        const double slack = noise * (1.0 + radius * radius / (length * length));
        if (!(std::fabs(norm(curves::point_at(piece, u) - centre) - radius) <= slack)) return {};
    }
    return {Shape::circle, centre, radius, area > 0.0 ? 1.0 : -1.0};
}

/// The outward normal of a straight piece.
Vec2 normal_of(const curves::Piece& piece, double left) {
    const Vec2 d = piece.point(3) - piece.point(0);
    return Vec2{d.y, -d.x} * left;
}

/// The free-form pieces of a region, joined to smooth runs: add(spans, is_closed, left) for each.
template <class Add>
void add_runs(const curves::Region& region, const std::vector<bool>& is_free, Add&& add) {
    const auto& pieces = region.pieces();
    // Whether a piece goes on where the one before it ends.
    const auto follows = [&](std::size_t i) {
        const std::size_t before = pieces[i].previous;
        return is_free[before] && pieces[before].next == i && !pieces[before].ends_in_corner;
    };
    std::vector<bool> done(pieces.size(), false);
    const auto take = [&](std::size_t first) {
        std::vector<curves::Span2> spans;
        const double left = region.left_side(pieces[first]);
        std::size_t i = first;
        do {
            done[i] = true;
            spans.push_back(pieces[i]);
            i = pieces[i].next;
        } while (!done[i] && is_free[i] && follows(i));
        const bool is_closed = i == first && follows(first);
        if (left == 0.0) return;
        if (i == first && !is_closed && spans.size() > 1) {
            // A curve that meets itself in a corner is two faces, which go over into each other somewhere else.
            const auto half = spans.begin() + static_cast<std::ptrdiff_t>(spans.size() / 2);
            add(std::vector(half, spans.end()), false, left);
            spans.erase(half, spans.end());
        }
        add(std::move(spans), is_closed, left);
    };
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        if (is_free[i] && !done[i] && !follows(i)) take(i);
    }
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        if (is_free[i] && !done[i]) take(i);
    }
}

/// Which pieces of a region are free-form: those of which told(piece, shape, left) is false, `left` as Region::left_side() says.
template <class Told>
std::vector<bool> free_pieces(const curves::Region& region, Told&& told) {
    const auto& pieces = region.pieces();
    std::vector<bool> is_free(pieces.size(), false);
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const double left = region.left_side(pieces[i]);
        is_free[i] = left != 0.0 && !told(pieces[i], shape_of(pieces[i]), left);
    }
    return is_free;
}

/// The same of what is swept to or along a direction, where all pieces count as free-form that go over smoothly into one that is not
/// is_known(shape), one after another: their wall has no end there that anything could be cut at.
template <class Known, class Tell>
std::vector<bool> free_wall_pieces(const curves::Region& region, Known&& is_known, Tell&& tell) {
    std::vector<bool> is_free = free_pieces(
        region, [&](const curves::Piece&, const Shape& shape, double) { return is_known(shape); });
    const auto& pieces = region.pieces();
    std::vector<std::size_t> open;
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        if (is_free[i]) open.push_back(i);
    }
    const auto join = [&](std::size_t i) {
        if (is_free[i] || region.left_side(pieces[i]) == 0.0) return;
        is_free[i] = true;
        open.push_back(i);
    };
    while (!open.empty()) {
        const std::size_t i = open.back();
        open.pop_back();
        if (!pieces[i].ends_in_corner) join(pieces[i].next);
        if (!pieces[pieces[i].previous].ends_in_corner) join(pieces[i].previous);
    }
    for (std::size_t i = 0; i < pieces.size(); ++i) {
        const double left = region.left_side(pieces[i]);
        if (left != 0.0 && !is_free[i]) tell(pieces[i], shape_of(pieces[i]), left);
    }
    return is_free;
}

/// Of a conic sweep: straight lines sweep planes, circles about its axis cones, all others leaning walls.
void leaning_walls(const solids::ContourSweep& kernel, Faces& faces) {
    faces.plane({0, 0, -1}, {0, 0, -1}, "bottom");
    if (kernel.ratio() > 0.0) faces.plane({0, 0, 1}, {0, 0, 1}, "top");
    const double ratio = kernel.ratio();
    const auto is_known = [&](const Shape& shape) {
        return shape.kind == Shape::line || (shape.kind == Shape::circle && faces.is_round() &&
                                             norm(shape.centre) <= kShape * shape.radius);
    };
    const auto tell = [&](const curves::Piece& piece, const Shape& shape, double left) {
        if (shape.kind == Shape::line) {
            // On the way up a point of the line goes by (ratio - 1) / 2 of itself.
            const Vec2 a = piece.point(0);
            const Vec2 n = normal_of(piece, left);
            faces.plane({a.x, a.y, -1}, {n.x, n.y, 0.5 * (1.0 - ratio) * dot(n, a)}, "wall");
        } else {
            faces.cone({shape.radius, -1.0}, {ratio * shape.radius, 1.0}, left * shape.turn,
                       "wall");
        }
    };
    const double apex = -1.0 + 2.0 / (1.0 - ratio);
    add_runs(kernel.region(), free_wall_pieces(kernel.region(), is_known, tell),
             [&](auto spans, bool is_closed, double left) {
                 faces.leaning(std::move(spans), is_closed, left, apex, "wall");
             });
}

void walls(const solids::ContourSweep& kernel, Faces& faces) {
    if (kernel.ratio() != 1.0) return leaning_walls(kernel, faces);
    faces.plane({0, 0, -1}, {0, 0, -1}, "bottom");
    faces.plane({0, 0, 1}, {0, 0, 1}, "top");
    const auto is_known = [&](const Shape& shape) {
        return shape.kind != Shape::other || !faces.is_round();
    };
    const auto tell = [&](const curves::Piece& piece, const Shape& shape, double left) {
        if (shape.kind == Shape::line) {
            const Vec2 a = piece.point(0);
            const Vec2 n = normal_of(piece, left);
            faces.plane({a.x, a.y, 0}, {n.x, n.y, 0}, "wall");
        } else if (faces.is_round()) {
            faces.cylinder({shape.centre.x, shape.centre.y, 0}, shape.radius, left * shape.turn,
                           "wall");
        } else {
            faces.unknown(kStretched);
        }
    };
    add_runs(kernel.region(), free_wall_pieces(kernel.region(), is_known, tell),
             [&](auto spans, bool is_closed, double left) {
                 faces.swept(std::move(spans), is_closed, left, "wall", false);
             });
}

void turned_walls(const solids::Revolve::Kernel& kernel, Faces& faces) {
    if (!faces.is_round()) return faces.unknown(kStretched);
    if (kernel.angle() < 360.0) {
        faces.plane({}, {0, -1, 0}, "start");
        faces.plane({}, kernel.end_normal(), "end");
    }
    const auto told = [&](const curves::Piece& piece, const Shape& shape, double left) {
        const Vec2 a = piece.point(0);
        const Vec2 b = piece.point(3);
        if (shape.kind == Shape::line) {
            const Vec2 n = normal_of(piece, left);
            // Within rounding of level.
            if (std::fabs(b.y - a.y) <= kShape * std::fabs(b.x - a.x)) {
                faces.plane({0, 0, a.y}, {0, 0, n.y}, "wall");
            } else {
                const bool upright = std::fabs(b.x - a.x) <= kShape * std::fabs(b.y - a.y);
                faces.cone(a, upright ? Vec2{a.x, b.y} : b, n.x > 0.0 ? 1.0 : -1.0, "wall");
            }
            return true;
        }
        if (shape.kind != Shape::circle || !faces.is_similar()) return false;
        const double side = left * shape.turn;
        if (std::fabs(shape.centre.x) <= kShape * shape.radius) {
            faces.sphere({0, 0, shape.centre.y}, shape.radius, side, "wall");
        } else {
            faces.torus(shape.centre.y, shape.centre.x, shape.radius, side, "wall");
        }
        return true;
    };
    add_runs(kernel.region(), free_pieces(kernel.region(), told),
             [&](auto spans, bool is_closed, double left) {
                 faces.swept(std::move(spans), is_closed, left, "wall", true);
             });
}

struct AddFaces {
    Faces& faces;

    void operator()(const solids::Block::Kernel& kernel) const {
        for (std::uint16_t i = 0; i < 6; ++i) {
            const Vec3 n = unit(kernel.normal({}, i));
            faces.plane(n, n, kernel.faces()[i]);
        }
    }
    void operator()(const solids::Sphere::Kernel&) const {
        if (!faces.is_similar()) return faces.unknown(kStretched);
        faces.sphere({}, 1.0, 1.0, "surface");
    }
    void operator()(const solids::Cylinder::Kernel& kernel) const {
        faces.plane({0, 0, -1}, {0, 0, -1}, kernel.faces()[1]);
        faces.plane({0, 0, 1}, {0, 0, 1}, kernel.faces()[2]);
        if (!faces.is_round()) return faces.unknown(kStretched);
        faces.cylinder({}, 1.0, 1.0, kernel.faces()[0]);
    }
    void operator()(const solids::Cone::Kernel& kernel) const {
        faces.plane({0, 0, -1}, {0, 0, -1}, kernel.faces()[1]);
        if (kernel.ratio() > 0.0) faces.plane({0, 0, 1}, {0, 0, 1}, kernel.faces()[2]);
        if (!faces.is_round()) return faces.unknown(kStretched);
        faces.cone({1.0, -1.0}, {kernel.ratio(), 1.0}, 1.0, kernel.faces()[0]);
    }
    void operator()(const solids::Torus::Kernel& kernel) const {
        if (!faces.is_similar()) return faces.unknown(kStretched);
        faces.torus(0.0, kernel.major_radius(), kernel.minor_radius(), 1.0, "surface");
    }
    void operator()(const solids::Halfspace::Kernel&) const { faces.plane({}, {0, 0, 1}, "plane"); }
    void operator()(const solids::Prism::Kernel& kernel) const { walls(kernel, faces); }
    void operator()(const solids::Conic::Kernel& kernel) const { walls(kernel, faces); }
    void operator()(const solids::Revolve::Kernel& kernel) const { turned_walls(kernel, faces); }
    template <class K>
    void operator()(const K&) const {
        faces.unknown("it is bounded by none of the surfaces that can be");
    }
};

}  // namespace

void add_faces(Leaf& leaf, std::uint32_t index, std::vector<Face>& out) {
    leaf.first_face = out.size();
    Faces faces(leaf, index, out);
    std::visit(AddFaces{faces}, csg::as_leaf(leaf.solid.node()).solid.kernel);
    leaf.face_count = out.size() - leaf.first_face;
}

}  // namespace raymo::blends
