// Vectors: lists of numbers.

#include <fmt/core.h>

#include <cmath>
#include <numbers>

#include "raymo/sml/builtins/call.hpp"

namespace raymo::sml {
namespace {

bool two(Call& call, std::vector<double>& a, std::vector<double>& b) {
    if (!call.numbers(0, a) || !call.numbers(1, b)) return false;
    if (a.size() == b.size()) return true;
    return call.fail(1, ErrorCode::bad_argument, "the vectors must have the same length", {},
                     fmt::format("these have {} and {} numbers", a.size(), b.size()));
}

double length(const std::vector<double>& v) {
    double sum = 0.0;
    for (const double x : v) sum = std::hypot(sum, x);
    return sum;
}

bool dot_product(Call& call, Value& out) {
    std::vector<double> a;
    std::vector<double> b;
    if (!two(call, a, b)) return false;
    double sum = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) sum += a[i] * b[i];
    return call.result(sum, out);
}

bool cross_product(Call& call, Value& out) {
    Vec3 a;
    Vec3 b;
    if (!call.vector(0, a) || !call.vector(1, b)) return false;
    const Vec3 c = cross(a, b);
    if (!is_finite(c)) return call.fail(ErrorCode::evaluation, "the result is not a finite number");
    out = Value::vector(c);
    return true;
}

bool norm_of(Call& call, Value& out) {
    std::vector<double> v;
    return call.numbers(0, v) && call.result(length(v), out);
}

bool unit_of(Call& call, Value& out) {
    std::vector<double> v;
    if (!call.numbers(0, v)) return false;
    const double size = length(v);
    if (!(size > 0.0) || !std::isfinite(size)) {
        return call.fail(0, ErrorCode::out_of_range, "a vector of length 0 has no direction", {},
                         "this has no direction");
    }
    std::vector<Value> items;
    for (const double x : v) items.push_back(Value::number(x / size));
    out = Value::list(std::move(items));
    return true;
}

bool angle_between(Call& call, Value& out) {
    std::vector<double> a;
    std::vector<double> b;
    if (!two(call, a, b)) return false;
    const double la = length(a);
    const double lb = length(b);
    for (std::size_t i = 0; i < 2; ++i) {
        const double size = i == 0 ? la : lb;
        if (size > 0.0 && std::isfinite(size)) continue;
        return call.fail(i, ErrorCode::out_of_range, "a vector of length 0 has no direction", {},
                         "this has no direction");
    }
    // Kahan: accurate for small angles and for angles near 180 degrees.
    double minus = 0.0;
    double plus = 0.0;
    for (std::size_t i = 0; i < a.size(); ++i) {
        const double x = a[i] / la;
        const double y = b[i] / lb;
        minus = std::hypot(minus, x - y);
        plus = std::hypot(plus, x + y);
    }
    return call.result(2.0 * std::atan2(minus, plus) * 180.0 / std::numbers::pi, out);
}

bool polar(Call& call, Value& out) {
    double r = 0.0;
    double angle = 0.0;
    if (!call.number(0, r) || !call.number(1, angle)) return false;
    const SinCos sc = sin_cos_degrees(angle);
    out = Value::list({Value::number(r * sc.cos), Value::number(r * sc.sin)});
    return true;
}

}  // namespace

std::span<const BuiltinRow> vector_rows() {
    static constexpr auto kRows = std::to_array<BuiltinRow>({
        {"dot", "a b", &dot_product, "Inner product."},
        {"cross", "a b", &cross_product, "Vector product of two vectors of three numbers."},
        {"norm", "v", &norm_of, "Length."},
        {"unit", "v", &unit_of, "The same direction with length 1."},
        {"angle_between", "a b", &angle_between, "Angle in degrees, 0 to 180."},
        {"polar", "r angle", &polar, "(r cos angle, r sin angle)."},
    });
    return kRows;
}

}  // namespace raymo::sml
