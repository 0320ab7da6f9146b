#include "apps/raymo/answers.hpp"

#include <list>
#include <memory>
#include <optional>

#include "raymo/query/emptiness.hpp"
#include "raymo/query/locate.hpp"
#include "raymo/trace/tracer.hpp"

namespace raymo::app {
namespace {

/// The last few solids with what was made of them. A solid that is held can not be confused with a new one.
template <class T>
class Recent {
public:
    T* find(const csg::Solid& solid) {
        for (auto i = entries_.begin(); i != entries_.end(); ++i) {
            if (i->first != solid) continue;
            entries_.splice(entries_.begin(), entries_, i);
            return entries_.front().second.get();
        }
        return nullptr;
    }
    T* add(const csg::Solid& solid, std::unique_ptr<T> made) {
        if (entries_.size() == kMost) entries_.pop_back();
        entries_.emplace_front(solid, std::move(made));
        return entries_.front().second.get();
    }

private:
    static constexpr std::size_t kMost = 8;
    std::list<std::pair<csg::Solid, std::unique_ptr<T>>> entries_;
};

struct Traced {
    explicit Traced(trace::CompiledScene s) : scene(std::move(s)), tracer(scene) {}
    trace::CompiledScene scene;
    trace::Tracer tracer;
};

Result<Traced*> traced(Recent<Traced>& recent, const csg::Solid& solid, Progress* progress) {
    if (Traced* known = recent.find(solid)) return known;
    scene::Scene scene;
    scene.parts.push_back({"", solid, {}});
    Result<trace::CompiledScene> compiled = trace::compile(scene, progress);
    if (!compiled) return fail(std::move(compiled).error());
    return recent.add(solid, std::make_unique<Traced>(*std::move(compiled)));
}

}  // namespace

sml::Answers make_answers(Progress* progress) {
    const auto for_rays = std::make_shared<Recent<Traced>>();
    const auto for_points = std::make_shared<Recent<query::Locator>>();
    sml::Answers answers;
    answers.hits = [=](const csg::Solid& solid,
                       const Ray& ray) -> Result<std::vector<sml::HitInterval>> {
        const Result<Traced*> t = traced(*for_rays, solid, progress);
        if (!t) return fail(t.error());
        std::vector<std::vector<trace::PartSpan>> parts;
        (*t)->tracer.spans(ray, parts);
        std::vector<sml::HitInterval> out;
        for (const auto& spans : parts) {
            for (const trace::PartSpan& s : spans) {
                out.push_back({s.enter.t, s.exit.t, s.enter.point, s.exit.point, s.enter.normal,
                               s.exit.normal});
            }
        }
        return out;
    };
    answers.contains = [=](const csg::Solid& solid, Vec3 p) -> Result<bool> {
        query::Locator* locator = for_points->find(solid);
        if (locator == nullptr) {
            locator = for_points->add(solid, std::make_unique<query::Locator>(solid));
        }
        return locator->where(p) != query::Where::out;
    };
    answers.is_empty = [=](const csg::Solid& solid) { return query::is_empty(solid, progress); };
    return answers;
}

}  // namespace raymo::app
