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

/// What a step does to the number in hand, which is the top of the stack. What is below it is in memory.
struct FormulaStep {
    enum class Kind : std::uint8_t {
        number,  ///< puts what is in hand on the stack, and takes `number`
        local,   ///< or place `index` of the frame
        global,  ///< or the global with this index
        keep,    ///< puts it into place `index` of the frame, and takes the next from the stack
        call,  ///< index: of the formula; its arguments are on top; `number`: of the global that must be a function
        negate,
        // The number on the stack and that in hand; that in hand and `number`; or and place `index` of the frame.
        add,
        add_number,
        add_local,
        subtract,
        subtract_number,
        subtract_local,
        multiply,
        multiply_number,
        multiply_local,
        divide,
        divide_number,
        divide_local,
        modulo,
        modulo_number,
        modulo_local,
    };
    Kind kind;
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
