// The only file that knows CLI11, which costs seconds to compile.
#include <CLI/CLI.hpp>

#include "apps/raymo/options.hpp"
#include "apps/raymo/text.hpp"
#include "apps/raymo/vocabulary.hpp"

namespace raymo::app {
namespace {

bool takes(std::string_view command, const OptionInfo& option) {
    if (option.only.empty()) return true;
    const std::string commands = " " + std::string(option.only) + " ";
    return commands.find(" " + std::string(command) + " ") != std::string::npos;
}

/// `--stats` may stand alone: "--stats json" becomes "--stats=json", "--stats" becomes "--stats=text".
Args with_stats_form(const Args& arguments) {
    Args out;
    bool options = true;
    for (std::size_t i = 0; i < arguments.size(); ++i) {
        options = options && arguments[i] != "--";
        if (!options || arguments[i] != "--stats") {
            out.push_back(arguments[i]);
        } else if (i + 1 < arguments.size() && arguments[i + 1] == "json") {
            out.emplace_back("--stats=json");
            ++i;
        } else {
            out.emplace_back("--stats=text");
        }
    }
    return out;
}

std::vector<std::string> names_of(std::string_view command) {
    std::vector<std::string> out;
    for (const OptionInfo& o : options()) {
        if (takes(command, o)) out.emplace_back(o.name.substr(o.name.find("--")));
    }
    return out;
}

tl::unexpected<Trouble> unknown(const std::string& command, const std::string& argument) {
    const std::string name = argument.substr(0, argument.find('='));
    for (const OptionInfo& o : options()) {
        const std::size_t dashes = o.name.find("--");
        const bool is_it =
            o.name.substr(dashes) == name || (dashes == 3 && o.name.substr(0, 2) == name);
        if (is_it && !takes(command, o)) {
            return trouble(
                kCommandWrong, "raymo " + command + " has no option " + name,
                "it belongs to: raymo " + std::string(o.only.substr(0, o.only.find(' '))));
        }
    }
    std::string hint = did_you_mean(name, names_of(command));
    if (hint.empty()) hint = "raymo " + command + " --help lists the options";
    return trouble(kCommandWrong, "unknown option " + in_quotes(name), std::move(hint));
}

/// "-o --size 8x8": the value was forgotten and the next option taken for it.
bool looks_like_option(const std::string& value) {
    return value.size() > 2 && value.starts_with("--") &&
           value.find_first_of(" \t") == std::string::npos;
}

}  // namespace

Attempt<Parsed> parse_arguments(const std::string& command, const Args& arguments) {
    const CommandInfo& info = *find_command(command);
    CLI::App app{
        "raymo " + command + " " + std::string(info.synopsis) + ": " + std::string(info.doc),
        "raymo " + command};
    app.footer("\n" + std::string(info.details));
    app.allow_extras();

    Parsed parsed;
    RawOptions& raw = parsed.raw;
    app.add_option("FILE", raw.file, "the model, or - for standard input")->type_name("");
    std::map<std::string, std::string, std::less<>> values;
    std::map<std::string, bool, std::less<>> flags;
    for (const OptionInfo& o : options()) {
        if (!takes(command, o)) continue;
        const std::string name(o.name);
        const std::string key(o.key);
        CLI::Option* option = nullptr;
        if (o.value.empty()) {
            option = app.add_flag(name, flags[key], std::string(o.doc));
        } else if (key == "output" || key == "define") {
            option = app.add_option(name, key == "output" ? raw.outputs : raw.defines,
                                    std::string(o.doc))
                         ->allow_extra_args(false)
                         ->type_name(std::string(o.value));
        } else {
            option = app.add_option(name, values[key], std::string(o.doc))
                         ->take_last()
                         ->type_name(std::string(o.value));
        }
        option->group(std::string(o.group));
    }
    Args reversed = with_stats_form(arguments);
    std::reverse(reversed.begin(), reversed.end());
    try {
        app.parse(std::move(reversed));
    } catch (const CLI::CallForHelp&) {
        parsed.help = app.help();
        return parsed;
    } catch (const CLI::ArgumentMismatch& e) {
        const std::string what = e.what();
        return trouble(kCommandWrong,
                       "option " + what.substr(0, what.find(':')) + " needs a value");
    } catch (const CLI::Error& e) {
        return trouble(kCommandWrong, e.what());
    }

    for (const OptionInfo& o : options()) {
        const std::string key(o.key);
        const std::string shown(o.name.substr(o.name.find("--")));
        if (const CLI::Option* option = app.get_option_no_throw(shown);
            option == nullptr || option->count() == 0) {
            continue;
        }
        if (o.value.empty()) {
            raw.flags.push_back(key);
            continue;
        }
        std::vector<std::string> given = key == "output"   ? raw.outputs
                                         : key == "define" ? raw.defines
                                                           : std::vector<std::string>{values[key]};
        for (const std::string& value : given) {
            if (looks_like_option(value)) {
                return trouble(kCommandWrong,
                               "option " + shown + " needs a value; found the option " + value);
            }
            if (value.empty()) return trouble(kCommandWrong, "option " + shown + " needs a value");
        }
        if (key != "output" && key != "define") raw.values[key] = values[key];
    }
    for (const std::string& rest : app.remaining()) {
        if (rest.size() > 1 && rest[0] == '-') return unknown(command, rest);
        return trouble(kCommandWrong, "one FILE is taken at a time; found " + in_quotes(raw.file) +
                                          " and " + in_quotes(rest));
    }
    if (raw.file.empty()) {
        return trouble(kCommandWrong, "no FILE given",
                       "raymo " + command + " " + std::string(info.synopsis));
    }
    return parsed;
}

}  // namespace raymo::app
