// Parameters of a model from a JSON file.
#pragma once

#include <map>
#include <string>

#include "apps/raymo/exit_code.hpp"

namespace raymo::app {

/// Turns {"height": 90, "label": "A", "holes": [1, 2]} into SML expressions by name. `name` is for messages.
/// Trouble: not JSON, not an object, a value that SML can not hold, nesting deeper than 64.
[[nodiscard]] Attempt<std::map<std::string, std::string>> params_from_json(const std::string& text,
                                                                           const std::string& name);

}  // namespace raymo::app
