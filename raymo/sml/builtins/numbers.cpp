// Numbers. Angles are in degrees.

#include <fmt/core.h>

#include <bit>
#include <cmath>
#include <numbers>

#include "raymo/sml/builtins/call.hpp"
#include "raymo/sml/text.hpp"

namespace raymo::sml {
namespace {

constexpr double kDegrees = 180.0 / std::numbers::pi;

template <double (*kFunction)(double)>
bool of_one(Call& call, Value& out) {
    double x = 0.0;
    return call.number(0, x) && call.result(kFunction(x), out);
}

double sine(double x) { return sin_cos_degrees(x).sin; }
double cosine(double x) { return sin_cos_degrees(x).cos; }
double sign_of(double x) { return x > 0.0 ? 1.0 : (x < 0.0 ? -1.0 : 0.0); }
double arc_tangent(double x) { return std::atan(x) * kDegrees; }
double absolute(double x) { return std::fabs(x); }
double round_half_up(double x) { return std::round(x); }
double down(double x) { return std::floor(x); }
double up(double x) { return std::ceil(x); }
double exponential(double x) { return std::exp(x); }

bool tangent(Call& call, Value& out) {
    double x = 0.0;
    if (!call.number(0, x)) return false;
    const SinCos sc = sin_cos_degrees(x);
    if (sc.cos == 0.0) {
        return call.fail(0, ErrorCode::out_of_range, "there is no tangent of 90 degrees", {},
                         fmt::format("this is {}", number_text(x)));
    }
    const double eighth =
        std::fmod(std::fabs(x), 180.0);  // exact: 45 and 135 degrees give 1 and -1
    if (eighth == 45.0 || eighth == 135.0)
        return call.result((eighth == 45.0) == (x > 0.0) ? 1.0 : -1.0, out);
    return call.result(sc.sin / sc.cos, out);
}

// asin and acos: from -1 to 1.
template <double (*kFunction)(double)>
bool arc(Call& call, Value& out) {
    double x = 0.0;
    if (!call.number(0, x)) return false;
    if (!(std::fabs(x) <= 1.0)) {
        return call.fail(0, ErrorCode::out_of_range, "`x` must be from -1 to 1",
                         "clamp(x, -1, 1) keeps it there",
                         fmt::format("this is {}", number_text(x)));
    }
    return call.result(kFunction(x) * kDegrees, out);
}

bool atan2_of(Call& call, Value& out) {
    double y = 0.0;
    double x = 0.0;
    return call.number(0, y) && call.number(1, x) && call.result(std::atan2(y, x) * kDegrees, out);
}

bool square_root(Call& call, Value& out) {
    double x = 0.0;
    if (!call.number(0, x)) return false;
    if (x < 0.0) {
        return call.fail(0, ErrorCode::out_of_range, "`x` must be at least 0", {},
                         fmt::format("this is {}", number_text(x)));
    }
    return call.result(std::sqrt(x), out);
}

bool logarithm(Call& call, Value& out) {
    double x = 0.0;
    double base = std::numbers::e;
    if (!call.positive(0, x) || (call.has(1) && !call.positive(1, base))) return false;
    if (base == 1.0) {
        return call.fail(1, ErrorCode::out_of_range, "`base` must not be 1", {}, "this is 1");
    }
    if (!call.has(1)) return call.result(std::log(x), out);
    if (base == 10.0) return call.result(std::log10(x), out);
    if (base == 2.0) return call.result(std::log2(x), out);
    return call.result(std::log(x) / std::log(base), out);
}

bool power(Call& call, Value& out) {
    double x = 0.0;
    double y = 0.0;
    return call.number(0, x) && call.number(1, y) && call.result(std::pow(x, y), out);
}

bool hypotenuse(Call& call, Value& out) {
    double sum = 0.0;
    for (std::size_t i = 0; i < call.rest().size(); ++i) {
        double x = 0.0;
        if (!call.number(call.rest_begin() + i, x)) return false;
        sum = std::hypot(sum, x);
    }
    return call.result(sum, out);
}

bool clamp(Call& call, Value& out) {
    double x = 0.0;
    double low = 0.0;
    double high = 0.0;
    if (!call.number(0, x) || !call.number(1, low) || !call.number(2, high)) return false;
    if (low > high) {
        return call.fail(1, ErrorCode::out_of_range, "`low` must not be above `high`", {},
                         fmt::format("this is {}, above {}", number_text(low), number_text(high)));
    }
    return call.result(std::min(std::max(x, low), high), out);
}

// Of numbers, or of vectors element by element.
bool lerp(Call& call, Value& out) {
    double t = 0.0;
    if (!call.number(2, t)) return false;
    if (call[0].is(Tag::number) && call[1].is(Tag::number)) {
        const double a = call[0].number();
        const double b = call[1].number();
        return call.result(a * (1.0 - t) + b * t, out);
    }
    Evaluator& e = call.evaluator();
    Value from;
    Value to;
    return e.binary(Operator::multiply, call[0], Value::number(1.0 - t), call.node(), call.span(),
                    kNoNode, kNoNode, from) &&
           e.binary(Operator::multiply, call[1], Value::number(t), call.node(), call.span(),
                    kNoNode, kNoNode, to) &&
           e.binary(Operator::add, from, to, call.node(), call.span(), kNoNode, kNoNode, out);
}

// min and max: of numbers, or of one list of numbers.
bool extreme(Call& call, bool is_max, Value& out) {
    std::vector<double> values;
    if (call.rest().size() == 1 &&
        (call.rest()[0].is(Tag::list) || call.rest()[0].is(Tag::range))) {
        if (call.rest()[0].is(Tag::range)) {
            std::vector<Value> items;
            if (!call.list(call.rest_begin(), items)) return false;
            for (const Value& item : items) values.push_back(item.number());
        } else if (!call.numbers(call.rest_begin(), values)) {
            return false;
        }
    } else {
        for (std::size_t i = 0; i < call.rest().size(); ++i) {
            double x = 0.0;
            if (!call.number(call.rest_begin() + i, x)) return false;
            values.push_back(x);
        }
    }
    if (values.empty())
        return call.fail(ErrorCode::bad_argument, "there are no numbers to choose from");
    double best = values[0];
    for (const double x : values) best = is_max ? std::max(best, x) : std::min(best, x);
    return call.result(best, out);
}
bool minimum(Call& call, Value& out) { return extreme(call, false, out); }
bool maximum(Call& call, Value& out) { return extreme(call, true, out); }

// The seed is mixed once, so that neighbouring seeds give unlike sequences.
bool random(Call& call, Value& out) {
    double seed = 0.0;
    if (!call.number(0, seed)) return false;
    std::uint64_t bits = std::bit_cast<std::uint64_t>(seed + 0.0);  // -0 is 0
    bits = (bits ^ (bits >> 33)) * 0xFF51AFD7ED558CCDULL;
    bits = (bits ^ (bits >> 33)) * 0xC4CEB9FE1A85EC53ULL;
    out = Value::object(new RandomObject(bits ^ (bits >> 33)));
    return true;
}

}  // namespace

std::span<const BuiltinRow> number_rows() {
    static constexpr auto kRows = std::to_array<BuiltinRow>({
        {"sin", "x", &of_one<sine>, "Sine of degrees; exact at multiples of 90 and at 30."},
        {"cos", "x", &of_one<cosine>, "Cosine of degrees."},
        {"tan", "x", &tangent, "Tangent of degrees."},
        {"asin", "x", &arc<std::asin>, "Angle in degrees, -90 to 90."},
        {"acos", "x", &arc<std::acos>, "Angle in degrees, 0 to 180."},
        {"atan", "x", &of_one<arc_tangent>, "Angle in degrees, -90 to 90."},
        {"atan2", "y x", &atan2_of, "Angle of (x, y) in degrees, -180 to 180."},
        {"sqrt", "x", &square_root, "Square root."},
        {"abs", "x", &of_one<absolute>, "Size without sign."},
        {"floor", "x", &of_one<down>, "Next whole number below."},
        {"ceil", "x", &of_one<up>, "Next whole number above."},
        {"round", "x", &of_one<round_half_up>, "Nearest whole number; halves away from 0."},
        {"sign", "x", &of_one<sign_of>, "-1, 0 or 1."},
        {"exp", "x", &of_one<exponential>, "e to the power x."},
        {"log", "x base?", &logarithm, "Logarithm, natural without a base."},
        {"pow", "x y", &power, "x ^ y."},
        {"hypot", "x*", &hypotenuse, "Length of the vector of its arguments."},
        {"min", "x*", &minimum, "Smallest of its arguments or of a list."},
        {"max", "x*", &maximum, "Largest of its arguments or of a list."},
        {"clamp", "x low high", &clamp, "x, kept between two limits."},
        {"lerp", "a b t", &lerp, "a (1 - t) + b t, of numbers or vectors."},
        {"random", "seed", &random,
         "A function that gives numbers from 0 up to 1, the same on every machine."},
    });
    return kRows;
}

}  // namespace raymo::sml
