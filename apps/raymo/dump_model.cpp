#include "apps/raymo/dump_model.hpp"

#include <unordered_map>

#include "apps/raymo/text.hpp"

namespace raymo::app {
namespace {

std::string map_text(const Affine& map) {
    std::string out;
    for (const Vec3& row : map.linear.row) out += json_vector(row) + " ";
    return out + json_vector(map.offset);
}

class ModelDump {
public:
    ModelDump(Session& session, Writer& out) : session_(session), out_(out) {}

    /// Writes what is not yet written of a solid, depth first without recursion; returns the number of its node.
    std::size_t write(const csg::Solid& solid) {
        std::vector<std::pair<const csg::Node*, std::size_t>> open{{&solid.node(), 0}};
        while (!open.empty()) {
            auto& [node, next] = open.back();
            if (!numbers_.contains(node)) {
                if (const csg::Node* child = operand(*node, next++)) {
                    if (!numbers_.contains(child)) open.emplace_back(child, 0);
                    continue;
                }
                const std::size_t id = numbers_.size() + 1;
                write_node(*node, id);
                numbers_.emplace(node, id);
            }
            open.pop_back();
        }
        return numbers_.at(&solid.node());
    }

private:
    static const csg::Node* operand(const csg::Node& node, std::size_t i) {
        switch (node.kind) {
            case csg::NodeKind::leaf:
                return nullptr;
            case csg::NodeKind::transform:
                return i == 0 ? &csg::as_transform(node).child.node() : nullptr;
            case csg::NodeKind::paint:
                return i == 0 ? &csg::as_paint(node).child.node() : nullptr;
            case csg::NodeKind::boolean:
                break;
        }
        const auto& operands = csg::as_boolean(node).operands;
        return i < operands.size() ? &operands[i].node() : nullptr;
    }
    void write_node(const csg::Node& node, std::size_t id) {
        std::string line = "#" + std::to_string(id) + " ";
        trace::LeafInfo place{"", node.span};
        switch (node.kind) {
            case csg::NodeKind::leaf: {
                const csg::LeafNode& leaf = csg::as_leaf(node);
                line += std::string(solids::inventory()[leaf.primitive].schema->name) + " " +
                        map_text(leaf.solid.to_object);
                break;
            }
            case csg::NodeKind::transform:
                line += "transform " + map_text(csg::as_transform(node).map);
                break;
            case csg::NodeKind::paint:
                line += "paint " + std::to_string(csg::as_paint(node).material);
                break;
            case csg::NodeKind::boolean:
                line += node.op == csg::Op::unite        ? "union"
                        : node.op == csg::Op::difference ? "difference"
                                                         : "intersection";
                break;
        }
        for (std::size_t i = 0; const csg::Node* child = operand(node, i); ++i) {
            line += " #" + std::to_string(numbers_.at(child));
        }
        const std::string where = session_.leaf_name(place);
        out_.write(line + (where.empty() ? "" : "  " + where) + "\n");
    }

    Session& session_;
    Writer& out_;
    std::unordered_map<const csg::Node*, std::size_t> numbers_;
};

}  // namespace

void dump_model(Session& session, Writer& out) {
    const scene::Scene& scene = session.outcome.scene;
    for (std::size_t i = 0; i < scene.materials.size(); ++i) {
        const scene::Material& m = scene.materials[i];
        out.write("material " + std::to_string(i) + " " + json_string(m.name) + " color " +
                  json_vector(m.color) + "\n");
    }
    ModelDump dump(session, out);
    std::vector<std::size_t> roots;
    for (const scene::Part& part : scene.parts) roots.push_back(dump.write(part.solid));
    for (std::size_t i = 0; i < roots.size(); ++i) {
        out.write("part " + json_string(scene.parts[i].name) + " #" + std::to_string(roots[i]) +
                  "\n");
    }
}

}  // namespace raymo::app
