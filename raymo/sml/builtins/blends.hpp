// The arguments of blends, which the Booleans take, too.
#pragma once

#include <string_view>

#include "raymo/blends/blend.hpp"
#include "raymo/sml/builtins/call.hpp"

namespace raymo::sml {

/// Where `radius kind? shape? near? where?` stand among a call's parameters: the radius at `radius`, the others from `others` on.
struct BlendSlots {
    std::size_t radius;
    std::size_t others;
    std::string_view hint;  ///< what to say where no edge was found
};
/// Takes them. False: one is wrong, and the error is reported.
bool take_blend(Call& call, const BlendSlots& slots, blends::Form& form);
/// Lets a blend be stopped by the limits of the program.
[[nodiscard]] blends::Spend spend_on(Call& call);
/// What came of a blend, with a warning where no edge was found.
bool give_blend(Call& call, const BlendSlots& slots, Result<blends::Blended> made, Value& out);

}  // namespace raymo::sml
