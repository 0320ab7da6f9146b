// One call of a builtin: its arguments, checked as they are taken, and the errors that point at them.
#pragma once

#include <array>
#include <string>
#include <vector>

#include "raymo/curves/build_spline.hpp"
#include "raymo/math/vec2.hpp"
#include "raymo/meshes/sew.hpp"
#include "raymo/sml/evaluate.hpp"

namespace raymo::sml {

class Call {
public:
    Call(Evaluator& evaluator, NodeId node, const Builtin& builtin, Value* slots, std::size_t count,
         const CallPlan* plan, std::uint32_t first)
        : evaluator_(evaluator),
          node_(node),
          builtin_(builtin),
          slots_(slots),
          count_(count),
          plan_(plan),
          first_(first) {}

    [[nodiscard]] Evaluator& evaluator() const { return evaluator_; }
    [[nodiscard]] NodeId node() const { return node_; }
    [[nodiscard]] const Builtin& builtin() const { return builtin_; }
    [[nodiscard]] SourceSpan span() const { return evaluator_.span(node_); }
    [[nodiscard]] const std::string& name() const { return builtin_.takes.callee; }

    [[nodiscard]] bool has(std::size_t i) const {
        return i < count_ && !slots_[i].is(Tag::missing);
    }
    [[nodiscard]] Value& operator[](std::size_t i) { return slots_[i]; }
    /// Arguments behind the named parameters.
    [[nodiscard]] std::span<Value> rest() const {
        const std::size_t named = builtin_.takes.parameters.size();
        return {slots_ + named, count_ - named};
    }
    /// Index of the first rest argument.
    [[nodiscard]] std::size_t rest_begin() const { return builtin_.takes.parameters.size(); }
    /// Where argument `i` stands; the whole call when it was not written.
    [[nodiscard]] SourceSpan where(std::size_t i) const;

    /// Each takes one argument. False: it is missing or of another kind, and the error is reported.
    bool number(std::size_t i, double& out);
    bool positive(std::size_t i, double& out);
    /// A whole number from `low` to `high`.
    bool whole(std::size_t i, double low, double high, double& out);
    bool flag(std::size_t i, bool& out);
    bool vector(std::size_t i, Vec3& out);
    /// Like vector, but not (0, 0, 0).
    bool direction(std::size_t i, Vec3& out);
    /// A direction, or "x", "y" or "z".
    bool axis(std::size_t i, Vec3& out);
    bool text(std::size_t i, std::string& out);
    bool solid(std::size_t i, csg::Solid& out);
    bool contour(std::size_t i, curves::Contour& out);
    bool path(std::size_t i, curves::PathPtr& out);
    bool mesh(std::size_t i, meshes::MeshPtr& out);
    /// Two numbers, (x, y).
    bool vector2(std::size_t i, Vec2& out);
    /// A list of points of the plane.
    bool points(std::size_t i, std::vector<Vec2>& out);
    /// A length that may be given as twice itself under its other name; `given` is the argument that was written.
    bool half(std::size_t i, double& out, std::size_t& given);
    /// A list; a range becomes one.
    bool list(std::size_t i, std::vector<Value>& out);
    bool function(std::size_t i);
    /// A list of numbers.
    bool numbers(std::size_t i, std::vector<double>& out);
    /// 16 numbers by rows, also as a list of rows; 12 too unless `is_square`: then the last row is 0 0 0 1.
    bool matrix(std::size_t i, bool is_square, std::array<double, 16>& out);
    /// "#rrggbb", a CSS name or (r, g, b) in sRGB, as linear light; `name` gets what was written.
    bool colour(std::size_t i, scene::Colour& out, std::string& name);
    /// One of `choices`.
    bool choice(std::size_t i, std::span<const std::string_view> choices, std::size_t& out);

    /// Reports; always false. Messages begin with the name of the builtin.
    bool fail(std::size_t i, ErrorCode code, std::string_view message, std::string hint = {},
              std::string label = {});
    bool fail(ErrorCode code, std::string_view message, std::string hint = {});
    /// "x must be a number", labelled with what it is.
    bool wrong_kind(std::size_t i, std::string_view expected, std::string hint = {});
    /// An error from a lower layer, with its place.
    bool fail(Error error);
    /// False, with an error, unless the number is finite.
    bool result(double value, Value& out);
    /// A new solid: counted, and given out.
    bool result(Result<csg::Solid> solid, Value& out);
    /// An error of a function that builds curves; `slots` are the arguments that its parameters were taken from.
    bool fail(Error error, std::span<const std::size_t> slots);
    /// A warning at the call, once for each place in the program.
    void warn(std::string_view message, std::string hint);

    /// What argument `i` is called in messages.
    [[nodiscard]] std::string argument_name(std::size_t i) const;

private:
    Evaluator& evaluator_;
    NodeId node_;
    const Builtin& builtin_;
    Value* slots_;
    std::size_t count_;
    const CallPlan* plan_;
    std::uint32_t first_;
};

/// A list of nets of 4x4 points.
bool take_nets(Call& call, std::size_t i, meshes::NetsPtr& out);
/// The arguments `degree` and `ends` of a spline, where they are given; `form` has its kind and whether it is closed.
bool spline_degree(Call& call, std::size_t i, curves::SplineForm& form);
bool spline_ends(Call& call, std::size_t i, curves::SplineForm& form);

/// "this is a number", or "this list has a number in it".
[[nodiscard]] std::string operand_label(const Value& value, bool is_in_list);
/// Two numbers of a list; false when it is something else.
[[nodiscard]] bool is_vector2(const Value& value, Vec2& out);
/// What a value is, for the label of an error: its kind, or how long a list it is.
[[nodiscard]] std::string kind_and_size(const Value& value);
/// The same for what should be a list of numbers: what else there is in it comes first.
[[nodiscard]] std::string numbers_text(const Value& value);
/// Three numbers of a list; false when it is something else.
[[nodiscard]] bool is_vector(const Value& value, Vec3& out);
/// A CSS colour name or "#rgb", "#rrggbb"; components 0..1 in sRGB.
[[nodiscard]] bool find_colour(std::string_view name, Vec3& srgb);
/// The CSS colour name nearest to a misspelt one, as a hint.
[[nodiscard]] std::string suggest_colour(std::string_view name);

}  // namespace raymo::sml
