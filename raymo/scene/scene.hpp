// A whole model: the solids and how they are looked at. This is what a program in SML makes.
#pragma once

#include <optional>
#include <string>
#include <vector>

#include "raymo/csg/model.hpp"
#include "raymo/scene/camera.hpp"
#include "raymo/scene/light.hpp"
#include "raymo/scene/material_table.hpp"

namespace raymo::scene {

/// A named solid. Parts may overlap: each keeps its own surface (a ball inside a glass block stays visible).
struct Part {
    std::string name;
    csg::Solid solid;
    SourceSpan span;
};

struct NamedCamera {
    std::string name;
    Camera camera;
};

/// What is seen where no solid is: a vertical gradient (equal colours: one colour), by the height of the ray's
/// direction from straight down (`bottom`) to straight up (`top`).
struct Background {
    Colour bottom;
    Colour top;
    friend bool operator==(const Background&, const Background&) = default;
};

struct Scene {
    std::vector<Part> parts;
    MaterialTable materials;           ///< csg::MaterialId is an index into this
    std::vector<NamedCamera> cameras;  ///< the first is the default; empty: fitted to the model
    std::vector<Light> lights;         ///< empty: the default rig
    std::optional<Colour> ambient;     ///< empty: the default of the rig
    std::optional<Background> background;
};

/// The material of surfaces that nobody painted.
[[nodiscard]] const Material& default_material();

/// A camera that shows all of `box` in a three-quarter view (azimuth and elevation in degrees, perspective) in a picture of
/// that aspect (width / height).
[[nodiscard]] Camera fitted_camera(const Aabb& box, double aspect, double azimuth = -60.0,
                                   double elevation = 28.0);
/// Key, fill and rim light placed relative to the camera and the size of `box`.
[[nodiscard]] std::vector<Light> default_lights(const Aabb& box, const Camera& camera);
[[nodiscard]] Colour default_ambient();
[[nodiscard]] Background default_background();

}  // namespace raymo::scene
