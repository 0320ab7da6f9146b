// Arithmetic of numbers, computed without values.
//
// Much of what a program computes are numbers from numbers: 2 * r + 0.5 * hash(i). Where nothing but numbers, names,
// + - * / % and calls of functions of the program that are such formulas themselves stand in an expression, it is also
// written as a list of steps on a stack of doubles, which take a few nanoseconds each where a walk over the nodes takes
// twenty. Formulas have no effects. So whenever one does not give a number (an operand is a vector, a divisor is 0, a
// result is too large) nothing is lost: the walk over the nodes does it again, and tells what is wrong and where.
#pragma once

#include <cstdint>
#include <span>
#include <vector>

#include "raymo/sml/ast.hpp"

namespace raymo::sml {

class Value;
struct Program;

struct FormulaStep {
    enum class Kind : std::uint8_t {
        number,
        local,        ///< index: place in the frame
        global,       ///< index: of the table of globals
        keep,         ///< takes a number off the stack into place `index` of the frame
        negate,       ///< the number on top
        arithmetic,   ///< op, on the two on top
        with_number,  ///< the same on the number on top and `number`
        with_local,   ///< or place `index` of the frame
        call,  ///< index: of the formula; its arguments are on top; `number`: of the global that must be a function
    };
    Kind kind;
    Operator op = Operator::none;
    std::uint32_t index = 0;
    double number = 0.0;
};

/// Of an expression, or of the body of a function.
struct Formula {
    std::vector<FormulaStep> steps;
    /// Of an expression: the slots whose numbers stand first in its frame.
    std::vector<std::uint32_t> inputs;
    std::uint32_t parameters = 0;  ///< of a function: what stands first in its frame
    std::uint32_t locals = 0;      ///< numbers in its frame
    std::uint32_t room = 0;        ///< frame, stack, and those of what it calls, together
    std::uint32_t cost = 0;        ///< steps, with those of what it calls
    int nesting = 0;               ///< calls within calls
};

/// Numbers that a formula may need room for.
inline constexpr std::uint32_t kFormulaRoom = 64;

/// Finds the formulas of a resolved program: the largest expressions of two operations or more. Node::flag marks them, and
/// Node::number has their index.
void make_formulas(Program& program);

/// Computes a formula in `frame`, which has room for kFormulaRoom numbers and begins with its inputs or parameters. The result
/// stands in frame[0]. False: there is none, and `frame` holds anything.
[[nodiscard]] bool compute(std::span<const Formula> formulas, const Formula& formula,
                           std::span<const Value> globals, double* frame);

}  // namespace raymo::sml
