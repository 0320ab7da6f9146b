#include "raymo/sml/formula.hpp"

#include <doctest/doctest.h>

#include <random>

#include "raymo/sml/program.hpp"
#include "raymo/sml/sml.hpp"
#include "raymo/sml/value.hpp"

namespace raymo::sml {
namespace {

/// What a program prints, and what is wrong with it.
std::string told(const std::string& text, int call_depth) {
    std::string out;
    Host host;
    host.limits.call_depth = call_depth;
    host.print = [&](std::string_view line) { out += std::string(line) + "\n"; };
    const Outcome outcome = evaluate("test.raymo", text, host);
    for (const Diagnostic& d : outcome.diagnostics) out += format(d, outcome.sources);
    return out;
}

Program resolved(const std::string& text) {
    Program program;
    std::vector<Diagnostic> diagnostics;
    Reporter reporter(diagnostics);
    SourceMap sources;
    const Host host;
    load(program, "test.raymo", text, host, sources, reporter);
    resolve(program, sources, reporter);
    REQUIRE(reporter.errors() == 0);
    make_formulas(program);
    return program;
}

std::size_t marked(const Program& program) {
    std::size_t count = 0;
    for (const Node& n : program.ast.nodes) {
        if (n.kind != NodeKind::boolean && n.kind != NodeKind::binding && n.flag) ++count;
    }
    return count;
}

/// A random expression of numbers and of the names in `names`.
class Writer {
public:
    Writer(std::mt19937_64& random, std::vector<std::string> names)
        : random_(random), names_(std::move(names)) {}

    std::string expression(int depth) {
        const auto one = [&] { return expression(depth - 1); };
        switch (depth == 0 ? random_() % 4 : random_() % 14) {
            case 0:
            case 1:
            case 2:
                return names_[random_() % names_.size()];
            case 3: {
                static constexpr const char* kNumbers[] = {"0", "1", "2.5", "3", "1e200", "0.1"};
                return kNumbers[random_() % std::size(kNumbers)];
            }
            case 4:
                return "-" + one();
            case 5:
                return "same(" + one() + ")";
            case 6:
                return "twice(" + one() + ", " + one() + ")";
            case 7:
                return "(" + one() + " + " + one() + " - " + one() + ")";
            case 8:
                return "(" + one() + " * " + one() + " / " + one() + " % " + one() + ")";
            default: {
                static constexpr const char* kOperators[] = {" + ", " - ", " * ", " / ", " % "};
                return "(" + one() + kOperators[random_() % 5] + one() + ")";
            }
        }
    }

private:
    std::mt19937_64& random_;
    std::vector<std::string> names_;
};

}  // namespace

TEST_CASE("formulas: what they are made of") {
    CHECK(marked(resolved("let a = 2\nprint(a * 3 + 1)\n")) == 1);
    CHECK(marked(resolved("fn f(x) = x * x\nlet a = f(3)\n")) == 1);
    // One operation is done as fast without.
    CHECK(marked(resolved("let a = 2\nprint(a * 3)\n")) == 0);
    // The largest: not the one within.
    CHECK(marked(resolved("let a = 2\nprint((a * 3 + 1) / (a - 4 * a))\n")) == 1);
    CHECK(marked(resolved("let a = [1]\nprint((a[0] * 3 + 1) / (2 - 4 * 3))\n")) == 1);
    CHECK(marked(resolved("fn f(x) { return f(x - 1 - 1) }\n")) == 1);
    CHECK(marked(resolved("fn f(x, y = 2) = x * y\nlet a = f(3)\n")) == 0);
    CHECK(marked(resolved("fn f(x, y) = x - y\nlet a = f(y: 3, x: 2)\n")) == 0);
    CHECK(marked(resolved("let a = sphere(1) + sphere(2) - sphere(3)\n")) == 0);
    // In a function that is one, what it computes is marked too: it may be called otherwise.
    const Program program = resolved("fn f(n) {\n let m = n * 7 + 2\n return m * m % 3\n}\n");
    CHECK(marked(program) == 2);
}

TEST_CASE("formulas: a function computes in a frame of its own") {
    const Program program = resolved(
        "fn f(n) {\n let m = n + 1\n let k = m * n\n return k - m\n}\nprint(f(2) * f(3))\n");
    const Node* root = nullptr;
    for (const Node& n : program.ast.nodes) {
        if (n.kind == NodeKind::binary && n.flag &&
            program.formulas[static_cast<std::size_t>(n.number)].nesting > 0) {
            root = &n;
        }
    }
    REQUIRE(root != nullptr);
    const Formula& formula = program.formulas[static_cast<std::size_t>(root->number)];
    CHECK(formula.nesting == 1);
    CHECK(formula.room <= kFormulaRoom);
    const Heap heap;
    std::vector<Value> globals(program.globals.size());
    double frame[kFormulaRoom];
    // The function has not been made yet.
    CHECK_FALSE(compute(program.formulas, formula, globals, frame));
    for (Value& g : globals) g = Value::object(new FunctionObject(0, {}));
    REQUIRE(compute(program.formulas, formula, globals, frame));
    CHECK(frame[0] == (6.0 - 3.0) * (12.0 - 4.0));
}

TEST_CASE("formulas: too many numbers, too many calls, too much work are left to the walk") {
    std::string text = "fn f0(x) = x + 1\n";
    for (int i = 1; i <= 12; ++i) {
        const std::string before = "f" + std::to_string(i - 1);
        text += "fn f" + std::to_string(i) + "(x) = " + before + "(x) + " + before + "(x + 1)\n";
    }
    const Program program = resolved(text + "print(f12(1))\n");
    for (const Formula& f : program.formulas) {
        CHECK(f.nesting <= 8);
        CHECK(f.cost <= 2000);
    }
    CHECK(told(text + "print(f12(1))\n", 1000) == "32768\n");
    // Deep on the right: each operand waits on the stack.
    std::string deep = "1";
    for (int i = 0; i < 100; ++i) deep = "(" + deep + " - a)";
    std::string right = "1";
    for (int i = 0; i < 100; ++i) right = "(a - " + right + ")";
    for (const Formula& f : resolved("let a = 2\nprint(" + deep + " + " + right + ")\n").formulas)
        CHECK(f.room <= kFormulaRoom);
    CHECK(told("let a = 2\nprint(" + deep + " + " + right + ")\n", 1000) == "-198\n");
}

TEST_CASE("formulas: programs do and tell the same with them and without") {
    std::mt19937_64 random(1986);
    int errors = 0;
    int numbers = 0;
    for (int i = 0; i < 3000; ++i) {
        Writer inside_two(random, {"x", "y", "m"});
        Writer local(random, {"a", "b", "g", "pi"});
        // Of a variable nothing is a formula; the texts have the same places.
        const auto program = [&](const char* keep, std::uint64_t seed) {
            random.seed(seed);
            std::string text = "let g = " + std::to_string(random() % 3) + "\n";
            text += "fn same(x) {\n " + std::string(keep) + " y = x\n return y\n}\n";
            text += "fn twice(x, y) {\n " + std::string(keep) + " m = same(x)\n return " +
                    inside_two.expression(0) + " * y - m\n}\n";
            text += "fn all(a, b) {\n";
            for (int k = 0; k < 3; ++k) text += " print(same(" + local.expression(4) + "))\n";
            text += "}\nall(" + std::to_string(random() % 4) + ", " +
                    (random() % 8 == 0 ? "(1, 2, 3)" : "-1.5") + ")\n";
            return text;
        };
        const std::uint64_t seed = random();
        const int call_depth = i % 4 == 0 ? 3 : 1000;
        const std::string with = told(program("let", seed), call_depth);
        const std::string without = told(program("var", seed), call_depth);
        std::string expected = without;
        for (std::size_t at = 0; (at = expected.find(" var y", at)) != std::string::npos;)
            expected.replace(at, 6, " let y");
        CAPTURE(program("let", seed));
        REQUIRE(with == expected);
        ++(with.find("error") == std::string::npos ? numbers : errors);
        random.seed(seed + 1);
    }
    CHECK(errors > 300);
    CHECK(numbers > 300);
}

}  // namespace raymo::sml
