// A program that is read and resolved: all its files, and what each name stands for.
#pragma once

#include <map>
#include <string>
#include <unordered_map>
#include <vector>

#include "raymo/sml/ast.hpp"
#include "raymo/sml/diagnostics.hpp"
#include "raymo/sml/formula.hpp"
#include "raymo/sml/sml.hpp"

namespace raymo::sml {

/// What a name at the top level of a file was declared as.
enum class Declared : std::uint8_t { let, var, function, param, part, view, file };

struct Exported {
    std::uint32_t slot = 0;  ///< of the table of globals
    Declared as = Declared::let;
    NodeId node = kNoNode;       ///< binding
    std::uint32_t function = 0;  ///< function: index into Ast::functions
};

struct Module {
    std::uint32_t file = 0;  ///< index into Outcome::sources
    std::string resolved;    ///< as Host::load knows it
    NodeId root = kNoNode;
    bool is_main = false;
    std::unordered_map<std::uint32_t, std::uint32_t> imports;  ///< import statement -> module
    std::unordered_map<Symbol, Exported> names;
    std::uint32_t frame_size = 0;   ///< locals of blocks at the top level
    std::uint32_t entry = kNoPlan;  ///< functions to make before it runs
};

struct Program {
    Ast ast;
    Symbols symbols;
    std::vector<Module> modules;       ///< [0] is the main file
    std::vector<std::uint32_t> order;  ///< modules, imported ones first; the main file last
    std::vector<NodeId> globals;       ///< declaration of each global
    std::map<Symbol, NodeId> given;    ///< parameters from outside: expression
    std::vector<Formula> formulas;     ///< see make_formulas()
};

/// Reads the main file, all files it imports, and the parameters given from outside. Errors go to the reporter.
void load(Program& program, std::string path, std::string text, const Host& host,
          SourceMap& sources, Reporter& reporter);
/// Finds out what every name stands for; checks names, assignments and the arguments of calls to known functions.
void resolve(Program& program, const SourceMap& sources, Reporter& reporter);

/// 1-based line of an offset.
[[nodiscard]] std::size_t line_of(const std::string& text, std::uint32_t offset);

}  // namespace raymo::sml
