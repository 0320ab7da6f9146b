#include "raymo/sml/value.hpp"

#include <array>
#include <concepts>

#include "raymo/core/assert.hpp"
#include "raymo/curves/build_path.hpp"

namespace raymo::sml {
namespace {

// What malloc adds to a block.
constexpr double kBlock = 16.0;

thread_local Heap* current_heap = nullptr;
// Objects without references, waiting for the loop in drop().
thread_local Object* waiting = nullptr;
thread_local bool is_freeing = false;

void free_object(Object* object) {
    switch (object->tag) {
        case Tag::string:
            delete static_cast<StringObject*>(object);
            return;
        case Tag::list:
            delete static_cast<ListObject*>(object);
            return;
        case Tag::record:
            delete static_cast<RecordObject*>(object);
            return;
        case Tag::range:
            delete static_cast<RangeObject*>(object);
            return;
        case Tag::function:
            delete static_cast<FunctionObject*>(object);
            return;
        case Tag::random:
            delete static_cast<RandomObject*>(object);
            return;
        case Tag::contour:
            delete static_cast<ContourObject*>(object);
            return;
        case Tag::path:
            delete static_cast<PathObject*>(object);
            return;
        case Tag::mesh:
            delete static_cast<MeshObject*>(object);
            return;
        case Tag::material:
            delete static_cast<MaterialObject*>(object);
            return;
        case Tag::transform:
            delete static_cast<TransformObject*>(object);
            return;
        case Tag::camera:
            delete static_cast<CameraObject*>(object);
            return;
        case Tag::light:
            delete static_cast<LightObject*>(object);
            return;
        case Tag::cell:
            delete static_cast<CellObject*>(object);
            return;
        default:
            RAYMO_ASSERT(false);
    }
}

double list_bytes(const std::vector<Value>& items) {
    return sizeof(ListObject) + 2 * kBlock + static_cast<double>(items.capacity() * sizeof(Value));
}
double string_bytes(const std::string& text) {
    return sizeof(StringObject) + kBlock + static_cast<double>(text.capacity());
}
double record_bytes(const RecordObject& r) {
    return sizeof(RecordObject) + 2 * kBlock +
           static_cast<double>(r.fields.capacity() * sizeof(r.fields[0]));
}

// Memory that goes when the last handle of this solid goes. Follows the path that is surely not shared; what a Boolean
// alone holds stays counted.
void release_solid(const csg::Node& last) {
    const csg::Node* node = &last;
    while (node != nullptr && node->references.load(std::memory_order_relaxed) == 1) {
        Heap::current().release(bytes_of(*node));
        if (node->kind == csg::NodeKind::transform) {
            node = &csg::as_transform(*node).child.node();
        } else if (node->kind == csg::NodeKind::paint) {
            node = &csg::as_paint(*node).child.node();
        } else {
            node = nullptr;
        }
    }
}

}  // namespace

Heap::Heap() : before_(current_heap) { current_heap = this; }

Heap::~Heap() {
    // What closures still hold in circles.
    while (cells_ != nullptr) {
        CellObject* const cell = cells_;
        Value keep = Value::shared(cell);
        cell->value = Value::nothing();
        // Unlisted here, so that the loop ends even if something outside holds the cell.
        cells_ = cell->next_cell;
        if (cells_ != nullptr) cells_->previous_cell = nullptr;
        cell->next_cell = nullptr;
    }
    current_heap = before_;
}

Heap& Heap::current() {
    RAYMO_ASSERT(current_heap != nullptr);
    return *current_heap;
}

void Value::drop() noexcept {
    if (tag_ == Tag::solid) {
        if (solid_) release_solid(solid_.node());
        solid_.~Solid();
        return;
    }
    if (--object_->references > 0) return;
    object_->next = waiting;
    waiting = object_;
    if (is_freeing) return;
    is_freeing = true;
    while (waiting != nullptr) {
        Object* const object = waiting;
        waiting = object->next;
        free_object(object);
    }
    is_freeing = false;
}

Value Value::string(std::string text) { return object(new StringObject(std::move(text))); }
Value Value::list(std::vector<Value> items) { return object(new ListObject(std::move(items))); }
Value Value::vector(Vec3 v) {
    std::vector<Value> items;
    items.reserve(3);
    for (int axis = 0; axis < 3; ++axis) items.push_back(number(v[axis]));
    return list(std::move(items));
}
Value Value::record(std::vector<std::pair<Symbol, Value>> fields) {
    return object(new RecordObject(std::move(fields)));
}
const std::string& Value::string() const { return as<StringObject>().text; }
const std::vector<Value>& Value::items() const { return as<ListObject>().items; }

StringObject::StringObject(std::string t) : Object(Tag::string), text(std::move(t)) {
    Heap::current().charge(string_bytes(text));
}
StringObject::~StringObject() { Heap::current().release(string_bytes(text)); }

ListObject::ListObject(std::vector<Value> v) : Object(Tag::list), items(std::move(v)) {
    Heap::current().charge(list_bytes(items));
}
ListObject::~ListObject() { Heap::current().release(list_bytes(items)); }

RecordObject::RecordObject(std::vector<std::pair<Symbol, Value>> f)
    : Object(Tag::record), fields(std::move(f)) {
    Heap::current().charge(record_bytes(*this));
}
RecordObject::~RecordObject() { Heap::current().release(record_bytes(*this)); }

const Value* RecordObject::find(Symbol name) const {
    for (const auto& [symbol, value] : fields) {
        if (symbol == name) return &value;
    }
    return nullptr;
}

CellObject::CellObject(Value v) : Object(Tag::cell), value(std::move(v)) {
    Heap& heap = Heap::current();
    heap.charge(sizeof(CellObject) + kBlock);
    next_cell = heap.cells_;
    if (next_cell != nullptr) next_cell->previous_cell = this;
    heap.cells_ = this;
}
CellObject::~CellObject() {
    Heap& heap = Heap::current();
    heap.release(sizeof(CellObject) + kBlock);
    if (previous_cell != nullptr) {
        previous_cell->next_cell = next_cell;
    } else if (heap.cells_ == this) {
        heap.cells_ = next_cell;
    }
    if (next_cell != nullptr) next_cell->previous_cell = previous_cell;
}

FunctionObject::FunctionObject(std::uint32_t i, std::vector<Value> c)
    : Object(Tag::function), info(i), captures(std::move(c)) {
    Heap::current().charge(sizeof(FunctionObject) + 2 * kBlock +
                           static_cast<double>(captures.capacity() * sizeof(Value)));
}
FunctionObject::~FunctionObject() {
    Heap::current().release(sizeof(FunctionObject) + 2 * kBlock +
                            static_cast<double>(captures.capacity() * sizeof(Value)));
}

ContourObject::ContourObject(curves::Contour c, double bytes)
    : Object(Tag::contour), value(std::move(c)) {
    Heap::current().charge(sizeof(ContourObject) + kBlock + bytes);
}
ContourObject::~ContourObject() {
    double bytes = sizeof(ContourObject) + kBlock;
    curves::let_go(std::move(value), [&](const curves::ContourNode& node) {
        bytes += curves::bytes_of(node);
        // A solid that was made of an outline keeps it.
        if (node.outline.use_count() == 1) bytes += curves::bytes_of(*node.outline);
    });
    Heap::current().release(bytes);
}

PathObject::PathObject(curves::PathPtr p) : Object(Tag::path), value(std::move(p)) {
    Heap::current().charge(sizeof(PathObject) + kBlock + curves::bytes_of(*value));
}
PathObject::~PathObject() {
    Heap::current().release(sizeof(PathObject) + kBlock +
                            (value.use_count() == 1 ? curves::bytes_of(*value) : 0.0));
}

MeshObject::MeshObject(meshes::MeshPtr m) : Object(Tag::mesh), value(std::move(m)) {
    Heap::current().charge(sizeof(MeshObject) + kBlock + meshes::bytes_of(*value));
}
MeshObject::~MeshObject() {
    Heap::current().release(sizeof(MeshObject) + kBlock +
                            (value.use_count() == 1 ? meshes::bytes_of(*value) : 0.0));
}

std::string_view kind_text(const Value& value) {
    static constexpr auto kTexts = std::to_array<std::string_view>(
        {"no value",   "nothing",     "a boolean", "a number", "a function",
         "a solid",    "a string",    "a list",    "a record", "a range",
         "a function", "a function",  "a contour", "a path",   "a mesh",
         "a material", "a transform", "a camera",  "a light",  "a variable"});
    return kTexts[static_cast<std::size_t>(value.tag())];
}

double bytes_of(const csg::Node& node) {
    switch (node.kind) {
        case csg::NodeKind::leaf:
            return sizeof(csg::LeafNode) + kBlock +
                   std::visit(
                       [](const auto& kernel) {
                           if constexpr (requires {
                                             { kernel.bytes() } -> std::convertible_to<double>;
                                         }) {
                               return static_cast<double>(kernel.bytes());
                           } else {
                               return 0.0;
                           }
                       },
                       csg::as_leaf(node).solid.kernel);
        case csg::NodeKind::transform:
            return sizeof(csg::TransformNode) + kBlock;
        case csg::NodeKind::paint:
            return sizeof(csg::PaintNode) + kBlock;
        case csg::NodeKind::boolean:
            return sizeof(csg::BooleanNode) + 2 * kBlock +
                   static_cast<double>(csg::as_boolean(node).operands.size() * sizeof(csg::Solid));
    }
    return 0.0;
}

}  // namespace raymo::sml
