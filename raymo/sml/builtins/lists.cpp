// Lists and ranges.

#include <fmt/core.h>

#include <algorithm>
#include <cmath>

#include "raymo/sml/builtins/call.hpp"
#include "raymo/sml/lexer.hpp"

namespace raymo::sml {
namespace {

bool length(Call& call, Value& out) {
    const Value& v = call[0];
    if (v.is(Tag::list)) return call.result(static_cast<double>(v.items().size()), out);
    if (v.is(Tag::range)) return call.result(v.as<RangeObject>().count, out);
    if (v.is(Tag::record))
        return call.result(static_cast<double>(v.as<RecordObject>().fields.size()), out);
    if (v.is(Tag::string)) {
        const auto characters = std::count_if(v.string().begin(), v.string().end(), [](char c) {
            return (static_cast<unsigned char>(c) & 0xC0) != 0x80;
        });
        return call.result(static_cast<double>(characters), out);
    }
    return call.wrong_kind(0, "a list, a range, a record or a string");
}

bool map(Call& call, Value& out) {
    std::vector<Value> items;
    if (!call.list(0, items) || !call.function(1)) return false;
    for (Value& item : items) {
        Value result;
        if (!call.evaluator().call(call[1], std::span(&item, 1), call.node(), result)) return false;
        item = std::move(result);
    }
    out = Value::list(std::move(items));
    return true;
}

bool filter(Call& call, Value& out) {
    std::vector<Value> items;
    if (!call.list(0, items) || !call.function(1)) return false;
    std::vector<Value> kept;
    for (Value& item : items) {
        Value result;
        if (!call.evaluator().call(call[1], std::span(&item, 1), call.node(), result)) return false;
        if (!result.is(Tag::boolean)) {
            return call.fail(1, ErrorCode::bad_argument, "the function must give true or false", {},
                             fmt::format("it gave {}", kind_text(result)));
        }
        if (result.boolean()) kept.push_back(std::move(item));
    }
    out = Value::list(std::move(kept));
    return true;
}

// reduce(list, f) or reduce(list, f, start): f(f(start, a), b) ...
bool reduce(Call& call, Value& out) {
    std::vector<Value> items;
    if (!call.list(0, items) || !call.function(1)) return false;
    std::size_t next = 0;
    Value sum;
    if (call.has(2)) {
        sum = call[2];
    } else if (items.empty()) {
        return call.fail(0, ErrorCode::bad_argument, "an empty list needs a value to start with",
                         "write reduce(list, f, start)");
    } else {
        sum = std::move(items[next++]);
    }
    for (; next < items.size(); ++next) {
        std::array<Value, 2> arguments{std::move(sum), std::move(items[next])};
        sum = Value();
        if (!call.evaluator().call(call[1], arguments, call.node(), sum)) return false;
    }
    out = std::move(sum);
    return true;
}

// sort(list) of numbers or strings, sort(list, by: f) by what f gives.
bool sort(Call& call, Value& out) {
    std::vector<Value> items;
    if (!call.list(0, items) || (call.has(1) && !call.function(1))) return false;
    struct Keyed {
        Value key;
        std::size_t index;
    };
    std::vector<Keyed> keyed(items.size());
    for (std::size_t i = 0; i < items.size(); ++i) {
        keyed[i].index = i;
        if (!call.has(1)) {
            keyed[i].key = items[i];
        } else if (!call.evaluator().call(call[1], std::span(&items[i], 1), call.node(),
                                          keyed[i].key)) {
            return false;
        }
        const Value& key = keyed[i].key;
        if ((!key.is(Tag::number) && !key.is(Tag::string)) || key.tag() != keyed[0].key.tag()) {
            return call.fail(0, ErrorCode::bad_argument,
                             "only numbers or only strings can be sorted",
                             "give a function that makes the key: sort(list, fn(x) x.size)",
                             fmt::format("this list has {} in it", kind_text(key)));
        }
    }
    std::stable_sort(keyed.begin(), keyed.end(), [](const Keyed& a, const Keyed& b) {
        return a.key.is(Tag::number) ? a.key.number() < b.key.number()
                                     : a.key.string() < b.key.string();
    });
    std::vector<Value> sorted;
    sorted.reserve(items.size());
    for (const Keyed& k : keyed) sorted.push_back(items[k.index]);
    out = Value::list(std::move(sorted));
    return true;
}

bool reverse(Call& call, Value& out) {
    std::vector<Value> items;
    if (!call.list(0, items)) return false;
    std::reverse(items.begin(), items.end());
    out = Value::list(std::move(items));
    return true;
}

// zip(a, b, ...): [[a0, b0, ...], [a1, b1, ...], ...], as long as the shortest.
bool zip(Call& call, Value& out) {
    std::vector<std::vector<Value>> lists(call.rest().size());
    std::size_t shortest = 0;
    for (std::size_t i = 0; i < lists.size(); ++i) {
        if (!call.list(call.rest_begin() + i, lists[i])) return false;
        shortest = i == 0 ? lists[i].size() : std::min(shortest, lists[i].size());
    }
    if (!call.evaluator().room(
            static_cast<double>(shortest) * (80.0 + 16.0 * static_cast<double>(lists.size())),
            call.node())) {
        return false;
    }
    std::vector<Value> rows;
    rows.reserve(shortest);
    for (std::size_t k = 0; k < shortest; ++k) {
        std::vector<Value> row;
        for (auto& list : lists) row.push_back(list[k]);
        rows.push_back(Value::list(std::move(row)));
        if (!call.evaluator().step(call.node())) return false;
    }
    out = Value::list(std::move(rows));
    return true;
}

// Of numbers, vectors, solids or contours.
bool sum(Call& call, Value& out) {
    std::vector<Value> items;
    if (!call.list(0, items)) return false;
    if (items.empty()) {
        out = Value::number(0.0);
        return true;
    }
    if (std::all_of(items.begin(), items.end(), [](const Value& v) { return v.is(Tag::solid); })) {
        std::vector<csg::Solid> operands;
        for (const Value& item : items) operands.push_back(item.solid());
        return call.evaluator().combine(csg::Op::unite, std::move(operands), call.node(),
                                        call.span(), out);
    }
    if (std::all_of(items.begin(), items.end(),
                    [](const Value& v) { return v.is(Tag::contour); })) {
        std::vector<curves::Contour> operands;
        for (const Value& item : items) operands.push_back(item.as<ContourObject>().value);
        if (operands.size() > 1) {
            return call.evaluator().combine(curves::ContourOp::unite, std::move(operands),
                                            call.node(), out);
        }
    }
    Value total = items[0];
    for (std::size_t i = 1; i < items.size(); ++i) {
        Value next;
        if (!call.evaluator().step(call.node()) ||
            !call.evaluator().binary(Operator::add, total, items[i], call.node(), call.where(0),
                                     kNoNode, kNoNode, next)) {
            return false;
        }
        total = std::move(next);
    }
    out = std::move(total);
    return true;
}

bool concat(Call& call, Value& out) {
    std::vector<Value> all;
    for (std::size_t i = 0; i < call.rest().size(); ++i) {
        std::vector<Value> items;
        if (!call.list(call.rest_begin() + i, items)) return false;
        if (!call.evaluator().room(16.0 * static_cast<double>(all.size() + items.size()),
                                   call.node())) {
            return false;
        }
        all.insert(all.end(), std::make_move_iterator(items.begin()),
                   std::make_move_iterator(items.end()));
    }
    out = Value::list(std::move(all));
    return true;
}

// range(n), range(low, high), range(low, high, step): without the end, as 0..<n.
bool range(Call& call, Value& out) {
    double low = 0.0;
    double high = 0.0;
    double step = 1.0;
    if (!call.number(0, high)) return false;
    if (call.has(1)) {
        low = high;
        if (!call.number(1, high)) return false;
    }
    if (call.has(2) && !call.number(2, step)) return false;
    if (step == 0.0) {
        return call.fail(2, ErrorCode::out_of_range, "`step` must not be 0", {}, "this is 0");
    }
    const double count = range_count(low, high, step, true);
    if (!(count < 0x1p53))
        return call.fail(ErrorCode::out_of_range, "the range has too many numbers");
    out = Value::object(new RangeObject(low, high, step, count));
    return true;
}

bool enumerate(Call& call, Value& out) {
    std::vector<Value> items;
    if (!call.list(0, items)) return false;
    if (!call.evaluator().room(112.0 * static_cast<double>(items.size()), call.node()))
        return false;
    double i = 0;
    for (Value& item : items) item = Value::list({Value::number(i++), item});
    out = Value::list(std::move(items));
    return true;
}

}  // namespace

std::span<const BuiltinRow> list_rows() {
    static constexpr auto kRows = std::to_array<BuiltinRow>({
        {"len", "list", &length, "Number of elements, or of characters."},
        {"map", "list f", &map, "f of every element."},
        {"filter", "list f", &filter, "The elements for which f is true."},
        {"reduce", "list f start?", &reduce, "f(f(f(start, a), b), c) and so on."},
        {"sort", "list by?", &sort, "Ascending; elements that are equal keep their order."},
        {"reverse", "list", &reverse, "From behind."},
        {"zip", "lists*", &zip, "Elements of several lists side by side."},
        {"sum", "list", &sum, "Of numbers, vectors, solids or contours."},
        {"concat", "lists*", &concat, "One list after the other."},
        {"range", "low high? step?", &range, "Numbers without the end: range(n) is 0..<n."},
        {"enumerate", "list", &enumerate, "[index, element] for every element."},
    });
    return kRows;
}

}  // namespace raymo::sml
