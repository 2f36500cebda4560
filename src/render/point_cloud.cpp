#include "point_cloud.h"

#include <algorithm>
#include <bit>
#include <cmath>
#include <cstring>
#include <initializer_list>
#include <system_error>
#include <utility>

#include <pellucid/base/error.h>
#include <pellucid/io/plain_file.h>
#include <pellucid/math/rgb.h>

namespace pellucid {

namespace {

static_assert(std::endian::native == std::endian::little, "floats are written as they stand");

/// This share of the points is darker than what is drawn as white.
constexpr double kWhiteShare = 0.95;

/// One element of vertices: properties are floats, but for the colour to look at.
class PlyWriter {
public:
    PlyWriter(std::size_t count, const std::string& comment, std::initializer_list<const char*> floats) {
        bytes_ = "ply\nformat binary_little_endian 1.0\ncomment " + comment + "\nelement vertex " +
                 std::to_string(count) + "\n";
        for (const char* name : floats) bytes_ += "property float " + std::string(name) + "\n";
        for (const char* name : {"red", "green", "blue"}) bytes_ += "property uchar " + std::string(name) + "\n";
        bytes_ += "end_header\n";
    }
    void put(const glm::dvec3& v) {
        for (glm::length_t a = 0; a < 3; ++a) put(v[a]);
    }
    void put(double value) {
        const auto f = static_cast<float>(value);
        bytes_.append(reinterpret_cast<const char*>(&f), sizeof f);  // NOLINT: plain bytes
    }
    /// Between black and `white`, with the display's gamma of about 2.2.
    void putColour(const Rgb& value, float white) {
        for (glm::length_t c = 0; c < 3; ++c) {
            const float shown = std::pow(std::clamp(value[c] / white, 0.0F, 1.0F), 1.0F / 2.2F);
            bytes_.push_back(static_cast<char>(static_cast<unsigned char>(std::lround(255.0F * shown))));
        }
    }
    [[nodiscard]] std::string take() { return std::move(bytes_); }

private:
    std::string bytes_;
};

template <class Item>
[[nodiscard]] float whiteOf(const std::vector<Item>& items, Rgb Item::*colour) {
    std::vector<float> values;
    for (const Item& i : items) values.push_back(maxComponent(i.*colour));
    if (values.empty()) return 1.0F;
    const auto at = values.begin() + static_cast<std::ptrdiff_t>(kWhiteShare * static_cast<double>(values.size() - 1));
    std::nth_element(values.begin(), at, values.end());
    return *at > 0.0F ? *at : 1.0F;
}

[[nodiscard]] glm::dvec3 inMetres(const glm::vec3& position, const Normalisation& scene) {
    return glm::dvec3(position) / scene.scale() + scene.centre;
}

/// Of records or of the map's places.
template <class Item>
[[nodiscard]] std::string irradiancePly(const std::vector<Item>& items, const char* comment,
                                        const Normalisation& scene) {
    PlyWriter ply(items.size(), comment,
                  {"x", "y", "z", "nx", "ny", "nz", "irradiance_red", "irradiance_green", "irradiance_blue", "radius"});
    const float white = whiteOf(items, &Item::irradiance);
    for (const Item& i : items) {
        ply.put(inMetres(i.position, scene));
        ply.put(glm::dvec3(i.normal));
        ply.put(glm::dvec3(i.irradiance));
        ply.put(static_cast<double>(i.radius) / scene.scale());
        ply.putColour(i.irradiance, white);
    }
    return ply.take();
}

}  // namespace

std::string recordsPly(const std::vector<IrradianceRecord>& records, const Normalisation& scene) {
    return irradiancePly(records, "irradiance cache records; metres, W m^-2", scene);
}

std::string placesPly(const std::vector<RadianceMap::Place>& places, const Normalisation& scene) {
    return irradiancePly(places, "places of the global map; metres, W m^-2", scene);
}

std::string photonsPly(const PhotonList& photons, const Normalisation& scene) {
    PlyWriter ply(photons.size(),
                  "caustic photons of the last iteration; metres, W; wi points to where a photon came from",
                  {"x", "y", "z", "nx", "ny", "nz", "wi_x", "wi_y", "wi_z", "flux_red", "flux_green", "flux_blue"});
    const float white = whiteOf(photons, &Photon::flux);
    const double watts = 1.0 / (scene.scale() * scene.scale());  // powers carry the square of the scene's scale
    for (const Photon& p : photons) {
        ply.put(inMetres(p.position, scene));
        ply.put(glm::dvec3(p.normal));
        ply.put(glm::dvec3(p.wi));
        ply.put(glm::dvec3(p.flux) * watts);
        ply.putColour(p.flux, white);
    }
    return ply.take();
}

void writePointClouds(const std::filesystem::path& folder, const StoredPoints& points, const PhotonList& photons,
                      const Normalisation& scene) {
    std::error_code failed;
    std::filesystem::create_directories(folder, failed);
    if (failed)
        throw Error(ErrorKind::CannotFinish, "the folder cannot be made: " + failed.message(), folder.string(),
                    "name one that may be made");
    writeFile(folder / "records.ply", recordsPly(points.records, scene));
    writeFile(folder / "caustic-photons.ply", photonsPly(photons, scene));
    if (!points.places.empty()) writeFile(folder / "global-map.ply", placesPly(points.places, scene));
}

}  // namespace pellucid
