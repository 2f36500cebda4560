#include <array>

#include <glm/gtc/quaternion.hpp>

#include "materials.h"
#include "scenes.h"

namespace scenes {

namespace {

/// The six inner faces of a room, as separate meshes so that walls may differ.
struct RoomMaterials {
    std::size_t floor, ceiling, left, right, back, front;
};

void addRoom(GlbWriter& scene, const glm::dvec3& low, const glm::dvec3& high, const RoomMaterials& materials) {
    const glm::dvec3 size = high - low, x(size.x, 0, 0), y(0, size.y, 0), z(0, 0, size.z);
    scene.add("floor", withoutUvs(quad({low.x, low.y, high.z}, x, -z)), materials.floor);
    scene.add("ceiling", withoutUvs(quad({low.x, high.y, low.z}, x, z)), materials.ceiling);
    scene.add("left", withoutUvs(quad({low.x, low.y, high.z}, -z, y)), materials.left);
    scene.add("right", withoutUvs(quad({high.x, low.y, low.z}, z, y)), materials.right);
    scene.add("back", withoutUvs(quad(low, x, y)), materials.back);
    scene.add("front", withoutUvs(quad({high.x, low.y, high.z}, -x, y)), materials.front);
}

/// A board on four legs that reach 2 mm into it.
Shape tableShape(const glm::dvec3& size, double board, double leg) {
    const glm::dvec3 half(size.x / 2, 0.0, size.z / 2);
    std::vector<Shape> parts = {box({-half.x, size.y - board, -half.z}, {half.x, size.y, half.z})};
    for (const double sx : {-1.0, 1.0}) {
        for (const double sz : {-1.0, 1.0}) {
            const glm::dvec3 at(sx * (half.x - leg), 0.0, sz * (half.z - leg));
            parts.push_back(
                box(at - glm::dvec3(leg / 2, 0.0, leg / 2), at + glm::dvec3(leg / 2, size.y - board + 0.002, leg / 2)));
        }
    }
    return withoutUvs(merged(parts));
}

Shape chairShape() {
    return merged(
        {tableShape({0.44, 0.46, 0.44}, 0.04, 0.04), withoutUvs(box({-0.22, 0.458, -0.22}, {0.22, 0.95, -0.18}))});
}

Shape sofaShape() {
    return withoutUvs(
        merged({box({-0.9, 0.0, -0.4}, {0.9, 0.40, 0.4}), box({-0.9, 0.398, -0.4}, {0.9, 0.82, -0.16}),
                box({-1.08, 0.0, -0.4}, {-0.898, 0.60, 0.4}), box({0.898, 0.0, -0.4}, {1.08, 0.60, 0.4})}));
}

Shape shelfShape() {
    std::vector<Shape> parts = {box({-0.5, 0.0, -0.16}, {-0.47, 1.9, 0.16}), box({0.47, 0.0, -0.16}, {0.5, 1.9, 0.16}),
                                box({-0.472, 0.0, -0.16}, {0.472, 1.9, -0.14})};
    for (const double y : {0.05, 0.51, 0.97, 1.43, 1.87}) {
        parts.push_back(box({-0.472, y, -0.142}, {0.472, y + 0.03, 0.159}));
    }
    return withoutUvs(merged(parts));
}

/// A row of books of uneven height and thickness standing on y = 0.
Shape bookRow(int count, double height) {
    std::vector<Shape> books;
    double x = 0.0;
    for (int i = 0; i < count; ++i) {
        const double thickness = 0.022 + 0.006 * ((i * 7) % 5);
        books.push_back(box({x, 0.0, 0.0}, {x + thickness, height - 0.018 * ((i * 5) % 4), 0.19}));
        x += thickness + 0.0015;
    }
    return withoutUvs(merged(books));
}

Shape vaseShape() {
    return lathe(
        line({0.0, 0.0}, {0.055, 0.0}) +
            spline(
                {{0.03, -0.02}, {0.055, 0.0}, {0.085, 0.08}, {0.070, 0.17}, {0.032, 0.24}, {0.045, 0.28}, {0.06, 0.31}},
                5) +
            line({0.045, 0.28}, {0.0, 0.28}),
        40);
}

}  // namespace

/// A living room with nothing but diffuse surfaces: a window on the left, a warm lamp under the ceiling.
GlbWriter diffuseRoom() {
    GlbWriter scene("diffuse-room");
    const auto white = scene.addMaterial(lambert("white", {0.78, 0.77, 0.74}));
    const auto ochre = scene.addMaterial(lambert("ochre", {0.70, 0.50, 0.22}));
    const auto parquet = scene.addMaterial(lambert("parquet", {0.42, 0.26, 0.15}));
    const auto wood = scene.addMaterial(lambert("wood", {0.50, 0.33, 0.19}));
    const auto cloth = scene.addMaterial(lambert("cloth", {0.16, 0.30, 0.42}));
    const auto rug = scene.addMaterial(lambert("rug", {0.55, 0.14, 0.12}));
    const auto clay = scene.addMaterial(lambert("clay", {0.68, 0.36, 0.22}));
    const auto window = scene.addMaterial(lamp("window", {3.6, 4.4, 5.4}));
    const auto bulb = scene.addMaterial(lamp("ceiling-lamp", {16.0, 12.0, 7.5}));

    addRoom(scene, {-2.0, 0.0, -2.6}, {2.0, 2.6, 2.6}, {parquet, white, white, ochre, white, white});
    scene.add("rug", withoutUvs(box({-1.0, 0.0, -1.2}, {0.9, 0.012, 0.4})), rug);
    scene.add("sofa", sofaShape(), cloth, {{-0.2, 0.0, -2.1}});
    scene.add("table", tableShape({0.95, 0.42, 0.55}, 0.035, 0.05), wood, {{-0.1, 0.0125, -0.8}});
    scene.add("vase", vaseShape(), clay, {{-0.25, 0.433, -0.75}});
    scene.add("ball", sphere(0.09, 40, 20), white, {{0.14, 0.523, -0.85}});
    scene.add("shelf", shelfShape(), wood,
              {{1.8, 0.0, -1.1}, glm::angleAxis(glm::radians(-90.0), glm::dvec3(0, 1, 0))});
    const std::array<std::size_t, 3> covers = {clay, cloth, rug};
    for (std::size_t i = 0; i < covers.size(); ++i) {  // books look out of the shelf, towards -x
        const double y = std::array<double, 3>{0.541, 1.001, 1.461}[i];
        scene.add("books", bookRow(8 + static_cast<int>(i) * 3, 0.30 + 0.02 * static_cast<double>(i)), covers[i],
                  {{1.9, y, -1.45}, glm::angleAxis(glm::radians(-90.0), glm::dvec3(0, 1, 0))});
    }
    const std::size_t chair = scene.addMesh("chair", chairShape(), wood);
    scene.place("chair", chair, {{0.95, 0.0, 0.25}, glm::angleAxis(glm::radians(-140.0), glm::dvec3(0, 1, 0))});
    scene.add("picture", withoutUvs(box({-0.8, 1.25, -2.599}, {0.5, 2.0, -2.57})), clay);
    scene.add("window", withoutUvs(quad({-1.99, 0.95, 0.3}, {0, 0, -1.4}, {0, 1.2, 0})), window);
    scene.add("ceiling-lamp", withoutUvs(ceilingQuad({0.3, 2.58, -0.3}, 0.35, 0.35)), bulb);
    scene.addCamera("camera", {{0.35, 1.5, 2.45}, {-0.05, 0.95, -1.0}, 52.0, 4.0 / 3.0});
    return scene;
}

/// A bright room and, behind a wall 12 cm thick, one that is lit only through its half-open door.
GlbWriter twoRooms() {
    GlbWriter scene("two-rooms");
    const auto white = scene.addMaterial(lambert("white", {0.76, 0.75, 0.72}));
    const auto warm = scene.addMaterial(lambert("warm", {0.72, 0.48, 0.30}));
    const auto boards = scene.addMaterial(lambert("boards", {0.48, 0.34, 0.22}));
    const auto door = scene.addMaterial(lambert("door", {0.32, 0.42, 0.36}));
    const auto blue = scene.addMaterial(lambert("blue", {0.20, 0.32, 0.58}));
    const auto light = scene.addMaterial(lamp("lamp", {240.0, 215.0, 165.0}));

    addRoom(scene, {-3.0, 0.0, -2.0}, {3.0, 2.5, 2.0}, {boards, white, white, warm, white, white});
    // The wall reaches 1 cm into floor, ceiling and outer walls; the doorway is 0.9 x 2.05 m.
    scene.add(
        "wall",
        withoutUvs(merged({box({-0.06, -0.01, -2.01}, {0.06, 2.51, -0.9}), box({-0.06, -0.01, 0.0}, {0.06, 2.51, 2.01}),
                           box({-0.06, 2.05, -0.9}, {0.06, 2.51, 0.0})})),
        white);
    scene.add("door", withoutUvs(box({0.0, 0.01, 0.0}, {0.88, 2.03, 0.04})), door,
              {{-0.08, 0.0, -0.89}, glm::angleAxis(glm::radians(-125.0), glm::dvec3(0, 1, 0))});
    scene.add("table", tableShape({1.0, 0.72, 0.6}, 0.04, 0.06), boards, {{-1.7, 0.0, -1.3}});
    scene.add("ball", sphere(0.2, 48, 24), blue, {{-1.7, 0.921, -1.3}});
    scene.add("box", withoutUvs(turned(box({-0.25, 0.0, -0.25}, {0.25, 0.5, 0.25}), {0, 1, 0}, 30.0)), warm,
              {{-2.2, 0.0, 0.1}});
    scene.add("lamp", withoutUvs(ceilingQuad({1.7, 2.485, 0.9}, 0.5, 0.5)), light);
    scene.addCamera("camera", {{-1.55, 1.45, 1.9}, {-1.05, 0.85, -1.2}, 58.0, 4.0 / 3.0});
    return scene;
}

/// A hundred weak lamps in four colours, one strong one, and a glass ball: photons that matter come from one in 101.
GlbWriter manyLamps() {
    GlbWriter scene("many-lamps");
    const auto grey = scene.addMaterial(lambert("grey", {0.66, 0.66, 0.64}));
    const auto rust = scene.addMaterial(lambert("rust", {0.58, 0.24, 0.14}));
    const auto green = scene.addMaterial(lambert("green", {0.22, 0.42, 0.24}));
    const auto glass = scene.addMaterial(dielectric("glass", 1.5));
    const auto strong = scene.addMaterial(lamp("strong-lamp", {420.0, 400.0, 360.0}));

    addRoom(scene, {-3.0, 0.0, -3.0}, {3.0, 3.0, 3.0}, {grey, grey, rust, green, grey, grey});
    const auto stand = [](double half, double height) {
        return withoutUvs(box({-half, 0.0, -half}, {half, height, half}));
    };
    scene.add("plinth", stand(0.45, 0.25), grey, {{0.35, 0.0, 0.0}});
    scene.add("glass-ball", sphere(0.4, 80, 40), glass, {{0.35, 0.7515, 0.0}});
    const std::size_t pillar = scene.addMesh("pillar", stand(0.12, 2.2), grey);
    for (const glm::dvec3& at : {glm::dvec3(-1.6, 0, -1.6), glm::dvec3(-1.6, 0, 0.2), glm::dvec3(1.9, 0, -1.6)}) {
        scene.place("pillar", pillar, {at});
    }

    const std::array<glm::dvec3, 4> colors = {glm::dvec3(14, 11, 8), glm::dvec3(8, 11, 14), glm::dvec3(14, 7, 7),
                                              glm::dvec3(7, 13, 8)};
    std::vector<std::size_t> lamps;
    for (const glm::dvec3& color : colors) {
        const auto material = scene.addMaterial(lamp("small-lamp-" + std::to_string(lamps.size()), color));
        lamps.push_back(scene.addMesh("small-lamp", withoutUvs(ceilingQuad({0, 0, 0}, 0.06, 0.06)), material));
    }
    for (int row = 0; row < 10; ++row) {
        for (int column = 0; column < 10; ++column) {
            const glm::dvec3 at(-2.7 + 0.6 * column, 2.97, -2.7 + 0.6 * row);
            scene.place("small-lamp", lamps[static_cast<std::size_t>((column + 3 * row) % 4)], {at});
        }
    }
    scene.add("strong-lamp", withoutUvs(ceilingQuad({0.6, 2.9, 0.2}, 0.12, 0.12)), strong);
    scene.addCamera("camera", {{-0.9, 1.6, 2.85}, {0.25, 0.65, -0.3}, 46.0, 4.0 / 3.0});
    return scene;
}

}  // namespace scenes
