/// The lists of cases, in the report's order. Each function appends its own.
#pragma once

#include <vector>

#include <pellucid/study/check.h>

namespace pellucid::check {

using Cases = std::vector<CheckCase>;

void addFurnaces(Cases& cases);          ///< closed forms 1 to 5: enclosures
void addLamps(Cases& cases);             ///< 6 to 9: lamps over a floor
void addSkies(Cases& cases);             ///< 10 to 12: walls and skies, gradients
void addFlatMirrors(Cases& cases);       ///< 13, 14, 28
void addCurvedMirrors(Cases& cases);     ///< 18, 19, 23
void addSlabs(Cases& cases);             ///< 15, 16, 17, 24
void addDispersion(Cases& cases);        ///< glass by wavelength
void addLenses(Cases& cases);            ///< 20 to 22, a lamp inside glass
void addKernels(Cases& cases);           ///< 25 to 27, on synthetic photons
void addMonteCarlo(Cases& cases);        ///< the lecture's claims
void addEnergy(Cases& cases);            ///< the account of the photon passes
void addScaleExtremes(Cases& cases);     ///< size, place
void addMaterialExtremes(Cases& cases);  ///< albedo, ior, roughness
void addGeometryExtremes(Cases& cases);  ///< bad triangles, thin gaps, open glass
void addCoincidentFaces(Cases& cases);   ///< glass on a table, water in a glass, a lamp in a ceiling
void addLampExtremes(Cases& cases);      ///< lamps and environments
void addSightExtremes(Cases& cases);     ///< radiances, mirrors, reflections without number
void addSizeExtremes(Cases& cases);      ///< a million instances, a huge environment
void addPhotonExtremes(Cases& cases);    ///< one photon, none, all in one point

}  // namespace pellucid::check
