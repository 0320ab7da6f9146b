#include "raymo/solids/schema.hpp"

#include <cmath>
#include <string>

#include "raymo/core/assert.hpp"
#include "raymo/core/shown.hpp"

namespace raymo::solids {
namespace {

bool is_in_range(const Param& param, double value) {
    return std::isfinite(value) &&
           (value > param.min || (value == param.min && param.min_included));
}

/// What is wrong with a value that is not in range.
Failure range_error(const Schema& schema, const Param& param, double value) {
    const std::string subject = std::string(schema.name) + ": " + std::string(param.words);
    if (!std::isfinite(value)) {
        return Failure(Error{ErrorCode::out_of_range,
                             subject + " must be a finite number",
                             "this is " + shown(value),
                             {},
                             -1,
                             {}});
    }
    const std::string relation =
        param.min_included ? " must be at least " : " must be greater than ";
    const std::string hint =
        param.min == 0.0
            ? "give a " + std::string(param.min_included ? "non-negative " : "positive ") +
                  std::string(param.words)
            : std::string();
    return Failure(Error{ErrorCode::out_of_range,
                         subject + relation + shown(param.min),
                         "this is " + shown(value),
                         hint,
                         -1,
                         {}});
}

}  // namespace

Result<void> check(const Schema& schema, std::span<const Argument> arguments) {
    RAYMO_ASSERT(arguments.size() == schema.params.size());
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        const Param& param = schema.params[i];
        [[maybe_unused]] const auto* choice = std::get_if<std::size_t>(&arguments[i]);
        RAYMO_ASSERT(choice == nullptr || *choice < param.choices.size());
        std::span<const double> numbers;
        std::array<double, 3> components{};
        if (const double* number = std::get_if<double>(&arguments[i])) {
            numbers = std::span(number, 1);
        } else if (const Vec3* v = std::get_if<Vec3>(&arguments[i])) {
            components = {v->x, v->y, v->z};
            numbers = components;
        } else if (const Matrix4* m = std::get_if<Matrix4>(&arguments[i])) {
            numbers = *m;
        }
        for (const double number : numbers) {
            if (is_in_range(param, number)) continue;
            Failure failure = range_error(schema, param, number);
            failure.value().argument = static_cast<int>(i);
            return failure;
        }
    }
    return {};
}

}  // namespace raymo::solids
