#include "apps/raymo/run.hpp"

#include <unistd.h>

#include <algorithm>
#include <cstdlib>

#include "apps/raymo/commands/commands.hpp"
#include "apps/raymo/system/executor.hpp"
#include "apps/raymo/system/heap.hpp"
#include "apps/raymo/system/memory_limit.hpp"
#include "apps/raymo/text.hpp"
#include "apps/raymo/vocabulary.hpp"

namespace raymo::app {
namespace {

int refuse(Console& console, const Trouble& trouble) {
    console.error(trouble);
    return trouble.code;
}

bool looks_like_file(const std::string& word) {
    return word == "-" || word.find_first_of("./") != std::string::npos ||
           access(word.c_str(), F_OK) == 0;
}

bool wants_color(ColorWhen when, const Console& console) {
    if (when != ColorWhen::automatic) return when == ColorWhen::always;
    const char* no_color = std::getenv("NO_COLOR");
    if (no_color != nullptr && *no_color != '\0') return false;
    const char* terminal = std::getenv("TERM");
    return console.error_is_terminal() && terminal != nullptr &&
           std::string_view(terminal) != "dumb";
}

/// Whether the argument after this one is its value: "--size", "-D", but not "--json" or "--size=8x8".
bool takes_next(const std::string& argument) {
    for (const OptionInfo& o : options()) {
        const std::size_t dashes = o.name.find("--");
        const bool is_it =
            o.name.substr(dashes) == argument || (dashes == 3 && o.name.substr(0, 2) == argument);
        if (is_it) return !o.value.empty() && argument != "--stats";
    }
    return false;
}

/// Options may stand before the command: "--color always check cup.raymo".
Args with_command_first(Args args) {
    std::size_t i = 0;
    while (i < args.size() && args[i].size() > 1 && args[i].starts_with('-')) {
        if (args[i] == "--") return args;
        const bool has_form = args[i] == "--stats" && i + 1 < args.size() && args[i + 1] == "json";
        i += takes_next(args[i]) || has_form ? 2 : 1;
    }
    if (i == 0 || i >= args.size() || find_command(args[i]) == nullptr) return args;
    std::rotate(args.begin(), args.begin() + static_cast<std::ptrdiff_t>(i),
                args.begin() + static_cast<std::ptrdiff_t>(i) + 1);
    return args;
}

/// The command and what follows it; `raymo FILE -o OUT` is `raymo render FILE -o OUT`.
Attempt<std::pair<const CommandInfo*, Args>> split(const Args& given) {
    const Args args = with_command_first(given);
    const std::string& first = args[0];
    if (const CommandInfo* command = find_command(first)) {
        if (!command->available) {
            return trouble(kCommandWrong, "raymo " + first + " is not available yet",
                           "raymo --help lists what is");
        }
        return std::pair{command, Args(args.begin() + 1, args.end())};
    }
    if (looks_like_file(first) || first.starts_with('-'))
        return std::pair{find_command("render"), args};
    std::vector<std::string> known;
    for (const CommandInfo& c : commands()) known.emplace_back(c.name);
    std::string hint = did_you_mean(first, known);
    if (hint.empty()) hint = "raymo --help lists the commands";
    return trouble(kCommandWrong, "unknown command " + in_quotes(first), hint);
}

int run_command(const Options& options, Console& console) {
    // The session is left to the end of the process, which gives its memory back in one piece: taking a million solids
    // apart one by one would take longer than making them.
    static Session* const last = new Session(options, console);
    Session& session = *last;
    if (options.command == "render") return run_render(session);
    if (options.command == "check") return run_check(session);
    if (options.command == "rays") return run_rays(session);
    if (options.command == "inside") return run_inside(session);
    return run_dump(session);
}

}  // namespace

int run(const Args& args, Console& console) {
    console.color = wants_color(ColorWhen::automatic, console);
    if (args.empty()) {
        console.raw(program_help());
        return kCommandWrong;
    }
    if (args[0] == "--version" || args[0] == "-V") {
        console.out.write(version_text());
        return console.finish(kDone);
    }
    if (args[0] == "--help" || args[0] == "-h" || (args[0] == "help" && args.size() == 1)) {
        console.out.write(program_help());
        return console.finish(kDone);
    }
    const Args wanted = args[0] == "help" ? Args{args[1], "--help"} : args;
    const auto command = split(wanted);
    if (!command) return refuse(console, command.error());
    const auto& [info, rest] = *command;
    const Attempt<Parsed> parsed = parse_arguments(std::string(info->name), rest);
    if (!parsed) return refuse(console, parsed.error());
    if (parsed->help) {
        console.out.write(*parsed->help);
        return console.finish(kDone);
    }
    const Attempt<Options> options = read_options(std::string(info->name), parsed->raw);
    if (!options) return refuse(console, options.error());
    console.color = wants_color(options->color, console);
    console.quiet = options->quiet;
    const double limit = options->memory_limit.value_or(default_memory_limit());
    keep_heap();
    limit_memory(limit, options->threads > 0 ? options->threads : available_processors());
    return console.finish(run_command(*options, console));
}

}  // namespace raymo::app
