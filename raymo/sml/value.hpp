// Values of a running program: 16 bytes each, immutable, shared by counted references.
//
// Objects are freed in a loop, never by recursion, so lists nested a million deep do no harm. The only objects that
// change are cells (variables that a closure holds); they are listed in the heap, which empties those that are left at
// the end: every cycle of references goes through one.
#pragma once

#include <cstdint>
#include <cstring>
#include <limits>
#include <span>
#include <string>
#include <utility>
#include <vector>

#include "raymo/csg/model.hpp"
#include "raymo/curves/contour.hpp"
#include "raymo/curves/path.hpp"
#include "raymo/math/affine.hpp"
#include "raymo/meshes/mesh.hpp"
#include "raymo/scene/camera.hpp"
#include "raymo/scene/light.hpp"
#include "raymo/scene/material.hpp"
#include "raymo/sml/symbols.hpp"

namespace raymo::sml {

enum class Tag : std::uint8_t {
    missing,  ///< an argument that was left out, a variable without value yet; never seen by a program
    nothing,
    boolean,
    number,
    builtin,  ///< a function of the language; payload: row of the table
    solid,
    // From here on: pointers to objects
    string,
    list,
    record,
    range,
    function,
    random,
    contour,
    path,
    mesh,
    material,
    transform,
    camera,
    light,
    cell,  ///< internal
};

struct Object {
    Object* next = nullptr;  ///< among the objects that wait to be freed
    std::uint32_t references = 1;
    Tag tag;
    explicit Object(Tag t) : tag(t) {}
};

/// Counts the bytes of all objects of one evaluation and the cells among them.
class Heap {
public:
    Heap();
    ~Heap();
    Heap(const Heap&) = delete;
    Heap& operator=(const Heap&) = delete;

    void charge(double bytes) { bytes_ += bytes; }
    void release(double bytes) { bytes_ -= bytes; }
    [[nodiscard]] double bytes() const { return bytes_; }
    /// The heap of the evaluation that runs in this thread.
    [[nodiscard]] static Heap& current();

private:
    friend struct CellObject;
    struct CellObject* cells_ = nullptr;
    double bytes_ = 0.0;
    Heap* before_;
};

class Value {
public:
    Value() noexcept : tag_(Tag::missing), bits_(0) {}
    Value(const Value& other) noexcept : tag_(other.tag_) {
        if (tag_ < Tag::solid) {
            bits_ = other.bits_;
        } else if (tag_ == Tag::solid) {
            new (&solid_) csg::Solid(other.solid_);
        } else {
            object_ = other.object_;
            ++object_->references;
        }
    }
    Value(Value&& other) noexcept : tag_(other.tag_) { take(other); }
    Value& operator=(const Value& other) noexcept {
        if (this != &other) {
            Value copy(other);
            clear();
            tag_ = copy.tag_;
            take(copy);
        }
        return *this;
    }
    Value& operator=(Value&& other) noexcept {
        if (this != &other) {
            clear();
            tag_ = other.tag_;
            take(other);
        }
        return *this;
    }
    ~Value() { clear(); }

    /// Becomes a number.
    void set_number(double number) noexcept {
        if (tag_ >= Tag::solid) drop();
        tag_ = Tag::number;
        number_ = number;
    }
    void reset() noexcept { clear(); }
    /// The solid itself; leaves a missing value.
    [[nodiscard]] csg::Solid take_solid() noexcept {
        csg::Solid out(std::move(solid_));
        tag_ = Tag::missing;
        return out;
    }

    [[nodiscard]] static Value nothing() { return Value(Tag::nothing, 0); }
    [[nodiscard]] static Value boolean(bool b) { return Value(Tag::boolean, b ? 1 : 0); }
    [[nodiscard]] static Value builtin(std::uint32_t row) { return Value(Tag::builtin, row); }
    [[nodiscard]] static Value number(double number) {
        Value v(Tag::number, 0);
        v.number_ = number;
        return v;
    }
    [[nodiscard]] static Value solid(csg::Solid solid) {
        Value v;
        v.tag_ = Tag::solid;
        new (&v.solid_) csg::Solid(std::move(solid));
        return v;
    }
    /// Takes over the reference that `object` was made with.
    [[nodiscard]] static Value object(Object* object) {
        Value v(object->tag, 0);
        v.object_ = object;
        return v;
    }
    /// One more reference to an object that others hold.
    [[nodiscard]] static Value shared(Object* object) {
        ++object->references;
        return Value::object(object);
    }
    [[nodiscard]] static Value string(std::string text);
    [[nodiscard]] static Value list(std::vector<Value> items);
    [[nodiscard]] static Value vector(Vec3 v);
    [[nodiscard]] static Value record(std::vector<std::pair<Symbol, Value>> fields);

    [[nodiscard]] Tag tag() const { return tag_; }
    [[nodiscard]] bool is(Tag tag) const { return tag_ == tag; }
    [[nodiscard]] double number() const { return number_; }
    [[nodiscard]] bool boolean() const { return bits_ != 0; }
    [[nodiscard]] std::uint32_t builtin() const { return static_cast<std::uint32_t>(bits_); }
    [[nodiscard]] const csg::Solid& solid() const { return solid_; }
    [[nodiscard]] Object* object() const { return object_; }
    template <class T>
    [[nodiscard]] const T& as() const {
        return *static_cast<const T*>(object_);
    }
    [[nodiscard]] const std::string& string() const;
    [[nodiscard]] const std::vector<Value>& items() const;

private:
    Value(Tag tag, std::uint64_t bits) noexcept : tag_(tag), bits_(bits) {}
    void clear() noexcept {
        if (tag_ >= Tag::solid) drop();
        tag_ = Tag::missing;
    }
    void drop() noexcept;
    /// Moves the payload here. A solid is one pointer, and leaves none behind.
    void take(Value& other) noexcept {
        static_assert(sizeof(csg::Solid) == sizeof(std::uint64_t));
        std::memcpy(static_cast<void*>(&bits_), &other.bits_, sizeof bits_);
        other.tag_ = Tag::missing;
    }

    Tag tag_;
    union {
        std::uint64_t bits_;
        double number_;
        Object* object_;
        csg::Solid solid_;
    };
};
static_assert(sizeof(Value) == 16);

struct StringObject : Object {
    explicit StringObject(std::string t);
    ~StringObject();
    std::string text;
};
struct ListObject : Object {
    explicit ListObject(std::vector<Value> v);
    ~ListObject();
    std::vector<Value> items;
};
struct RecordObject : Object {
    explicit RecordObject(std::vector<std::pair<Symbol, Value>> f);
    ~RecordObject();
    [[nodiscard]] const Value* find(Symbol name) const;
    std::vector<std::pair<Symbol, Value>> fields;
};
/// The numbers low + i step, 0 <= i < count; written low..high.
struct RangeObject : Object {
    RangeObject(double lo, double hi, double s, double n)
        : Object(Tag::range), low(lo), high(hi), step(s), count(n) {
        Heap::current().charge(sizeof(RangeObject));
    }
    ~RangeObject() { Heap::current().release(sizeof(RangeObject)); }
    [[nodiscard]] double at(double i) const { return low + i * step; }
    double low, high, step, count;
};
struct CellObject : Object {
    explicit CellObject(Value v);
    ~CellObject();
    Value value;
    CellObject* previous_cell = nullptr;
    CellObject* next_cell = nullptr;
};
struct FunctionObject : Object {
    FunctionObject(std::uint32_t i, std::vector<Value> c);
    ~FunctionObject();
    std::uint32_t info;           ///< index into Ast::functions
    std::vector<Value> captures;  ///< cells
};
/// What random(seed) gives: a function with a state of its own.
struct RandomObject : Object {
    explicit RandomObject(std::uint64_t s) : Object(Tag::random), state(s) {
        Heap::current().charge(sizeof(RandomObject));
    }
    ~RandomObject() { Heap::current().release(sizeof(RandomObject)); }
    std::uint64_t state;
};
/// Counts what goes when it goes: nodes and outlines that no other contour holds.
struct ContourObject : Object {
    /// `bytes`: what was made for it, nodes and outlines.
    ContourObject(curves::Contour c, double bytes);
    ~ContourObject();
    curves::Contour value;
};
struct PathObject : Object {
    explicit PathObject(curves::PathPtr p);
    ~PathObject();
    curves::PathPtr value;
};
struct MeshObject : Object {
    explicit MeshObject(meshes::MeshPtr m);
    ~MeshObject();
    meshes::MeshPtr value;
};
template <class T, Tag kTag>
struct BoxObject : Object {
    explicit BoxObject(T v) : Object(kTag), value(std::move(v)) {
        Heap::current().charge(sizeof(BoxObject));
    }
    ~BoxObject() { Heap::current().release(sizeof(BoxObject)); }
    T value;
};
using MaterialObject = BoxObject<scene::Material, Tag::material>;
using TransformObject = BoxObject<Affine, Tag::transform>;
using CameraObject = BoxObject<scene::Camera, Tag::camera>;
using LightObject = BoxObject<scene::Light, Tag::light>;

/// "a number", "nothing": what a value is, in messages.
[[nodiscard]] std::string_view kind_text(const Value& value);
/// What a solid's own node costs in memory.
[[nodiscard]] double bytes_of(const csg::Node& node);

}  // namespace raymo::sml
