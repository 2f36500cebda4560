/// The project's own scenes, one function each. scenes/README.md says what each shows.
#pragma once

#include "glb_writer.h"

namespace scenes {

// Glass: scenes_glass.cpp
[[nodiscard]] GlbWriter glassAndMirror();
[[nodiscard]] GlbWriter goblet();
[[nodiscard]] GlbWriter pool();

// Lights that no camera path can hit: scenes_blind.cpp
[[nodiscard]] GlbWriter prismSpot();
[[nodiscard]] GlbWriter rainbow();
[[nodiscard]] GlbWriter lensPoint();

// Metal: scenes_metal.cpp
[[nodiscard]] GlbWriter ring();
[[nodiscard]] GlbWriter roughMetal();

// Diffuse light and many lamps: scenes_rooms.cpp
[[nodiscard]] GlbWriter diffuseRoom();
[[nodiscard]] GlbWriter twoRooms();
[[nodiscard]] GlbWriter manyLamps();

// Open air and textures: scenes_textured.cpp
[[nodiscard]] GlbWriter cornerOpen();
[[nodiscard]] GlbWriter textured();

}  // namespace scenes
