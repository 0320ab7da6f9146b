#include "raymo/drawings/svg_path.hpp"

#include <cmath>
#include <numbers>
#include <utility>

#include "raymo/math/affine.hpp"

namespace raymo::drawings {

using curves::Span2;

void PathPen::add(const Span2& span) {
    bool is_point = true;
    for (std::size_t i = 1; i < 4; ++i) is_point = is_point && span.point(i) == span.point(0);
    if (!is_point) {
        curve_.spans.push_back(span);
        ++spans_;
    }
    at_ = span.point(3);
}

void PathPen::finish() {
    if (curve_.spans.empty()) return;
    if (at_ != start_) add(curves::segment(at_, start_));
    curve_.closed = true;
    outline_.curves.push_back(std::exchange(curve_, {}));
}

void PathPen::move(Vec2 to) {
    finish();
    at_ = start_ = to;
}
void PathPen::line(Vec2 to) { add(curves::segment(at_, to)); }
void PathPen::parabola(Vec2 b, Vec2 to) { add(curves::quadratic(at_, b, to)); }
void PathPen::cubic(Vec2 b, Vec2 c, Vec2 to) { add(curves::cubic(at_, b, c, to)); }
void PathPen::close() {
    finish();
    at_ = start_;
}

// A rational parabola raised to a cubic, as curves::arc().
void PathPen::add_arc(Vec2 corner, double weight, Vec2 to) {
    constexpr double kThird = 1.0 / 3.0;
    const Vec2 b = corner * (2.0 * weight);
    const double w = (1.0 + 2.0 * weight) * kThird;
    Span2 span;
    span.x = {at_.x, (at_.x + b.x) * kThird, (b.x + to.x) * kThird, to.x};
    span.y = {at_.y, (at_.y + b.y) * kThird, (b.y + to.y) * kThird, to.y};
    span.w = {1.0, w, w, 1.0};
    add(span);
    at_ = to;
}

void PathPen::quarter(Vec2 corner, Vec2 to) { add_arc(corner, std::numbers::sqrt2 / 2.0, to); }

void PathPen::arc(Vec2 radii, double turn, bool is_large, bool is_positive, Vec2 to) {
    const Vec2 from = at_;
    if (from == to) return;
    const SinCos phi = sin_cos_degrees(turn);
    double rx = std::fabs(radii.x);
    double ry = std::fabs(radii.y);
    const Vec2 half = (from - to) * 0.5;
    Vec2 p{(phi.cos * half.x + phi.sin * half.y) / rx, (phi.cos * half.y - phi.sin * half.x) / ry};
    const double reach = norm(p);
    // Radii of (nearly) 0 make a straight line.
    if (!(std::isfinite(reach) && reach > 0.0)) {
        line(to);
        return;
    }
    const Vec2 middle = to + half;
    const auto mapped = [&](Vec2 q) {
        return middle + Vec2{phi.cos * rx * q.x - phi.sin * ry * q.y,
                             phi.sin * rx * q.x + phi.cos * ry * q.y};
    };
    if (!is_large && reach <= std::numbers::sqrt2 / 2.0) {
        const double weight = std::sqrt((1.0 - reach) * (1.0 + reach));
        const Vec2 aside = Vec2{-p.y, p.x} * ((is_positive ? reach : -reach) / weight);
        add_arc(mapped(aside), weight, to);
        return;
    }
    Vec2 c;
    if (reach >= 1.0) {
        rx *= reach;
        ry *= reach;
        p = p * (1.0 / reach);
    } else {
        const double away = std::sqrt((1.0 - reach) * (1.0 + reach)) / reach;
        c = Vec2{p.y, -p.x} * (is_large != is_positive ? away : -away);
    }
    const Affine2 map{phi.cos * rx, -phi.sin * ry, middle.x, phi.sin * rx, phi.cos * ry, middle.y};
    constexpr double kDegrees = 180.0 / std::numbers::pi;
    const Vec2 first = p - c;
    const Vec2 last = -p - c;
    const double begin = std::atan2(first.y, first.x) * kDegrees;
    double sweep = std::atan2(cross(first, last), dot(first, last)) * kDegrees;
    // Half a turn may come out with either sign, the longer way with the wrong one.
    if (is_positive && sweep < 0.0) sweep += 360.0;
    if (!is_positive && sweep > 0.0) sweep -= 360.0;
    const int count = std::max(1, static_cast<int>(std::ceil(std::fabs(sweep) / 90.0 - 1e-12)));
    for (int i = 0; i < count; ++i) {
        Span2 span = curves::mapped(
            curves::arc(c, 1.0, begin + sweep * i / count, begin + sweep * (i + 1) / count), map);
        // Joints are shared, and the ends are those that are written.
        span.x[0] = at_.x;
        span.y[0] = at_.y;
        if (i + 1 == count) {
            span.x[3] = to.x;
            span.y[3] = to.y;
        }
        add(span);
    }
    at_ = to;
}

curves::Outline PathPen::take() {
    finish();
    return std::exchange(outline_, {});
}

namespace {

class PathReader {
public:
    PathReader(std::string_view d, const GoOn& go_on) : scanner_(d), go_on_(go_on) {}

    Read<curves::Outline> read() {
        scanner_.skip_spaces();
        if (!scanner_.is_done() && scanner_.peek() != 'M' && scanner_.peek() != 'm')
            return scanner_.expected("\"M\", with which a path begins,");
        constexpr std::uint32_t kBetweenQuestions = 4096;
        std::uint32_t steps = 0;
        while (!scanner_.is_done()) {
            const char letter = scanner_.peek();
            if (std::string_view("MmLlHhVvCcSsQqTtAaZz").find(letter) == std::string_view::npos)
                return scanner_.expected("one of the commands MLHVCSQTAZ");
            scanner_.skip();
            is_relative_ = letter >= 'a';
            command_ = static_cast<char>(is_relative_ ? letter - 32 : letter);
            scanner_.skip_spaces();
            do {
                if (++steps % kBetweenQuestions == 0 && !go_on_(pen_.bytes()))
                    return tl::unexpected(Misfit{});
                if (!run()) return tl::unexpected(std::move(misfit_));
                if (command_ == 'M') command_ = 'L';  // further pairs are lines
                if (scanner_.skip_comma() && !scanner_.is_at_number())
                    return scanner_.expected("a number");
            } while (command_ != 'Z' && scanner_.is_at_number());
        }
        return pen_.take();
    }

private:
    template <class T>
    bool take(Read<T> read, T& out) {
        if (!read) {
            misfit_ = std::move(read).error();
            return false;
        }
        out = *read;
        return true;
    }
    bool number(double& out) { return take(scanner_.number(), out); }
    /// What follows may stand behind a comma.
    bool next_number(double& out) {
        scanner_.skip_comma();
        return number(out);
    }
    bool point(Vec2& out) {
        if (!number(out.x) || !next_number(out.y)) return false;
        if (is_relative_) out = out + pen_.at();
        return true;
    }
    bool next_point(Vec2& out) {
        scanner_.skip_comma();
        return point(out);
    }
    bool flag(bool& out) {
        scanner_.skip_comma();
        return take(scanner_.flag(), out);
    }
    /// The control point that goes on smoothly: the last one, seen from the other side.
    [[nodiscard]] Vec2 reflected(bool is_known) const {
        return is_known ? pen_.at() * 2.0 - control_ : pen_.at();
    }

    bool run() {
        const char before = std::exchange(before_, command_);
        Vec2 a, b, c;
        switch (command_) {
            case 'M':
                if (!point(a)) return false;
                pen_.move(a);
                return true;
            case 'L':
                if (!point(a)) return false;
                pen_.line(a);
                return true;
            case 'H':
                if (!number(a.x)) return false;
                pen_.line({is_relative_ ? a.x + pen_.at().x : a.x, pen_.at().y});
                return true;
            case 'V':
                if (!number(a.y)) return false;
                pen_.line({pen_.at().x, is_relative_ ? a.y + pen_.at().y : a.y});
                return true;
            case 'C':
                if (!point(a) || !next_point(b) || !next_point(c)) return false;
                control_ = b;
                pen_.cubic(a, b, c);
                return true;
            case 'S':
                if (!point(b) || !next_point(c)) return false;
                a = reflected(before == 'C' || before == 'S');
                control_ = b;
                pen_.cubic(a, b, c);
                return true;
            case 'Q':
                if (!point(b) || !next_point(c)) return false;
                control_ = b;
                pen_.parabola(b, c);
                return true;
            case 'T':
                if (!point(c)) return false;
                control_ = reflected(before == 'Q' || before == 'T');
                pen_.parabola(control_, c);
                return true;
            case 'A': {
                double turn = 0.0;
                bool is_large = false, is_positive = false;
                if (!number(a.x) || !next_number(a.y) || !next_number(turn) || !flag(is_large) ||
                    !flag(is_positive) || !next_point(c)) {
                    return false;
                }
                pen_.arc(a, turn, is_large, is_positive, c);
                return true;
            }
            default:
                pen_.close();
                return true;
        }
    }

    Scanner scanner_;
    const GoOn& go_on_;
    PathPen pen_;
    Misfit misfit_;
    char command_ = 'M';
    char before_ = 'M';
    bool is_relative_ = false;
    Vec2 control_;
};

}  // namespace

Read<curves::Outline> read_path(std::string_view d, const GoOn& go_on) {
    return PathReader(d, go_on).read();
}

Read<curves::Outline> read_polygon(std::string_view points, const GoOn& go_on) {
    constexpr std::size_t kBetweenQuestions = 4096;
    PathPen pen;
    Scanner scanner(points);
    scanner.skip_spaces();
    std::size_t count = 0;
    for (Vec2 corner; !scanner.is_done(); ++count) {
        const auto number = scanner.number();
        if (!number) return tl::unexpected(number.error());
        (count % 2 == 0 ? corner.x : corner.y) = *number;
        if (count == 1) pen.move(corner);
        if (count % 2 == 1 && count > 1) pen.line(corner);
        if (scanner.skip_comma() && scanner.is_done()) return scanner.expected("a number");
        if (count % kBetweenQuestions == kBetweenQuestions - 1 && !go_on(pen.bytes()))
            return tl::unexpected(Misfit{});
    }
    if (count % 2 != 0) return tl::unexpected(Misfit{points.size(), "the last point has no y"});
    return count < 6 ? curves::Outline() : pen.take();
}

void draw_ellipse(PathPen& pen, Vec2 centre, Vec2 radii) {
    const Vec2 lo = centre - radii;
    const Vec2 hi = centre + radii;
    pen.move({hi.x, centre.y});
    pen.quarter(hi, {centre.x, hi.y});
    pen.quarter({lo.x, hi.y}, {lo.x, centre.y});
    pen.quarter(lo, {centre.x, lo.y});
    pen.quarter({hi.x, lo.y}, {hi.x, centre.y});
    pen.close();
}

void draw_rectangle(PathPen& pen, Vec2 corner, Vec2 size, Vec2 radii) {
    const Vec2 r{std::min(radii.x, 0.5 * size.x), std::min(radii.y, 0.5 * size.y)};
    const Vec2 lo = corner;
    const Vec2 hi = corner + size;
    if (!(r.x > 0.0 && r.y > 0.0)) {
        pen.move(lo);
        pen.line({hi.x, lo.y});
        pen.line(hi);
        pen.line({lo.x, hi.y});
        pen.close();
        return;
    }
    pen.move({lo.x + r.x, lo.y});
    pen.line({hi.x - r.x, lo.y});
    pen.quarter({hi.x, lo.y}, {hi.x, lo.y + r.y});
    pen.line({hi.x, hi.y - r.y});
    pen.quarter(hi, {hi.x - r.x, hi.y});
    pen.line({lo.x + r.x, hi.y});
    pen.quarter({lo.x, hi.y}, {lo.x, hi.y - r.y});
    pen.line({lo.x, lo.y + r.y});
    pen.quarter(lo, {lo.x + r.x, lo.y});
    pen.close();
}

}  // namespace raymo::drawings
