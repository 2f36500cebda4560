/// A text file of cameras for a flythrough, one a line: `eye X Y Z target X Y Z [up X Y Z] [fov DEGREES]`, in metres and the
/// axes of the scene file. Empty lines, and what follows a `#`, say nothing.
#pragma once

#include <filesystem>
#include <string_view>
#include <vector>

#include <pellucid/scene/camera.h>

namespace pellucid {

/// `verticalFov` (radians) stands where a line names none; up is (0, 1, 0) where it names none. Throws Error{BadInput} with the
/// line's number.
[[nodiscard]] std::vector<CameraSpec> loadViews(const std::filesystem::path& file, double verticalFov);
[[nodiscard]] std::vector<CameraSpec> parseViews(std::string_view text, const std::filesystem::path& file,
                                                 double verticalFov);

}  // namespace pellucid
