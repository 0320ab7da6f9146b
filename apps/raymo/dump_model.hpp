// A model as text, node by node.
#pragma once

#include "apps/raymo/session.hpp"

namespace raymo::app {

/// Writes the materials, then every node of the graph once, operands before what is made of them:
///     #3 difference #1 #2  @ cup.raymo:7:10
/// then the parts with their nodes. Cost: O(nodes), whatever the number of instances.
void dump_model(Session& session, Writer& out);

}  // namespace raymo::app
