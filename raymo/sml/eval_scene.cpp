// What joins the scene, parameters, limits, and the run as a whole.

#include <fmt/core.h>

#include <cmath>

#include "raymo/curves/build_path.hpp"
#include "raymo/sml/evaluate.hpp"
#include "raymo/sml/text.hpp"

namespace raymo::sml {
namespace {

std::string bytes_text(double bytes) {
    const bool is_large = bytes >= 0x1p30;
    const double unit = is_large ? 0x1p30 : (bytes >= 0x1p20 ? 0x1p20 : 0x1p10);
    return fmt::format("{} {}", number_text(std::floor(bytes / unit * 10.0) / 10.0),
                       is_large ? "GiB" : (unit == 0x1p20 ? "MiB" : "KiB"));
}

}  // namespace

Evaluator::Evaluator(Program& program, const Host& host, Outcome& outcome, Reporter& reporter)
    : program_(program),
      ast_(program.ast),
      host_(host),
      outcome_(outcome),
      reporter_(reporter),
      drawings_(host) {
    for (const DocOf& doc : ast_.docs) docs_[doc.node] = doc.text;
}

bool Evaluator::fail(Error error) {
    std::vector<CallSite> calls;
    for (const Frame* f = frame_; f != nullptr && f->site != kNoNode; f = f->caller) {
        const Symbol name = ast_.functions[f->function].name;
        calls.push_back({span(f->site), name == kNoSymbol ? "fn" : program_.symbols.text(name)});
    }
    reporter_.error(std::move(error), std::move(calls));
    return false;
}

bool Evaluator::fail(ErrorCode code, SourceSpan where, std::string message, std::string hint,
                     std::string label) {
    return fail(Error{code, std::move(message), std::move(label), std::move(hint), -1, where});
}

bool Evaluator::check_limits(NodeId site) {
    if (heap_.bytes() > host_.limits.bytes) return room(0.0, site);
    if (host_.progress != nullptr && host_.progress->cancelled()) {
        return fail(ErrorCode::cancelled, span(site), "stopped");
    }
    if (host_.seconds && host_.seconds() - started_ > host_.limits.seconds) {
        return fail(ErrorCode::limit, span(site),
                    fmt::format("the time of evaluation passed its limit of {} s",
                                number_text(host_.limits.seconds)),
                    "is there a loop that does not end? --time-limit allows more");
    }
    return true;
}

bool Evaluator::room(double bytes, NodeId site) {
    if (heap_.bytes() + bytes <= host_.limits.bytes) return true;
    return fail(ErrorCode::limit, span(site),
                fmt::format("the memory of the program passed its limit of {}",
                            bytes_text(host_.limits.bytes)),
                "share solids with repeat(), ring() or grid(); --memory-limit allows more");
}

bool Evaluator::made(const csg::Solid& solid, bool is_primitive, NodeId site) {
    heap_.charge(bytes_of(solid.node()));
    if (is_primitive && ++solids_ > host_.limits.solids) {
        return fail(ErrorCode::limit, span(site),
                    fmt::format("the number of solids passed its limit of {}",
                                number_text(host_.limits.solids)),
                    "share solids with repeat(), ring() or grid()");
    }
    return step(site);
}

bool Evaluator::made(curves::Contour contour, double bytes, NodeId site, Value& out) {
    out = Value::object(new ContourObject(std::move(contour), bytes));
    return worked(bytes / 64.0, site);
}

bool Evaluator::made(curves::PathPtr path, NodeId site, Value& out) {
    const double bytes = curves::bytes_of(*path);
    out = Value::object(new PathObject(std::move(path)));
    return worked(bytes / 64.0, site);
}

bool Evaluator::made(meshes::Mesh mesh, NodeId site, Value& out) {
    const double bytes = meshes::bytes_of(mesh);
    out = Value::object(new MeshObject(std::make_shared<const meshes::Mesh>(std::move(mesh))));
    return worked(bytes / 64.0, site);
}

csg::MaterialId Evaluator::material(const scene::Material& m) {
    NumberSum sum;
    for (const double x : {m.color.x, m.color.y, m.color.z, m.diffuse, m.specular, m.roughness,
                           m.metal, m.mirror, m.transmission, m.ior, m.absorption.x, m.absorption.y,
                           m.absorption.z, static_cast<double>(m.facets)}) {
        sum.add(x);
    }
    // Names go with numbers: few materials differ in nothing else.
    const std::uint64_t hash = mix(sum.value(), m.name.size());
    const std::uint32_t known = materials_.find(
        hash, [&](std::uint32_t row) { return outcome_.scene.materials[row] == m; });
    if (known != RowIndex::kNoRow) return known;
    heap_.charge(sizeof(scene::Material) + 64);
    const auto id = static_cast<csg::MaterialId>(outcome_.scene.materials.size());
    outcome_.scene.materials.push_back(m);
    materials_.add(hash, id);
    return id;
}

// ---- Parts

// A variable that stands alone names its part; others are counted.
std::string Evaluator::part_name(NodeId node) const {
    const Node& n = ast_[node];
    return n.kind == NodeKind::name ? program_.symbols.text(n.symbol) : std::string();
}

void Evaluator::add_part(std::string name, csg::Solid solid, SourceSpan where) {
    if (name.empty()) {
        do {
            name = fmt::format("part{}", ++unnamed_parts_);
        } while (part_names_.contains(name));
    }
    if (const auto found = part_names_.find(name); found != part_names_.end()) {
        std::string numbered;
        std::uint32_t number = found->second;
        do {
            numbered = fmt::format("{}{}", name, ++number);
        } while (part_names_.contains(numbered));
        found->second = number;
        name = std::move(numbered);
    }
    part_names_.emplace(name, 1);
    heap_.charge(sizeof(scene::Part) + 96.0 + static_cast<double>(name.size()));
    outcome_.scene.parts.push_back({std::move(name), std::move(solid), where});
}

Evaluator::Shown Evaluator::show_in_scene(const Value& value, NodeId node, bool is_emitted) {
    switch (value.tag()) {
        case Tag::solid:
            if (in_main_file_) add_part(part_name(node), value.solid(), span(node));
            return Shown::yes;
        case Tag::light:
            if (in_main_file_) outcome_.scene.lights.push_back(value.as<LightObject>().value);
            return Shown::yes;
        case Tag::camera:
            if (in_main_file_) {
                outcome_.scene.cameras.push_back(
                    {fmt::format("view{}", outcome_.scene.cameras.size() + 1),
                     value.as<CameraObject>().value});
            }
            return Shown::yes;
        case Tag::nothing:
            return Shown::yes;
        case Tag::list:
            for (const Value& item : value.items()) {
                if (!item.is(Tag::solid) && !item.is(Tag::light) && !item.is(Tag::camera))
                    return Shown::no;
            }
            if (value.items().empty() && !is_emitted) return Shown::no;
            for (const Value& item : value.items()) {
                static_cast<void>(show_in_scene(item, node, is_emitted));
                if (!step(node)) return Shown::failed;
            }
            return Shown::yes;
        default:
            return Shown::no;
    }
}

bool Evaluator::exec_expression(const Node& n, NodeId id) {
    const NodeId node = ast_.child(n, 0);
    Value value;
    if (!eval(node, value)) return false;
    const bool is_top_level = frame_->function == 0xffffffffU;
    if (is_top_level) {
        const Shown shown = show_in_scene(value, node, false);
        if (shown != Shown::no) return shown == Shown::yes && step(id);
    } else if (value.is(Tag::nothing)) {
        return true;
    }
    if (!warned_.insert(id).second) return true;
    if (is_top_level) {
        reporter_.warn(span(node),
                       fmt::format("{} stands alone: it does nothing", kind_text(value)),
                       value.is(Tag::contour) ? "make a solid of it: prism(contour, height)"
                       : value.is(Tag::path)  ? "make a solid of it: sweep(path)"
                       : value.is(Tag::mesh)  ? "make a solid of it: smooth(mesh)"
                                              : "give it a name with `let`, or print() it");
    } else {
        reporter_.warn(span(node), "this value is not used",
                       value.is(Tag::solid) ? "write `emit` or `return` in front of it"
                                            : "give it a name with `let`, or `return` it");
    }
    return true;
}

bool Evaluator::exec_part(const Node& n) {
    const NodeId node = ast_.child(n, 1);
    const Node& name = ast_[ast_.child(n, 0)];
    Value value;
    if (!eval(node, value)) return false;
    if (value.is(Tag::list) && !value.items().empty()) {
        std::vector<csg::Solid> operands;
        for (const Value& item : value.items()) {
            if (!item.is(Tag::solid)) break;
            operands.push_back(item.solid());
        }
        if (operands.size() == value.items().size() &&
            !combine(csg::Op::unite, std::move(operands), node, span(node), value)) {
            return false;
        }
    }
    if (!value.is(Tag::solid)) {
        return fail(ErrorCode::bad_argument, span(node), "a part must be a solid",
                    value.is(Tag::contour) ? "make a solid of it: prism(contour, height)"
                    : value.is(Tag::path)  ? "make a solid of it: sweep(path)"
                    : value.is(Tag::mesh)  ? "make a solid of it: smooth(mesh)"
                                           : "",
                    fmt::format("this is {}", kind_text(value)));
    }
    if (in_main_file_) add_part(program_.symbols.text(name.symbol), value.solid(), span(node));
    store(name, std::move(value));
    return true;
}

bool Evaluator::exec_view(const Node& n) {
    const NodeId node = ast_.child(n, 1);
    const Node& name = ast_[ast_.child(n, 0)];
    Value value;
    if (!eval(node, value)) return false;
    if (!value.is(Tag::camera)) {
        return fail(ErrorCode::bad_argument, span(node), "a view must be a camera",
                    "write `view front = camera(eye: (x, y, z))`",
                    fmt::format("this is {}", kind_text(value)));
    }
    if (in_main_file_) {
        outcome_.scene.cameras.push_back(
            {program_.symbols.text(name.symbol), value.as<CameraObject>().value});
    }
    store(name, std::move(value));
    return true;
}

// ---- Parameters

bool Evaluator::exec_param(const Node& n) {
    const Node& name = ast_[ast_.child(n, 0)];
    const NodeId fallback = ast_.child(n, 1);
    const std::string& text = program_.symbols.text(name.symbol);
    Value value;
    if (!eval(fallback, value)) return false;
    if (n.count > 2 && !check_domain(ast_.child(n, 2), text, value, span(fallback))) return false;
    const auto given = in_main_file_ ? program_.given.find(name.symbol) : program_.given.end();
    if (given != program_.given.end()) {
        Value other;
        if (!eval(given->second, other)) return false;
        if (other.tag() != value.tag()) {
            return fail(ErrorCode::bad_argument, span(given->second),
                        fmt::format("the parameter `{}` is {}", text, kind_text(value)), {},
                        fmt::format("this is {}", kind_text(other)));
        }
        if (n.count > 2 && !check_domain(ast_.child(n, 2), text, other, span(given->second))) {
            return false;
        }
        value = std::move(other);
    }
    store(name, std::move(value));
    return true;
}

bool Evaluator::check_domain(NodeId domain_id, const std::string& name, const Value& value,
                             SourceSpan where) {
    const Node& domain = ast_[domain_id];
    if (domain.kind == NodeKind::range) {
        double low = 0.0;
        double step_size = 0.0;
        double count = 0.0;
        double high = 0.0;
        if (!eval_range(domain, domain_id, low, high, step_size, count)) return false;
        if (count == 0.0) {
            std::string limits;
            if (low > high) {
                limits = fmt::format("write {}..{}", number_text(high), number_text(low));
            } else if (step_size < 0.0) {
                limits = "leave out the sign of the step";
            }
            return fail(ErrorCode::out_of_range, span(domain_id),
                        fmt::format("the limits of the parameter `{}` hold no number", name),
                        std::move(limits), "this range is empty");
        }
        std::string shown;
        if (!show(value, domain_id, shown)) return false;
        const std::string label = fmt::format("this is {}", shown.substr(0, 40));
        if (!value.is(Tag::number)) {
            return fail(ErrorCode::bad_argument, where,
                        fmt::format("the parameter `{}` must be a number", name), {},
                        fmt::format("this is {}", kind_text(value)));
        }
        const bool is_open = domain.op == Operator::range_open;
        const double x = value.number();
        // A range may go down.
        const bool rises = step_size > 0.0;
        const bool begins = rises ? x >= low : x <= low;
        const bool ends = is_open ? (rises ? x < high : x > high) : (rises ? x <= high : x >= high);
        if (!begins || !ends) {
            return fail(
                ErrorCode::out_of_range, where,
                fmt::format("the parameter `{}` must be from {} to {}", name, number_text(low),
                            is_open ? (rises ? "below " : "above ") + number_text(high)
                                    : number_text(high)),
                {}, label);
        }
        const double steps = (x - low) / step_size;
        if (domain.count > 2 &&
            std::fabs(steps - std::round(steps)) > 8.0 * 0x1p-53 * std::fabs(steps)) {
            return fail(
                ErrorCode::out_of_range, where,
                fmt::format("the parameter `{}` goes from {} in steps of {}", name,
                            number_text(low), number_text(step_size)),
                fmt::format("the nearest is {}", number_text(low + std::round(steps) * step_size)),
                label);
        }
        return true;
    }
    Value choices;
    if (!eval(domain_id, choices)) return false;
    if (!choices.is(Tag::list)) {
        return fail(ErrorCode::bad_argument, span(domain_id),
                    "a parameter is limited by a range or a list of choices", {},
                    fmt::format("this is {}", kind_text(choices)));
    }
    for (const Value& choice : choices.items()) {
        bool same = false;
        if (!equal(value, choice, domain_id, same)) return false;
        if (same) return true;
    }
    std::string shown;
    std::string all;
    const Value as_list = Value::list({value});
    if (!show(as_list, domain_id, shown) || !show(choices, domain_id, all)) return false;
    return fail(
        ErrorCode::out_of_range, where, fmt::format("the parameter `{}` has no such choice", name),
        fmt::format("choose one of {}", all.substr(0, 200)),
        fmt::format("this is {}", shown.substr(1, std::min<std::size_t>(shown.size() - 2, 40))));
}

// ---- The run

bool Evaluator::run() {
    stack_base_ = static_cast<const char*>(__builtin_frame_address(0));
    started_ = host_.seconds ? host_.seconds() : 0.0;
    globals_.resize(program_.globals.size());
    for (const std::uint32_t index : program_.order) {
        const Module& module = program_.modules[index];
        in_main_file_ = module.is_main;
        const ValueStack::Mark mark = stack_.mark();
        Value* const slots = stack_.push(module.frame_size);
        Frame frame;
        frame.slots = slots;
        frame_ = &frame;
        enter(module.entry);
        const Flow flow = exec_block(ast_[module.root]);
        frame_ = nullptr;
        stack_.pop(slots, module.frame_size, mark);
        if (flow == Flow::failed) return false;
    }
    return true;
}

}  // namespace raymo::sml
