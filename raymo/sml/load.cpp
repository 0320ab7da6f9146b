// From the main file to all files of a program.

#include <fmt/core.h>

#include "raymo/sml/parser.hpp"
#include "raymo/sml/program.hpp"
#include "raymo/sml/suggest.hpp"

namespace raymo::sml {
namespace {

constexpr std::size_t kMaxFiles = 1000;

// Adds a text to the sources and parses it. kNoNode when it is no text.
NodeId parse(Program& program, std::string path, std::string text, SourceMap& sources,
             Reporter& reporter, bool lone_expression) {
    const auto file = static_cast<std::uint32_t>(sources.size());
    if (text.size() > kMaxTextBytes) {
        sources.push_back({path, {}});
        reporter.error(ErrorCode::limit, {},
                       fmt::format("{}: the text is larger than {} MiB", path, kMaxTextBytes >> 20),
                       "make what repeats with a loop");
        return kNoNode;
    }
    if (const std::size_t bad = first_invalid_utf8(text); bad != std::string_view::npos) {
        const std::size_t line =
            1 + static_cast<std::size_t>(
                    std::count(text.begin(), text.begin() + static_cast<long>(bad), '\n'));
        reporter.error(
            ErrorCode::syntax, {},
            fmt::format("{}: not a text in UTF-8: line {} has the byte 0x{:02X}", path, line,
                        static_cast<unsigned>(static_cast<unsigned char>(text[bad]))),
            "save the file as UTF-8");
        sources.push_back({std::move(path), {}});
        return kNoNode;
    }
    sources.push_back({std::move(path), std::move(text)});
    Parser parser(sources.back().text, file, program.ast, program.symbols, reporter);
    return lone_expression ? parser.lone_expression() : parser.program();
}

class Loader {
public:
    Loader(Program& program, const Host& host, SourceMap& sources, Reporter& reporter)
        : program_(program), host_(host), sources_(sources), reporter_(reporter) {}

    void main(std::string path, std::string text) {
        program_.modules.push_back({});
        program_.modules[0].is_main = true;
        program_.modules[0].resolved = path;
        program_.modules[0].root =
            parse(program_, std::move(path), std::move(text), sources_, reporter_, false);
        state_.push_back(State::open);
        // Depth first without recursion: a file is done when all that it imports is.
        struct Visit {
            std::uint32_t module;
            std::uint32_t next;
        };
        std::vector<Visit> path_to_here{{0, 0}};
        while (!path_to_here.empty()) {
            const std::uint32_t module = path_to_here.back().module;
            const NodeId import = next_import(module, path_to_here.back().next);
            if (import == kNoNode) {
                state_[module] = State::done;
                program_.order.push_back(module);
                path_to_here.pop_back();
                continue;
            }
            if (open(module, import)) path_to_here.push_back({opened_, 0});
        }
    }

private:
    enum class State : std::uint8_t { open, done };

    NodeId next_import(std::uint32_t module, std::uint32_t& next) const {
        const NodeId root = program_.modules[module].root;
        if (root == kNoNode) return kNoNode;
        const Node& block = program_.ast[root];
        while (next < block.count) {
            const NodeId id = program_.ast.child(block, next++);
            const NodeKind kind = program_.ast[id].kind;
            if (kind == NodeKind::import || kind == NodeKind::import_names) return id;
        }
        return kNoNode;
    }

    // True when a new file was opened (opened_).
    bool open(std::uint32_t importer, NodeId import) {
        const Node& path_node = program_.ast[program_.ast.child(program_.ast[import], 0)];
        const SourceSpan where = path_node.span();
        if (path_node.kind != NodeKind::string) {
            reporter_.error(ErrorCode::syntax, where, "the path of an import is a plain string",
                            "leave out ${...}");
            return false;
        }
        if (!host_.load) {
            reporter_.error(ErrorCode::io, where, "files can not be imported here");
            return false;
        }
        const std::string& path = program_.symbols.text(path_node.symbol);
        std::string resolved;
        auto text = host_.load(sources_[program_.modules[importer].file].path, path, resolved);
        if (!text) {
            Error error = std::move(text).error();
            reporter_.error(std::move(error).at(where));
            return false;
        }
        for (std::uint32_t m = 0; m < program_.modules.size(); ++m) {
            if (program_.modules[m].resolved != resolved) continue;
            if (state_[m] == State::open) {
                reporter_.error(ErrorCode::evaluation, where,
                                fmt::format("the file `{}` imports itself{}", path,
                                            m == importer ? "" : " through other files"),
                                "move what both need to a file of its own");
                return false;
            }
            program_.modules[importer].imports[import] = m;
            return false;
        }
        if (program_.modules.size() >= kMaxFiles) {
            reporter_.error(ErrorCode::limit, where,
                            fmt::format("a program has at most {} files", kMaxFiles));
            return false;
        }
        opened_ = static_cast<std::uint32_t>(program_.modules.size());
        program_.modules[importer].imports[import] = opened_;
        Module module;
        module.file = static_cast<std::uint32_t>(sources_.size());
        module.resolved = resolved;
        module.root = parse(program_, resolved, std::move(*text), sources_, reporter_, false);
        program_.modules.push_back(std::move(module));
        state_.push_back(State::open);
        return true;
    }

    Program& program_;
    const Host& host_;
    SourceMap& sources_;
    Reporter& reporter_;
    std::vector<State> state_;
    std::uint32_t opened_ = 0;
};

// Parameters given from outside are expressions of their own; a plain word for a text may be without quotes.
void load_parameters(Program& program, const Host& host, SourceMap& sources, Reporter& reporter) {
    const Module& main = program.modules[0];
    if (main.root == kNoNode) return;
    std::unordered_map<std::string, NodeId> declared;
    const Node root = program.ast[main.root];
    for (const NodeId id : program.ast.children_of(root)) {
        const Node& n = program.ast[id];
        if (n.kind != NodeKind::param) continue;
        const Node& name = program.ast[program.ast.child(n, 0)];
        if (name.kind == NodeKind::binding) declared[program.symbols.text(name.symbol)] = id;
    }
    for (const auto& [name, text] : host.params) {
        const auto found = declared.find(name);
        if (found == declared.end()) {
            Suggestion suggestion(name);
            for (const auto& [known, node] : declared) suggestion.consider(known);
            reporter.error(ErrorCode::name, {}, fmt::format("there is no parameter `{}`", name),
                           suggestion.hint());
            continue;
        }
        const Node& fallback = program.ast[program.ast.child(program.ast[found->second], 1)];
        std::string expression = text;
        if (fallback.kind == NodeKind::string && !text.starts_with('"')) {
            expression = "\"";
            for (const char c : text) {
                if (c == '"' || c == '\\' || c == '$') expression += '\\';
                expression += c;
            }
            expression += '"';
        }
        const NodeId node =
            parse(program, "-D " + name, std::move(expression), sources, reporter, true);
        if (node != kNoNode) program.given[program.symbols.intern(name)] = node;
    }
}

}  // namespace

std::size_t line_of(const std::string& text, std::uint32_t offset) {
    const auto end = text.begin() + static_cast<long>(std::min<std::size_t>(offset, text.size()));
    return 1 + static_cast<std::size_t>(std::count(text.begin(), end, '\n'));
}

void load(Program& program, std::string path, std::string text, const Host& host,
          SourceMap& sources, Reporter& reporter) {
    // Texts are viewed while they are parsed: the list of sources must not move them.
    sources.reserve(kMaxFiles + host.params.size() + 1);
    Loader(program, host, sources, reporter).main(std::move(path), std::move(text));
    load_parameters(program, host, sources, reporter);
}

}  // namespace raymo::sml
