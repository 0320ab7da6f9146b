// RAYMO_ASSERT states what our own code guarantees. It is never reachable from any model: that is a Result.
#pragma once

#include <cstdlib>

#if defined(NDEBUG) && !defined(RAYMO_KEEP_ASSERTS)
#define RAYMO_ASSERT(condition) static_cast<void>(0)
#else
#define RAYMO_ASSERT(condition) (static_cast<bool>(condition) ? static_cast<void>(0) : std::abort())
#endif
