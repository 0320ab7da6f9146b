#include <doctest/doctest.h>

#include "raymo/sml/sml.hpp"

namespace raymo::sml {
namespace {

struct Run {
    Outcome outcome;
    std::string printed;
};

Run run(const std::string& text, Limits limits = {}) {
    Run out;
    Host host;
    host.limits = limits;
    host.print = [&](std::string_view line) { out.printed += std::string(line) + "\n"; };
    out.outcome = evaluate("test.raymo", text, host);
    return out;
}

std::string shown(const Outcome& outcome) {
    std::string out;
    for (const Diagnostic& d : outcome.diagnostics) out += format(d, outcome.sources);
    return out;
}

}  // namespace

TEST_CASE("evaluate: the message of the manual") {
    const Run r = run("fn handle(r) {\n    return sphere(r - 2)\n}\nhandle(1)\n");
    CHECK(shown(r.outcome) ==
          "error: sphere: radius must be greater than 0\n"
          "  --> test.raymo:2:19\n"
          " 2 |     return sphere(r - 2)\n"
          "   |                   ^^^^^ this is -1\n"
          "hint: give a positive radius\n"
          "called from test.raymo:4:1 in handle()\n");
    CHECK_FALSE(r.outcome.ok);
    CHECK(r.outcome.scene.parts.empty());
}

TEST_CASE("evaluate: columns count characters, and tabs keep the caret in place") {
    const Run r = run("let größe = 1\n\tprint(größe, nö)\n");
    CHECK(shown(r.outcome) ==
          "error: unknown name `nö`\n"
          "  --> test.raymo:2:15\n"
          " 2 | \tprint(größe, nö)\n"
          "   | \t             ^^\n");
}

TEST_CASE("evaluate: syntax and name errors come together, in order") {
    const Run r = run("print(a)\nlet b = (1\nprint(c)\n");
    REQUIRE(r.outcome.diagnostics.size() == 3);
    CHECK(r.outcome.diagnostics[0].error.message == "unknown name `a`");
    CHECK(r.outcome.diagnostics[1].error.code == ErrorCode::syntax);
    CHECK(r.outcome.diagnostics[2].error.message == "unknown name `c`");
}

TEST_CASE("evaluate: a name lost in a broken statement is not called unknown") {
    CHECK(run("let b = (1\nprint(b)\n").outcome.diagnostics.size() == 1);
    CHECK(run("fn f( {\n}\nprint(f(1))\n").outcome.diagnostics.size() == 1);
}

TEST_CASE("evaluate: leaves know the call that made them") {
    const Run r = run("part p = sphere(3).scale(1, 2, 3)\npart q = sphere(3).move(1, 0, 0)\n");
    REQUIRE(r.outcome.ok);
    const csg::Node& scaled = r.outcome.scene.parts[0].solid.node();
    CHECK(scaled.span == SourceSpan{0, 9, 33});
    CHECK(csg::as_transform(scaled).child.node().span == SourceSpan{0, 9, 18});
    // A move within the leaf's own node.
    const csg::Node& moved = r.outcome.scene.parts[1].solid.node();
    CHECK(csg::as_leaf(moved).solid.to_object.offset == Vec3{1, 0, 0});
    CHECK(moved.span == SourceSpan{0, 43, 52});
}

TEST_CASE("evaluate: memory of solids that are moved and dropped is given back") {
    const auto runs = [](const std::string& text, double bytes) {
        Host host;
        host.limits.bytes = bytes;
        return evaluate("test.raymo", text, host).ok;
    };
    const std::string dropped =
        "for i in 0..<20000 {\n"
        "    let a = sphere(1).move(i, 0, 0)\n"
        "    let b = sphere(1).rotate(x: i).move(i, 0, 0).move(1, 2, 3)\n"
        "}\n";
    CHECK(runs(dropped, 1e5));
    const std::string kept = "part p = union([for i in 0..<2000: sphere(1).move(i, 0, 0)])\n";
    const double nodes = 2000.0 * sizeof(csg::LeafNode);
    CHECK_FALSE(runs(kept, nodes));
    CHECK(runs(kept, 1.8 * nodes));  // with what the list takes
}

TEST_CASE("evaluate: a sum of many is one Boolean, and sharing costs nothing") {
    const Run r = run("let s = sphere(1)\npart p = s + s.move(x: 3) + s.move(x: 6) - s\n");
    REQUIRE(r.outcome.ok);
    const auto& difference = csg::as_boolean(r.outcome.scene.parts[0].solid.node());
    CHECK(difference.op == csg::Op::difference);
    const auto& sum = csg::as_boolean(difference.operands[0].node());
    CHECK(sum.operands.size() == 3);
    CHECK(sum.operands[0] == difference.operands[1]);
}

TEST_CASE("evaluate: closures in circles are freed") {
    // Found by the leak checker where they are not.
    CHECK(
        run("fn f() {\n  var g = nothing\n  g = fn() g\n  return g\n}\nlet a = f()\n").outcome.ok);
}

TEST_CASE("evaluate: limits are named, whatever they are") {
    Limits limits;
    limits.call_depth = 50;
    limits.bytes = 1e6;
    limits.solids = 100;
    for (const char* text :
         {"fn f() = f()\nlet a = f()", "var x = [0]\nwhile true { x = concat(x, x) }",
          "var s = \"ab\"\nwhile true { s = \"${s}${s}\" }", "let s = [for i in 0..1000: block(1)]",
          "let a = map(0..1e9, fn(x) [x])",
          "var x = 1\nwhile true { x = [x, x]; print(len(str(x))) }",
          "fn f(n) = [n, n].map(f)\nlet a = f(1)"}) {
        CAPTURE(text);
        const Run r = run(text, limits);
        REQUIRE_FALSE(r.outcome.ok);
        CHECK(r.outcome.diagnostics.back().error.code == ErrorCode::limit);
        CHECK_FALSE(shown(r.outcome).empty());
    }
}

TEST_CASE("evaluate: a thousand calls deep is allowed by default, one more is not") {
    CHECK(run("fn f(n) = if n == 0 then 0 else 1 + f(n - 1)\nprint(f(999))\n").printed == "999\n");
    CHECK_FALSE(run("fn f(n) = if n == 0 then 0 else 1 + f(n - 1)\nprint(f(1000))\n").outcome.ok);
}

TEST_CASE("evaluate: a deep recursion of long expressions stops before the stack does") {
    std::string text = "fn f(n) = ";
    for (int i = 0; i < 150; ++i) text += "(1 + ";
    text += "f(n - 1)";
    for (int i = 0; i < 150; ++i) text += ")";
    const Run r = run(text + "\nlet a = f(1)\n");
    REQUIRE_FALSE(r.outcome.ok);
    CHECK(r.outcome.diagnostics[0].error.code == ErrorCode::limit);
}

TEST_CASE("evaluate: lists nested a million deep are made and freed") {
    CHECK(run("var x = []\nfor i in 0..<1000000 { x = [x] }\nprint(len(x))").printed == "1\n");
}

TEST_CASE("evaluate: an imported file runs once, and gives names only") {
    int loads = 0;
    Host host;
    host.load = [&](const std::string&, const std::string& path,
                    std::string& resolved) -> Result<std::string> {
        ++loads;
        resolved = path;
        return std::string("print(\"read\")\nlet a = 3\nsphere(1)\nlight(direction: (0, 0, -1))\n");
    };
    int printed = 0;
    host.print = [&](std::string_view) { ++printed; };
    const Outcome out = evaluate(
        "main", "import \"a\" as x\nfrom \"a\" import a\npart p = sphere(a + x.a)\n", host);
    REQUIRE(out.ok);
    CHECK(printed == 1);
    CHECK(out.scene.parts.size() == 1);
    CHECK(out.scene.lights.empty());
}

TEST_CASE("evaluate: parameters are listed with their documentation") {
    const Run r = run("/// how wide\n/// it is\nparam w = 3\nparam h = 4 /// height\n");
    REQUIRE(r.outcome.parameters.size() == 2);
    CHECK(r.outcome.parameters[0].doc == "how wide it is");
    CHECK(r.outcome.parameters[1].doc == "height");
}

TEST_CASE("evaluate: texts that are none") {
    CHECK(run(std::string("print(1)\0", 9)).outcome.diagnostics[0].error.code == ErrorCode::syntax);
    CHECK(run("print(\xFF)").outcome.diagnostics[0].error.message ==
          "test.raymo: not a text in UTF-8: line 1 has the byte 0xFF");
    CHECK(run("").outcome.ok);
    CHECK(run("\xEF\xBB\xBFprint(1)\r\n").printed == "1\n");
}

TEST_CASE("format: long lines are cut around the caret, control characters are not passed on") {
    const Run r = run("let a = \"" + std::string(5000, 'x') + "\" + nix + \"\x1b[2J\"");
    const std::string text = shown(r.outcome);
    CHECK(text.size() < 700);
    CHECK(text.find('\x1b') == std::string::npos);
    CHECK(text.find("unknown name `nix`") != std::string::npos);
}

TEST_CASE("dump_tokens: one token a line, through strings with expressions") {
    CHECK(dump_tokens("let a = \"x${b}y\"\n  a") ==
          "1:1 let let\n1:5 name a\n1:7 = =\n1:9 string \"x${\n1:13 name b\n1:14 } }\n1:14 string "
          "}y\"\n2:3 name a\n");
}

TEST_CASE("evaluate: the specular of a preset is its reflectance at normal incidence") {
    const auto made = [](const std::string& preset) {
        const Run r = run("part a = sphere(1).paint(" + preset + "())\n");
        REQUIRE(r.outcome.ok);
        const scene::MaterialTable& materials = r.outcome.scene.materials;
        for (std::size_t i = 0; i < materials.size(); ++i) {
            if (materials[i].name == preset) return materials[i];
        }
        FAIL("no material is called " << preset);
        return scene::Material{};
    };
    for (const char* const name : {"matte", "plastic", "rubber", "wood", "glass", "water"}) {
        CAPTURE(name);
        const scene::Material m = made(name);
        CHECK(m.specular <= 0.06);
        CHECK(m.mirror <= m.specular);
        CHECK(m.metal == 0.0);
    }
    CHECK(made("glass").specular == doctest::Approx(0.04));
    CHECK(made("water").specular == doctest::Approx(0.0204).epsilon(1e-2));
    for (const char* const name : {"metal", "gold", "copper", "chrome"}) {
        CAPTURE(name);
        const scene::Material m = made(name);
        CHECK(m.specular >= 0.5);
        CHECK(m.mirror <= m.specular);
        CHECK(m.metal == 1.0);
    }
}

TEST_CASE("evaluate: a text may be as long as the limit, and no longer") {
    std::string text(kMaxTextBytes, ' ');
    CHECK(run(text).outcome.ok);
    text += ' ';
    const Run r = run(text);
    CHECK_FALSE(r.outcome.ok);
    CHECK(shown(r.outcome).find("larger than 64 MiB") != std::string::npos);
}

}  // namespace raymo::sml
