#include "raymo/sml/builtins/blends.hpp"

#include <fmt/core.h>

#include <array>
#include <utility>

#include "raymo/sml/text.hpp"

namespace raymo::sml {
namespace {

constexpr BlendSlots kOfSolid{1, 2, "`rounded` is for convex edges, `filleted` for concave ones"};

bool all_edges(Call& call, blends::Edges edges, Value& out) {
    csg::Solid solid;
    blends::Form form;
    if (!call.solid(0, solid) || !take_blend(call, kOfSolid, form)) return false;
    return give_blend(call, kOfSolid,
                      blends::blended_edges(solid, edges, form, call.span(), spend_on(call)), out);
}

bool rounded(Call& call, Value& out) { return all_edges(call, blends::Edges::convex, out); }
bool filleted(Call& call, Value& out) { return all_edges(call, blends::Edges::concave, out); }

}  // namespace

bool take_blend(Call& call, const BlendSlots& slots, blends::Form& form) {
    if (!call.positive(slots.radius, form.radius)) return false;
    const std::size_t kind = slots.others;
    const std::size_t shape = kind + 1;
    const std::size_t near = kind + 2;
    const std::size_t where = kind + 3;
    if (call.has(kind)) {
        static constexpr std::array<std::string_view, 3> kKinds{"ball", "conic", "chamfer"};
        std::size_t chosen = 0;
        if (!call.choice(kind, kKinds, chosen)) return false;
        form.profile = static_cast<blends::Profile>(chosen);
    }
    if (call.has(shape)) {
        if (form.profile != blends::Profile::conic) {
            return call.fail(shape, ErrorCode::bad_argument, "only a conic has a shape",
                             "add `kind: \"conic\"`");
        }
        if (!call.number(shape, form.shape)) return false;
        if (!(form.shape > -1.0 && form.shape < 1.0)) {
            return call.fail(shape, ErrorCode::out_of_range, "the shape must be between -1 and 1",
                             "0 is an ellipse, towards 1 it becomes a chamfer",
                             "this is " + number_text(form.shape));
        }
    }
    if (call.has(near)) {
        Vec3 point;
        if (!call.vector(near, point)) return false;
        form.near = point;
    }
    return !call.has(where) || call.solid(where, form.where);
}

blends::Spend spend_on(Call& call) {
    // Told in lumps, since what is small counts as one step.
    return [&call, lump = 0.0](double units) mutable {
        lump += units;
        if (lump < 1e4) return true;
        return call.evaluator().worked(std::exchange(lump, 0.0), call.node());
    };
}

bool give_blend(Call& call, const BlendSlots& slots, Result<blends::Blended> made, Value& out) {
    if (!made) {
        // A limit has told its own error.
        if (made.error().code == ErrorCode::cancelled) return false;
        Error error = std::move(made).error();
        error.where = call.where(slots.radius);
        error.message = call.name() + ": " + error.message;
        return call.fail(std::move(error));
    }
    if (made->edges == 0) {
        call.warn("there is no edge to blend here", std::string(slots.hint));
    }
    return call.result(std::move(made->solid), out);
}

std::span<const BuiltinRow> blend_rows() {
    static constexpr auto kRows = std::to_array<BuiltinRow>({
        {"rounded", "s r | kind? shape? near? where?", &rounded,
         "The solid with its convex edges rounded by a ball of radius r."},
        {"filleted", "s r | kind? shape? near? where?", &filleted,
         "The solid with its concave edges filled up to a ball of radius r."},
    });
    return kRows;
}

}  // namespace raymo::sml
