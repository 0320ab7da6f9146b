// What operators do to values, equality, and how values are shown.

#include <fmt/core.h>

#include <cmath>

#include "raymo/core/assert.hpp"
#include "raymo/curves/contour.hpp"
#include "raymo/sml/arithmetic.hpp"
#include "raymo/sml/evaluate.hpp"
#include "raymo/sml/text.hpp"

namespace raymo::sml {
namespace {

constexpr std::size_t kShownDepth = 20;

bool is_comparison(Operator op) { return op >= Operator::less && op <= Operator::greater_equal; }

bool compare(Operator op, int order) {
    switch (op) {
        case Operator::less:
            return order < 0;
        case Operator::less_equal:
            return order <= 0;
        case Operator::greater:
            return order > 0;
        default:
            return order >= 0;
    }
}

double arithmetic(Operator op, double a, double b) {
    switch (op) {
        case Operator::add:
            return a + b;
        case Operator::subtract:
            return a - b;
        case Operator::multiply:
            return a * b;
        case Operator::divide:
            return a / b;
        case Operator::modulo:
            return remainder_of(a, b);
        default:
            return std::pow(a, b);
    }
}

// What an operand is, shortly: a number itself, of all else its kind.
std::string operand_text(const Value& value) {
    return value.is(Tag::number) ? number_text(value.number()) : std::string(kind_text(value));
}

std::string_view remedy(Operator op, const Value& a, const Value& b) {
    if (a.is(Tag::string) || b.is(Tag::string)) return "to make a text, write \"${a} ${b}\"";
    if (op == Operator::intersect && (a.is(Tag::boolean) || b.is(Tag::boolean)))
        return "write `and`";
    if (a.is(Tag::function) || b.is(Tag::function) || a.is(Tag::builtin) || b.is(Tag::builtin)) {
        return "call the function: f(...)";
    }
    const bool has_solid = a.is(Tag::solid) || b.is(Tag::solid);
    const bool has_contour = a.is(Tag::contour) || b.is(Tag::contour);
    const bool has_path = a.is(Tag::path) || b.is(Tag::path);
    const bool has_number = a.is(Tag::number) || b.is(Tag::number);
    if (has_solid && has_contour)
        return "make a solid of the contour first: prism(contour, height)";
    if (has_path && (has_solid || has_contour || (a.is(Tag::path) && b.is(Tag::path))))
        return "make a solid of the path first: sweep(path)";
    if (a.is(Tag::mesh) || b.is(Tag::mesh)) return "make a solid of the mesh first: smooth(mesh)";
    if ((a.is(Tag::solid) || a.is(Tag::contour)) && b.is(Tag::list)) return "use union(list)";
    if (op == Operator::intersect && !has_solid && !has_contour && !has_path)
        return "`&` intersects solids; to join conditions, write `and`";
    if ((has_solid || has_contour || has_path) && has_number) {
        const bool sizes = op == Operator::multiply || op == Operator::divide;
        if (has_contour) {
            return sizes ? "to change its size, write contour.scale(factor)"
                         : "to move it, write contour.move(x, y)";
        }
        if (has_path) {
            return sizes ? "to change its size, write path.scale(factor)"
                         : "to move it, write path.move(x, y, z)";
        }
        return sizes ? "to change its size, write solid.scale(factor)"
                     : "to move it, write solid.move(x, y, z)";
    }
    if (op == Operator::divide && b.is(Tag::list))
        return "divide by each of its elements: [for x in list: a / x]";
    if (a.is(Tag::list) || b.is(Tag::list))
        return "work on each of its elements: [for x in list: ...]";
    return {};
}

}  // namespace

bool Evaluator::combine(csg::Op op, std::vector<csg::Solid> operands, NodeId site, SourceSpan where,
                        Value& out) {
    if (operands.size() == 1) {
        out = Value::solid(std::move(operands.front()));
        return true;
    }
    out = Value::solid(csg::boolean(op, std::move(operands), where));
    return made(out.solid(), false, site);
}

bool Evaluator::combine(curves::ContourOp op, std::vector<curves::Contour> operands, NodeId site,
                        Value& out) {
    RAYMO_ASSERT(operands.size() > 1);
    curves::Contour contour = curves::combined(op, std::move(operands));
    const double bytes = curves::bytes_of(*contour);
    return made(std::move(contour), bytes, site, out);
}

bool Evaluator::binary(Operator op, const Value& a, const Value& b, NodeId site, SourceSpan where,
                       NodeId left, NodeId right, Value& out) {
    if (op == Operator::equal || op == Operator::not_equal) {
        bool same = false;
        if (!equal(a, b, site, same)) return false;
        out = Value::boolean(same == (op == Operator::equal));
        return true;
    }
    if (op == Operator::in) {
        bool found = false;
        if (b.is(Tag::list)) {
            for (const Value& item : b.items()) {
                if (!equal(a, item, site, found) || !step(site)) return false;
                if (found) break;
            }
        } else if (b.is(Tag::range) && a.is(Tag::number)) {
            const auto& range = b.as<RangeObject>();
            const double i = std::round((a.number() - range.low) / range.step);
            found = i >= 0.0 && i < range.count && range.at(i) == a.number();
        } else if (b.is(Tag::string) && a.is(Tag::string)) {
            found = b.string().find(a.string()) != std::string::npos;
        } else if (b.is(Tag::record) && a.is(Tag::string)) {
            const Symbol symbol = program_.symbols.find(a.string());
            found = symbol != kNoSymbol && b.as<RecordObject>().find(symbol) != nullptr;
        } else {
            return fail(ErrorCode::bad_argument, right == kNoNode ? where : span(right),
                        "`in` needs a list, a range, a string or a record", {},
                        fmt::format("this is {}", kind_text(b)));
        }
        out = Value::boolean(found);
        return true;
    }
    if (a.is(Tag::number) && b.is(Tag::number)) {
        if (is_comparison(op)) {
            const int order = a.number() < b.number() ? -1 : (a.number() > b.number() ? 1 : 0);
            out = Value::boolean(compare(op, order));
            return true;
        }
        if (op != Operator::intersect) {
            const bool divides = op == Operator::divide || op == Operator::modulo;
            if (divides && b.number() == 0.0) {
                return fail(ErrorCode::evaluation, right == kNoNode ? where : span(right),
                            fmt::format("`{}`: division by 0", spelling(op)), {}, "this is 0");
            }
            const double result = arithmetic(op, a.number(), b.number());
            if (!std::isfinite(result)) {
                return fail(ErrorCode::evaluation, where,
                            fmt::format("`{}`: the result is not a finite number", spelling(op)),
                            {},
                            fmt::format("this is {} {} {}", number_text(a.number()), spelling(op),
                                        number_text(b.number())));
            }
            out = Value::number(result);
            return true;
        }
    }
    if (a.is(Tag::string) && b.is(Tag::string)) {
        if (is_comparison(op)) {
            out = Value::boolean(compare(op, a.string().compare(b.string())));
            return true;
        }
        if (op == Operator::add) {
            if (!room(static_cast<double>(a.string().size() + b.string().size()), site))
                return false;
            out = Value::string(a.string() + b.string());
            return true;
        }
    }
    const bool joins = op == Operator::add || op == Operator::subtract;
    if (joins || op == Operator::intersect) {
        if (a.is(Tag::solid) && b.is(Tag::solid)) {
            const csg::Op boolean = op == Operator::add        ? csg::Op::unite
                                    : op == Operator::subtract ? csg::Op::difference
                                                               : csg::Op::intersection;
            return combine(boolean, {a.solid(), b.solid()}, site, where, out);
        }
        if (a.is(Tag::contour) && b.is(Tag::contour)) {
            const curves::ContourOp boolean = op == Operator::add ? curves::ContourOp::unite
                                              : op == Operator::subtract
                                                  ? curves::ContourOp::difference
                                                  : curves::ContourOp::intersection;
            return combine(boolean, {a.as<ContourObject>().value, b.as<ContourObject>().value},
                           site, out);
        }
        // `nothing` is the empty solid and the empty contour: a sum may begin with it, or have a part that is left out.
        if (joins && (a.is(Tag::solid) || a.is(Tag::contour)) && b.is(Tag::nothing)) {
            out = a;
            return true;
        }
        if (op == Operator::add && a.is(Tag::nothing) &&
            (b.is(Tag::solid) || b.is(Tag::contour) || b.is(Tag::nothing))) {
            out = b;
            return true;
        }
    }
    const bool elementwise = joins || op == Operator::multiply || op == Operator::divide;
    const bool lists = a.is(Tag::list) || b.is(Tag::list);
    if (elementwise && lists && (a.is(Tag::list) || a.is(Tag::number)) &&
        (b.is(Tag::list) || b.is(Tag::number)) && !(op == Operator::divide && b.is(Tag::list))) {
        const bool both = a.is(Tag::list) && b.is(Tag::list);
        if (both && a.items().size() != b.items().size()) {
            return fail(
                ErrorCode::bad_argument, where,
                fmt::format("`{}` needs lists of the same length", spelling(op)),
                op == Operator::add ? "to join lists, write concat(a, b)" : "",
                fmt::format("these have {} and {} elements", a.items().size(), b.items().size()));
        }
        const std::size_t size = a.is(Tag::list) ? a.items().size() : b.items().size();
        ++depth_;
        bool good = stack_left(site) && room(16.0 * static_cast<double>(size), site);
        std::vector<Value> items(good ? size : 0);
        for (std::size_t i = 0; i < size && good; ++i) {
            const Value& x = a.is(Tag::list) ? a.items()[i] : a;
            const Value& y = b.is(Tag::list) ? b.items()[i] : b;
            good = step(site) && binary(op, x, y, site, where, left, right, items[i]);
        }
        --depth_;
        if (good) out = Value::list(std::move(items));
        return good;
    }
    return fail(
        ErrorCode::bad_argument, where,
        fmt::format("`{}` does not go with {} and {}", spelling(op), kind_text(a), kind_text(b)),
        std::string(remedy(op, a, b)),
        fmt::format("this is {} {} {}", operand_text(a), spelling(op), operand_text(b)));
}

bool Evaluator::equal(const Value& a, const Value& b, NodeId site, bool& out) {
    out = false;
    if (a.tag() != b.tag()) return true;
    switch (a.tag()) {
        case Tag::number:
            out = a.number() == b.number();
            return true;
        case Tag::boolean:
            out = a.boolean() == b.boolean();
            return true;
        case Tag::nothing:
        case Tag::missing:
            out = true;
            return true;
        case Tag::builtin:
            out = a.builtin() == b.builtin();
            return true;
        case Tag::solid:
            out = a.solid() == b.solid();
            return true;
        case Tag::string:
            out = a.string() == b.string();
            return true;
        case Tag::material:
            out = a.as<MaterialObject>().value == b.as<MaterialObject>().value;
            return true;
        case Tag::transform:
            out = a.as<TransformObject>().value == b.as<TransformObject>().value;
            return true;
        case Tag::camera:
            out = a.as<CameraObject>().value == b.as<CameraObject>().value;
            return true;
        case Tag::light:
            out = a.as<LightObject>().value == b.as<LightObject>().value;
            return true;
        case Tag::contour:
            out = curves::is_equal(a.as<ContourObject>().value, b.as<ContourObject>().value);
            return true;
        case Tag::path: {
            const auto& x = a.as<PathObject>().value;
            const auto& y = b.as<PathObject>().value;
            out = x == y || *x == *y;
            return true;
        }
        case Tag::mesh: {
            const auto& x = a.as<MeshObject>().value;
            const auto& y = b.as<MeshObject>().value;
            out = x == y || *x == *y;
            return true;
        }
        case Tag::range: {
            const auto& x = a.as<RangeObject>();
            const auto& y = b.as<RangeObject>();
            out = x.low == y.low && x.step == y.step && x.count == y.count;
            return true;
        }
        default:
            break;
    }
    if (a.object() == b.object()) {
        out = true;
        return true;
    }
    if (!a.is(Tag::list) && !a.is(Tag::record)) return true;
    ++depth_;
    bool good = stack_left(site);
    if (a.is(Tag::list)) {
        const auto& x = a.items();
        const auto& y = b.items();
        out = x.size() == y.size();
        for (std::size_t i = 0; i < x.size() && out && good; ++i) {
            good = step(site) && equal(x[i], y[i], site, out);
        }
    } else {
        const auto& x = a.as<RecordObject>().fields;
        out = x.size() == b.as<RecordObject>().fields.size();
        for (std::size_t i = 0; i < x.size() && out && good; ++i) {
            const Value* const other = b.as<RecordObject>().find(x[i].first);
            out = other != nullptr;
            if (out) good = step(site) && equal(x[i].second, *other, site, out);
        }
    }
    --depth_;
    return good;
}

bool Evaluator::show(const Value& value, NodeId site, std::string& out) {
    // An explicit stack: what is shown may be nested deeper than the machine's.
    struct Open {
        const Value* value;
        std::size_t next;
    };
    std::vector<Open> open;
    const Value* current = &value;
    while (true) {
        if (current != nullptr) {
            if (!room(static_cast<double>(out.size()), site) || !step(site)) return false;
            const bool nested = !open.empty();
            switch (current->tag()) {
                case Tag::nothing:
                    out += "nothing";
                    break;
                case Tag::boolean:
                    out += current->boolean() ? "true" : "false";
                    break;
                case Tag::number:
                    out += number_text(current->number());
                    break;
                case Tag::string:
                    out += nested ? quoted(current->string()) : current->string();
                    break;
                case Tag::range: {
                    const auto& r = current->as<RangeObject>();
                    const std::string low = number_text(r.low);
                    out += r.count > 0 ? fmt::format("{}..{}", low, number_text(r.at(r.count - 1)))
                                       : fmt::format("{}..<{}", low, low);
                    if (r.step != 1.0) out += " step " + number_text(r.step);
                    break;
                }
                case Tag::list:
                case Tag::record:
                    if (open.size() >= kShownDepth) {
                        out += "...";
                        break;
                    }
                    out += current->is(Tag::list) ? '[' : '{';
                    open.push_back({current, 0});
                    break;
                default:
                    out += kind_text(*current).substr(2);  // without "a "
            }
        }
        if (open.empty()) return true;
        Open& top = open.back();
        const bool is_list = top.value->is(Tag::list);
        const std::size_t size =
            is_list ? top.value->items().size() : top.value->as<RecordObject>().fields.size();
        if (top.next == size) {
            out += is_list ? ']' : '}';
            open.pop_back();
            current = nullptr;
            continue;
        }
        if (top.next > 0) out += ", ";
        if (is_list) {
            current = &top.value->items()[top.next++];
        } else {
            const auto& field = top.value->as<RecordObject>().fields[top.next++];
            out += program_.symbols.text(field.first) + ": ";
            current = &field.second;
        }
    }
}

}  // namespace raymo::sml
